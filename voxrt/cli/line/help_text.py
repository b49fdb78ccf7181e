"""The help, from the tables of options."""

from __future__ import annotations

from shutil import get_terminal_size
from textwrap import wrap
from typing import TYPE_CHECKING

from msgspec import NODEFAULT

from voxrt.cli.line.command_line import HELP_FLAGS, command_options, flags_of
from voxrt.options.commands import COMMANDS
from voxrt.options.option import ARGUMENTS, spell_options
from voxrt.options.shared import MESSAGES
from voxrt.options.tasks import TASKS

if TYPE_CHECKING:
    from voxrt.options.option import Option

_COLUMN = 28
"""Where texts begin."""

_WIDEST = 110
_SCREEN = 50  # lines


def overview() -> str:
    """Return the help of all commands."""
    rows = [_entry(name, command.purpose) for name, command in COMMANDS.items()]
    return (
        "Usage: voxrt COMMAND ...\n\n"
        "Meshes to voxels to an octree memory to pictures ray-traced by hardware.\n\n"
        f"Commands\n{''.join(rows)}\n"
        f"{_entry('-h, --help', 'Print this help; after a command, that of the command.')}"
        f"{_entry('-V, --version', 'Print the version.')}\n"
        f"Tasks, with their command lines: voxrt help {'|'.join(TASKS)}\n"
        "Example: voxrt build courtyard.glb -o out --preview\n"
    )


def task_help(task: str) -> str:
    """Return the command lines of a task."""
    purpose, lines = TASKS[task]
    width = max(len(line) for line, _ in lines)
    shown = "".join(f"    {line:<{width}}  # {comment}\n" for line, comment in lines)
    commands = ", ".join(dict.fromkeys(line.split()[1] if line.startswith("voxrt ") else "build" for line, _ in lines))
    return f"{purpose}\n\n{shown}\nvoxrt help COMMAND describes all options of {commands}.\n"


def command_help(command: str, *, full: bool) -> str:
    """Return the help of a command: in full, or where that is long, what most people need and the names of all else."""
    text = _help(command, full=True)
    return text if full or text.count("\n") <= _SCREEN else _help(command, full=False)


def _help(command: str, *, full: bool) -> str:
    about = COMMANDS[command]
    options = command_options(command)
    head = "\n\n".join(filter(None, (_usage(command, options), _paragraph(about.purpose), _paragraph(about.more))))
    groups = []
    for group in dict.fromkeys([*(option.group for option in options.values()), MESSAGES]):
        members = {name: option for name, option in options.items() if option.group == group}
        rare = {name: option for name, option in members.items() if option.is_rare and not full}
        lines = [
            _entry(label(name, option), option_text(option, options, full=full))
            for name, option in members.items()
            if name not in rare
        ]
        if group == MESSAGES:
            lines.append(_entry(", ".join(reversed(HELP_FLAGS)), "Print this help."))
        if rare:
            lines.append(_indented(f"and {', '.join(flags_of(name, option)[0] for name, option in rare.items())}", 2))
        groups.append(f"{group}\n{''.join(lines)}")
    more = "" if full else f"voxrt help {command} describes all options.\n"
    body = ("\n" if full else "").join(groups)
    return f"{head}\n\n{body}\n{more}Example: {about.example}\n"


def label(name: str, option: Option) -> str:
    """Return the names of an option as the help has them, short ones first, with what its value is called."""
    flags = ", ".join(sorted(flags_of(name, option), key=len))
    metavar = option.metavar or option.kind.metavar
    return flags if option.group == ARGUMENTS else f"{flags} {metavar}".rstrip()


def option_text(option: Option, options: dict[str, Option], *, full: bool = True) -> str:
    """Return what an option does, and its default unless it is nothing."""
    text = option.text if full else option.help
    text = spell_options(text, lambda name: flags_of(name, options[name])[0] if name in options else name)
    if option.group == ARGUMENTS or option.default in (None, False, (), NODEFAULT) or "default" in text:
        return text
    default = option.kind.write(option.default)
    return text if default == "." else f"{text} [default: {default}]"


def _usage(command: str, options: dict[str, Option]) -> str:
    words = []
    for name, option in options.items():
        flag, metavar = flags_of(name, option)[0], option.metavar or option.kind.metavar
        if option.group == ARGUMENTS:
            word = metavar + ("..." if option.kind.many else "")
            words.append(word if option.default is NODEFAULT else f"[{word}]")
        elif option.default is NODEFAULT:
            words.append(f"{flag} {metavar}")
    return " ".join(["Usage: voxrt", command, *words, "[OPTIONS]"])


def _entry(head: str, text: str) -> str:
    body = _indented(text, _COLUMN)
    return f"  {head}\n{body}" if len(head) > _COLUMN - 3 else f"  {head:<{_COLUMN - 2}}{body.lstrip()}"


def _indented(text: str, by: int) -> str:
    return "".join(f"{' ' * by}{line}\n" for line in wrap(text, _width() - by, break_on_hyphens=False))


def _paragraph(text: str) -> str:
    return _indented(text, 0).rstrip("\n")


def _width() -> int:
    return max(60, min(get_terminal_size((100, 24)).columns, _WIDEST))
