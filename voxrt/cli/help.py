"""``voxrt help``."""

from __future__ import annotations

from voxrt.cli import app
from voxrt.cli.errors import UsageError


def help(command: str = "", /) -> None:  # noqa: A001 - the command's name
    """Print the help of a command, or of all.

    Parameters
    ----------
    command
        The command.
    """
    if command and command not in app.app:
        raise UsageError(f"there is no command {command!r}; name one of {', '.join(_commands())}")
    app.app.help_print([command] if command else [])


def _commands() -> list[str]:
    return [name for name in app.app if not name.startswith("-")]
