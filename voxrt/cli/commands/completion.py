"""``voxrt completion``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.cli.line.completion_script import completion_script
from voxrt.cli.terminal.messages import print_answer

if TYPE_CHECKING:
    from voxrt.options.shell_commands import CompletionCommand


def run(options: CompletionCommand) -> None:
    """Print a script that completes voxrt's command lines."""
    print_answer(completion_script(options.shell))
