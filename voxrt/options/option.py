"""What an option is. A table of options is a struct whose defaults are made here.

From such a table come the value and its checks (:func:`check_options`), its documentation (:func:`documented`), and on
the command line the parser, the help, the completion and the manual's page, all by :func:`options_of`. This module
imports no heavy library.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from msgspec import NODEFAULT, Struct
from msgspec.structs import force_setattr, replace

from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from voxrt.options.kinds import Kind

_Table = TypeVar("_Table", bound="OptionTable")


ARGUMENTS = "Arguments"
"""The heading of what stands on the command line without the name of an option."""


class Option(Struct, frozen=True):
    """An option of the Python API, of a command, or of both.

    In `help` and `details`, ``{name}`` stands for another option, however that is spelled.
    """

    kind: Kind
    default: Any  # NODEFAULT if it must be given
    group: str | None  # its heading in the help; None for an option of the Python API alone
    help: str  # what it does, in a sentence or two
    details: str = ""  # what else there is to say: the short help of a command leaves it out
    flags: tuple[str, ...] = ()  # its names on the command line; without them, the name of the field with dashes
    metavar: str = ""  # what its value is called; that of its kind if it is empty
    python: str = ""  # what is to be said of it in Python alone
    goes_with: str = ""  # the option without which this one has no effect: a command line needs both
    is_rare: bool = False  # the short help of a command names it alone, without its text
    manifest: Literal["never", "always", "changed"] = "never"  # whether a manifest names it; changed: not the default

    def __repr__(self) -> str:
        """Return the default, which the signatures of tables show."""
        return repr(self.default)

    @property
    def text(self) -> str:
        """What it does, with the details."""
        return f"{self.help} {self.details}".rstrip()

    def field(self, **changed: Any) -> Any:  # noqa: ANN401 - type checkers take the annotation of the field
        """Make the field of a table, with some of the option's attributes changed."""
        return replace(self, **changed)

    def check(self, name: str, value: object) -> Any:  # noqa: ANN401
        """Convert a value exactly; TypeError or ValueError, which call the option `name`, if that is not possible."""
        return None if value is None and self.default is None else self.kind.check(name, value)


def option(kind: Kind, default: Any, group: str | None, text: str, **more: Any) -> Any:  # noqa: ANN401
    """Make the field of a table that is an option: the attributes of :class:`Option`."""
    return Option(kind, default, group, text, **more)


class OptionTable(Value, frozen=True):
    """A table of options by name. The fields of derived classes are keywords."""

    def __post_init__(self) -> None:
        for name, made in _fields(type(self)):
            if getattr(self, name) is made:
                if isinstance(made, Option) and made.default is NODEFAULT:
                    raise TypeError(f"{type(self).__name__} needs {name}")
                force_setattr(self, name, made.default if isinstance(made, Option) else made())


def nested(table: type[OptionTable]) -> Any:  # noqa: ANN401
    """Make the field of a table that holds another table of options."""
    return table


class OptionConflictError(ValueError):
    """Options that do not go together; ``{name}`` in the text stands for one of them, however that is spelled."""

    def __init__(self, text: str) -> None:
        super().__init__(spell_options(text, str))
        self.text = text


def spell_options(text: str, spell: Callable[[str], str]) -> str:
    """Return a text with each ``{name}`` spelled as an option of that name is."""
    return re.sub(r"\{(\w+)\}", lambda name: spell(name[1]), text)


def options_of(table: type[OptionTable]) -> dict[str, Option]:
    """Return the options of a table by name, those of nested tables in their place.

    Examples
    --------
    >>> from voxrt import BuildOptions
    >>> options_of(BuildOptions)["colours"].default
    32
    """
    found: dict[str, Option] = {}
    for name, made in _fields(table):
        found |= {name: made} if isinstance(made, Option) else options_of(made)
    return found


def compose(table: type[_Table], values: Mapping[str, object]) -> _Table:
    """Make a table with these values of its options, and of those of nested tables."""
    found = {
        name: values[name] if isinstance(made, Option) else compose(made, values)
        for name, made in _fields(table)
        if name in values or not isinstance(made, Option)
    }
    return table(**found)


def check_options(table: OptionTable) -> None:
    """Convert the options of a table exactly, in place; TypeError or ValueError if that is not possible."""
    for name, one in options_of(type(table)).items():
        force_setattr(table, name, one.check(name, getattr(table, name)))


def merge(function: str, table: type[_Table], options: _Table | None, keywords: Mapping[str, Any]) -> _Table:
    """Return a table of options, None for the defaults, with the keywords of a call; `function` is what was called.

    TypeError or ValueError if `options` are no such table, there is no option of such a name, or one is out of range.

    Examples
    --------
    >>> from voxrt import BuildOptions
    >>> merge("build", BuildOptions, None, {"depth": 5}).depth
    5
    """
    from voxrt.voxelize.arguments import instance  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

    merged = instance("options", table() if options is None else options, table)
    names = list(options_of(table))
    if unknown := sorted(set(keywords) - set(names)):
        raise TypeError(f"{function}() has no option {unknown[0]!r}; it has {', '.join(names)}")
    return replace(merged, **keywords) if keywords else merged


def documented(table: type[_Table]) -> type[_Table]:
    """Put the options of a table into its docstring, behind the first paragraph."""
    first, _, rest = (table.__doc__ or "").partition("\n\n")
    lines = [f"    {name}\n        {_python_text(one)}\n" for name, one in options_of(table).items()]
    table.__doc__ = f"{first}\n\n    Attributes\n    ----------\n{''.join(lines)}\n{rest}"
    return table


def _fields(table: type[OptionTable]) -> Iterable[tuple[str, Option | type[OptionTable]]]:
    """Return the names of a table's fields, and what made them. Every field has a default."""
    return zip(table.__struct_fields__, table.__struct_defaults__, strict=True)


def _python_text(one: Option) -> str:
    return " ".join(filter(None, (spell_options(one.text, "`{}`".format), one.python)))
