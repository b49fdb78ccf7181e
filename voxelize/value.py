"""The base of the API's values: structs of msgspec that :mod:`dataclasses` takes for frozen dataclasses.

Python compiles several functions for each dataclass, half a millisecond per class at every start. A struct takes a
tenth of that.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING, Any

from msgspec import NODEFAULT, Struct, StructMeta

if TYPE_CHECKING:
    from dataclasses import Field
    from inspect import Signature
    from typing import ClassVar


@cache
def _twin(struct: type[Struct]) -> type:
    """Return a dataclass with the fields of a struct."""
    from dataclasses import MISSING, field, make_dataclass  # noqa: PLC0415 - for those who ask alone
    from inspect import get_annotations  # noqa: PLC0415

    types: dict[str, Any] = {}
    for base in reversed(struct.__mro__):
        types |= get_annotations(base)
    names, defaults = struct.__struct_fields__, struct.__struct_defaults__
    fields = []
    for name, default in zip(names, (*(NODEFAULT for _ in names[len(defaults) :]), *defaults), strict=True):
        known = {"default_factory": default.factory} if hasattr(default, "factory") else {"default": default}
        if default is NODEFAULT:
            known = {"default": MISSING}
        fields.append((name, types[name], field(kw_only=name not in struct.__match_args__, **known)))
    return make_dataclass(struct.__name__, fields, frozen=True)


class _OfTwin:
    """An attribute of a struct's twin."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, _instance: Struct | None, struct: type[Struct]) -> object:
        return getattr(_twin(struct), self._name)


class _ValueMeta(StructMeta):
    @property
    def __signature__(self) -> Signature:
        """That of the twin: msgspec's own fails where the types of fields are imported for type checkers alone."""
        from inspect import signature  # noqa: PLC0415 - as above

        return signature(_twin(self))


class Value(Struct, metaclass=_ValueMeta, frozen=True):
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
