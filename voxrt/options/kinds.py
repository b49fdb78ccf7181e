"""The kinds of values that options take: how each is written on a command line, and which values are allowed.

A bound stands here once, or in the table that names it. :attr:`Kind.read` takes text and knows its notation alone;
:attr:`Kind.check` knows the bounds, for values of Python and of the command line alike.
"""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any

from msgspec import Struct

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


class Kind(Struct, frozen=True, eq=False):
    """A kind of values.

    `read` returns the value that a text of the command line means; ValueError if it means none. `check` takes the name
    of an option and a value, and returns the value converted exactly; TypeError or ValueError if it is of another kind.
    """

    metavar: str  # what a value is called in the help
    read: Callable[[str], Any]
    check: Callable[[str, Any], Any]
    write: Callable[[Any], str] = str  # returns the text of a value, as `read` takes it
    choices: tuple[str, ...] = ()  # the texts of all values, if they are few
    is_flag: bool = False  # the name of the option alone means True
    is_optional: bool = False  # the name of the option alone has a meaning, which is that of an empty text
    is_file: bool = False  # values are names of files
    many: bool = False  # the option may stand more than once; its value is a tuple


def plain(name: str) -> str:
    """Return a name without case, dashes and underscores: people write them as they like."""
    return "".join(c for c in name.lower() if c.isalnum())


def exact(check: str, *limits: Any, **bounds: Any) -> Callable[[str, Any], Any]:  # noqa: ANN401
    """Return a check of :mod:`voxrt.voxelize.arguments`, which is imported when it is needed: NumPy comes with it."""

    def convert(name: str, value: object) -> Any:  # noqa: ANN401
        return getattr(import_module("voxrt.voxelize.arguments"), check)(name, value, *limits, **bounds)

    return convert


def several(count: int, expected: str, check: Callable[[str, Any], Any]) -> Callable[[str, Any], tuple[Any, ...]]:
    """Make the check of so many values, each of which passes a check of its own."""

    def convert(name: str, value: object) -> tuple[Any, ...]:
        if not isinstance(value, Iterable) or len(parts := tuple(value)) != count:
            raise ValueError(f"{name} must be {expected}, not {show(value)}")
        return tuple(check(f"{name}[{row}]", part) for row, part in enumerate(parts))

    return convert


def whole(low: int, high: int, metavar: str = "N") -> Kind:
    """Make the kind of whole numbers from `low` to `high`."""
    return Kind(metavar, read_whole, exact("whole", low, high))


def real(metavar: str, *, above: float = -inf, below: float = inf, low: float = -inf, high: float = inf) -> Kind:
    """Make the kind of finite numbers `low` to `high`, strictly between `above` and `below`."""
    return Kind(metavar, read_number, exact("real", above=above, below=below, low=low, high=high), "{:g}".format)


def nearest(word: str, words: Iterable[str]) -> str:
    """Return what an error says where one of the words may be meant."""
    from difflib import get_close_matches  # noqa: PLC0415 - for what is wrong alone

    near = get_close_matches(word, words, 1)
    return f"; did you mean {near[0]}" if near else ""


def one_of(choices: Sequence[str]) -> Kind:
    """Make the kind of a few names."""

    def read(text: str) -> str:
        for name in choices:
            if plain(name) == plain(text):
                return name
        listed = ", ".join(f'"{name}"' for name in choices)
        raise ValueError(f"{text!r} is none of {listed}{nearest(text, choices)}")

    def check(name: str, value: object) -> str:
        return value if type(value) is str and value in choices else str(exact("choice", choices)(name, value))

    return Kind("|".join(choices), read, check, choices=tuple(choices))


def text(metavar: str) -> Kind:
    """Make the kind of any text."""
    return Kind(metavar, str, exact("text"))


def texts(metavar: str) -> Kind:
    """Make the kind of any number of texts, one per option."""

    def check(name: str, value: object) -> tuple[str, ...]:
        if isinstance(value, str) or not isinstance(value, Iterable):
            raise TypeError(f"{name} must be a sequence of strings, not {show(value)}")
        return tuple(exact("text")(f"{name}[{row}]", one) for row, one in enumerate(value))

    return Kind(metavar, str, check, many=True)


def file(metavar: str, suffixes: tuple[str, ...] = (), problem: str = "") -> Kind:
    """Make the kind of names of files, with one of some suffixes if there are any; `problem` says what is wrong."""

    def read(text: str) -> Path:
        path = Path(text)
        if suffixes and path.suffix.lower() not in suffixes:
            raise ValueError(f"{text}: {problem}; give it a name that ends in {' or '.join(suffixes)}")
        return path

    return Kind(metavar, read, as_it_is, is_file=True)


def files(metavar: str) -> Kind:
    """Make the kind of any number of files."""
    return Kind(metavar, Path, as_it_is, is_file=True, many=True)


def as_it_is(_name: str, value: Any) -> Any:  # noqa: ANN401
    """Check nothing: whatever is read is right."""
    return value


def show(value: object) -> str:
    """Return a value for an error message: one line, at most 60 characters."""
    return str(import_module("voxrt.voxelize.arguments").shown(value))


def read_whole(text: str) -> int:
    """Read a whole number."""
    try:
        return int(text, 10)
    except ValueError:
        raise ValueError(f"{text!r} is not a whole number") from None


def read_number(text: str) -> float:
    """Read a number."""
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{text!r} is not a number") from None


INTEGER = Kind("N", read_whole, as_it_is)
"""Whole numbers whose bounds are those of what takes them."""

FLAG = Kind("", lambda _text: True, exact("flag"), is_flag=True)
"""Options that are on or off."""
