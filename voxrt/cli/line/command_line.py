"""A command line becomes a command and the values of its options, by the table of the command.

``optparse`` and not ``argparse`` takes it apart: options and arguments may be mixed, and values may begin with a dash.
"""

from __future__ import annotations

from dataclasses import MISSING
from optparse import OptionParser
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from voxrt.cli.terminal.errors import UsageError
from voxrt.options.commands import COMMANDS
from voxrt.options.option import ARGUMENTS, OptionConflictError, compose, options_of, spell_options

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from voxrt.options.option import Option

HELP_FLAGS = ("--help", "-h")


class _Parser(OptionParser):
    def error(self, msg: str) -> NoReturn:
        raise UsageError(msg)


def flags_of(name: str, option: Option) -> tuple[str, ...]:
    """Return the names of an option on the command line; of an argument, what its value is called."""
    if option.group == ARGUMENTS:
        return (option.kind.metavar,)
    return option.flags or (f"--{name.replace('_', '-')}",)


def command_options(name: str) -> dict[str, Option]:
    """Return the options that a command has on its command line, its arguments included."""
    return {one: option for one, option in options_of(COMMANDS[name].options()).items() if option.group is not None}


def find_command(name: str) -> str:
    """Return the name of a command, or refuse what is none."""
    if name in COMMANDS:
        return name
    raise UsageError(f"there is no command {name!r}{_perhaps(name, COMMANDS)}; name one of {', '.join(COMMANDS)}")


def asks_for_help(arguments: Sequence[str]) -> bool:
    """Tell whether a command line asks for help."""
    return any(flag in _before_dashes(arguments) for flag in HELP_FLAGS)


def read_options(command: str, arguments: Sequence[str]) -> Any:  # noqa: ANN401 - the table of the command
    """Read the words behind a command as the table of its options.

    Raises
    ------
    UsageError
        They cannot be understood.
    """
    options = command_options(command)
    named = {name: option for name, option in options.items() if option.group != ARGUMENTS}
    arguments = _bind_optional(arguments, named)
    _refuse_unknown(arguments, named)
    parser = _Parser(add_help_option=False)
    for name, option in named.items():
        if option.kind.is_flag:
            parser.add_option(*flags_of(name, option), dest=name, action="append_const", const="")
        else:
            parser.add_option(*flags_of(name, option), dest=name, action="append")
    found, words = parser.parse_args(list(arguments))
    texts: dict[str, list[str]] = {name: getattr(found, name) or [] for name in named}
    for name, option in options.items():
        if option.group == ARGUMENTS:
            count = len(words) if option.kind.many else 1
            texts[name], words = words[:count], words[count:]
    if words:
        raise UsageError(f"{words[0]} is one argument too many")
    values = {name: _value(name, option, texts[name]) for name, option in options.items() if _has(name, option, texts)}
    try:
        return compose(COMMANDS[command].options(), values)
    except OptionConflictError as error:
        raise UsageError(spell_options(error.text, lambda name: flags_of(name, options[name])[0])) from error


def _has(name: str, option: Option, texts: dict[str, list[str]]) -> bool:
    """Tell whether an option is on the command line; refuse a command line without one that must be."""
    if not texts[name] and option.default is MISSING:
        flag = flags_of(name, option)[0]
        raise UsageError(
            f"{flag} is missing" + ("" if option.group == ARGUMENTS else f"; add {flag} {_metavar(option)}")
        )
    return bool(texts[name])


def _value(name: str, option: Option, texts: list[str]) -> object:
    flag = flags_of(name, option)[0]
    if len(texts) > 1 and not (option.kind.many or option.kind.is_flag):
        raise UsageError(f"{flag} is given {len(texts)} times; give it once")
    try:
        values = [option.kind.read(text) for text in texts]
    except ValueError as error:
        raise UsageError(f"{flag}: {error}") from error
    try:
        return option.kind.check(flag, tuple(values) if option.kind.many else values[-1])
    except (ValueError, TypeError) as error:
        raise UsageError(str(error)) from error


def _metavar(option: Option) -> str:
    return option.metavar or option.kind.metavar


def _before_dashes(arguments: Sequence[str]) -> Sequence[str]:
    return arguments[: arguments.index("--")] if "--" in arguments else arguments


def _refuse_unknown(arguments: Sequence[str], options: dict[str, Option]) -> None:
    """Refuse options that are not there, which ``optparse`` may take for others, and those without their value."""
    takes_value = {flag: option for name, option in options.items() for flag in flags_of(name, option)}
    words = _before_dashes(arguments)
    for place, word in enumerate(words):
        after = words[place + 1] if place + 1 < len(words) else None
        flag = word.partition("=")[0]
        if word.startswith("--") and flag not in takes_value:
            raise UsageError(f"there is no option {flag}{_perhaps(flag, takes_value)}")
        option = takes_value.get(word)
        if option and not (option.kind.is_flag or option.kind.is_optional) and (after is None or after in takes_value):
            raise UsageError(f"{word} requires an argument: {_metavar(option)}")


def _perhaps(word: str, words: Iterable[str]) -> str:
    from difflib import get_close_matches  # noqa: PLC0415 - for what is wrong alone

    near = get_close_matches(word, words, 1)
    return f"; did you mean {near[0]}" if near else ""


def _bind_optional(arguments: Sequence[str], options: dict[str, Option]) -> list[str]:
    """Join an option whose value is optional to its value, if it has one, for an asset may follow it.

    The next word is its value unless it is an option or has the suffix of an asset.
    """
    flags = {flag for name, option in options.items() if option.kind.is_optional for flag in flags_of(name, option)}
    bound = list(arguments)
    for place, word in enumerate(bound):
        if word == "--":
            break
        if word in flags:
            value = bound[place + 1] if place + 1 < len(bound) else "-"
            if value.startswith("-") or _is_asset(value):
                bound[place] = f"{word}="
            else:
                bound[place : place + 2] = [f"{word}={value}"]
    return bound


def _is_asset(name: str) -> bool:
    from voxrt.voxelize.assets import SUFFIXES  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

    return Path(name).suffix.lower() in SUFFIXES
