"""The command lines of what helps with command lines: completion and help."""

from __future__ import annotations

from dataclasses import MISSING, dataclass

from voxrt.options.commands import COMMANDS
from voxrt.options.kinds import Kind, as_it_is, one_of
from voxrt.options.option import ARGUMENTS, option


@dataclass(frozen=True, kw_only=True)
class CompletionCommand:
    """What ``voxrt completion`` takes."""

    shell: str = option(one_of(("bash", "zsh", "fish")), MISSING, "The shell.", ARGUMENTS)


@dataclass(frozen=True, kw_only=True)
class HelpCommand:
    """What ``voxrt help`` takes."""

    command: str | None = option(
        Kind("COMMAND", str, as_it_is, choices=tuple(COMMANDS)), None, "The command.", ARGUMENTS
    )
