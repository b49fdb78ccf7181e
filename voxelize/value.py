"""The base of the API's values: structs of msgspec that :mod:`dataclasses` takes for frozen dataclasses.

Python compiles several functions for each dataclass, half a millisecond per class at every start. A struct takes a
tenth of that.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from msgspec import Struct

if TYPE_CHECKING:
    from dataclasses import Field
    from typing import ClassVar


@cache
def _twin(struct: type[Struct]) -> type:
    """Return a dataclass with the fields of a struct, but for their defaults."""
    from dataclasses import make_dataclass  # noqa: PLC0415 - for those who ask alone

    types: dict[str, Any] = {}
    for base in reversed(struct.__mro__):
        types |= vars(base).get("__annotations__", {})
    return make_dataclass(struct.__name__, [(name, types[name]) for name in struct.__struct_fields__], frozen=True)


class _OfTwin:
    """An attribute of a struct's twin."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, _instance: Struct | None, struct: type[Struct]) -> object:
        return getattr(_twin(struct), self._name)


class Value(Struct, frozen=True):
    """A value that never changes.

    Examples
    --------
    >>> from dataclasses import asdict, replace
    >>> from voxrt import Material
    >>> red = Material("red", (255, 0, 0))
    >>> asdict(replace(red, name="brick"))["name"]
    'brick'
    """

    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Field[Any]]]
    else:
        __dataclass_fields__ = _OfTwin("__dataclass_fields__")
        __dataclass_params__ = _OfTwin("__dataclass_params__")
