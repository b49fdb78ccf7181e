"""The command lines of what helps with command lines: completion and help."""

from __future__ import annotations

from msgspec import NODEFAULT

from voxrt.options.commands import COMMANDS
from voxrt.options.kinds import Kind, as_it_is, one_of
from voxrt.options.option import ARGUMENTS, OptionTable, option
from voxrt.options.tasks import TASKS


# A table: an option is its kind, its default and its group, then its text.
# fmt: off
class CompletionCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt completion`` takes."""

    shell: str = option(one_of(("bash", "zsh", "fish")), NODEFAULT, ARGUMENTS, "The shell.")


class HelpCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt help`` takes."""

    topic: str | None = option(Kind("COMMAND|TASK", str, as_it_is, choices=(*COMMANDS, *TASKS)), None, ARGUMENTS,
        f"The command, or a task: {', '.join(TASKS)}.")
