"""A command line becomes a command and the values of its options, by the table of the command.

The parsers of the standard library are not used: ``argparse`` refuses values that begin with a dash, and options whose
value is optional before an argument; each of them takes longer to import than this takes to run.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec import NODEFAULT

from voxrt.cli.terminal.errors import UsageError
from voxrt.options.commands import COMMANDS
from voxrt.options.kinds import nearest
from voxrt.options.option import ARGUMENTS, OptionConflictError, compose, options_of, spell_options

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from voxrt.options.option import Option

_OUTPUT_FLAGS = ("-o", "--output")
HELP_FLAGS = ("--help", "-h")


def flags_of(name: str, option: Option) -> tuple[str, ...]:
    """Return the names of an option on the command line; of an argument, what its value is called."""
    if option.group == ARGUMENTS:
        return (option.kind.metavar,)
    return option.flags or (f"--{name.replace('_', '-')}",)


def command_options(name: str) -> dict[str, Option]:
    """Return the options that a command has on its command line, its arguments included."""
    return {one: option for one, option in options_of(COMMANDS[name].options()).items() if option.group is not None}


def find_command(name: str, tasks: Iterable[str] = ()) -> str:
    """Return the name of a command, or refuse what is none; `tasks`: what could be named as well."""
    if name in COMMANDS:
        return name
    names = (*COMMANDS, *tasks)
    kind = "command or task" if tasks else "command"
    raise UsageError(f"there is no {kind} {name!r}{nearest(name, names)}; name one of {', '.join(names)}")


def asks_for_help(arguments: Sequence[str]) -> bool:
    """Tell whether a command line asks for help."""
    options = arguments[: arguments.index("--")] if "--" in arguments else arguments
    return any(flag in options for flag in HELP_FLAGS)


def read_options(command: str, arguments: Sequence[str]) -> Any:  # noqa: ANN401 - the table of the command
    """Read the words behind a command as the table of its options; UsageError if they cannot be understood."""
    options = command_options(command)
    named = {name: option for name, option in options.items() if option.group != ARGUMENTS}
    if "target" in options and (wrong := next((one for one in arguments if one in _OUTPUT_FLAGS), None)):
        raise UsageError(f"there is no option {wrong}; name the file to write as the last argument, without it")
    texts, words = _split(arguments, named)
    for name, option in options.items():
        if option.group == ARGUMENTS:
            count = len(words) if option.kind.many else 1
            texts[name], words = words[:count], words[count:]
    if words:
        raise UsageError(f"{words[0]} is one argument too many")
    values = {name: _value(name, option, texts[name]) for name, option in options.items() if _has(name, option, texts)}
    for name, option in options.items():
        if texts[name] and option.goes_with in options and not texts[option.goes_with]:
            flag, other = (flags_of(one, options[one])[0] for one in (name, option.goes_with))
            raise UsageError(f"{flag} has no effect without {other}; give that as well, or leave {flag} out")
    try:
        return compose(COMMANDS[command].options(), values)
    except OptionConflictError as error:
        raise UsageError(spell_options(error.text, lambda name: flags_of(name, options[name])[0])) from error


def _has(name: str, option: Option, texts: dict[str, list[str]]) -> bool:
    """Tell whether an option is on the command line; refuse a command line without one that must be."""
    if not texts[name] and option.default is NODEFAULT:
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
        named = option.group == ARGUMENTS and option.kind.choices  # "check|report" would say it twice
        raise UsageError(str(error) if named else f"{flag}: {error}") from error
    try:
        return option.kind.check(flag, tuple(values) if option.kind.many else values[-1])
    except (ValueError, TypeError) as error:
        raise UsageError(str(error)) from error


def _metavar(option: Option) -> str:
    return option.metavar or option.kind.metavar


def _split(arguments: Sequence[str], options: dict[str, Option]) -> tuple[dict[str, list[str]], list[str]]:
    """Take a command line apart: the texts of each option, and the arguments.

    Options and arguments may be mixed. A value may begin with a dash if it is not an option. Where a value is optional,
    the next word is the value unless it begins with a dash or has the suffix of an asset.
    """
    names = {flag: name for name, option in options.items() for flag in flags_of(name, option)}
    texts: dict[str, list[str]] = {name: [] for name in options}
    words: list[str] = []
    rest = list(arguments)
    while rest:
        word = rest.pop(0)
        if word == "--":
            return texts, words + rest
        if word == "-" or not word.startswith("-"):
            words.append(word)
            continue
        flag, joined, value = word.partition("=") if word.startswith("--") else (word[:2], word[2:], word[2:])
        if flag not in names:
            raise UsageError(f"there is no option {flag}{nearest(flag, names)}")
        option = options[names[flag]]
        if option.kind.is_flag and joined:
            if word.startswith("--"):
                raise UsageError(f"{flag} takes no value")
            rest.insert(0, f"-{value}")
            value = ""
        elif option.kind.is_optional and not joined:
            value = rest.pop(0) if rest and not (rest[0].startswith("-") or _is_asset(rest[0])) else ""
        elif not (option.kind.is_flag or joined):
            if not rest or rest[0] in names:
                raise UsageError(f"{flag} requires an argument: {_metavar(option)}")
            value = rest.pop(0)
        texts[names[flag]].append(value)
    return texts, words


def _is_asset(name: str) -> bool:
    from voxrt.voxelize.assets import SUFFIXES  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

    return Path(name).suffix.lower() in SUFFIXES
