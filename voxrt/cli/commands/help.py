"""``voxrt help``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.cli.line.command_line import find_command
from voxrt.cli.line.help_text import command_help, overview, task_help
from voxrt.cli.terminal.messages import print_answer
from voxrt.options.tasks import TASKS

if TYPE_CHECKING:
    from voxrt.options.shell_commands import HelpCommand


def run(options: HelpCommand) -> None:
    """Print the help of a command, of a task, or of all."""
    name = options.topic
    if name is None:
        print_answer(overview())
    elif name in TASKS:
        print_answer(task_help(name))
    else:
        print_answer(command_help(find_command(name, TASKS), full=True))
