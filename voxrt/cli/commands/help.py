"""``voxrt help``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.cli.line.command_line import find_command
from voxrt.cli.line.help_text import command_help, overview
from voxrt.cli.terminal.messages import print_answer

if TYPE_CHECKING:
    from voxrt.options.shell_commands import HelpCommand


def run(options: HelpCommand) -> None:
    """Print the help of a command, or of all."""
    name = options.command
    print_answer(overview() if name is None else command_help(find_command(name), full=True))
