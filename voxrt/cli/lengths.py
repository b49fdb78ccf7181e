"""Lengths and units of length from the text of the command line."""

from __future__ import annotations

import re
from decimal import Decimal
from math import inf, isfinite
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from cyclopts import Token

_UNITS = {
    "mm": Decimal("0.001"),
    "cm": Decimal("0.01"),
    "m": Decimal(1),
    "in": Decimal("0.0254"),
    "ft": Decimal("0.3048"),
}
_LENGTH = re.compile(
    rf"([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?|[-+]?(?:inf|nan))?\s*({'|'.join(_UNITS)})?", re.IGNORECASE
)


def metres(_type: type, tokens: Sequence[Token]) -> float:
    """Read a length, ``0.05``, ``5cm`` or ``2 in``."""
    return _length(tokens[0].value, alone=False)


def metres_per_unit(_type: type, tokens: Sequence[Token]) -> float:
    """Read a unit of length: its name, or its length in metres."""
    return _length(tokens[0].value, alone=True)


def _length(text: str, *, alone: bool) -> float:
    """Read a length, or where the unit may stand `alone` its name for one of it."""
    found = _LENGTH.fullmatch(text.strip())
    number, unit = found.groups() if found else (None, None)
    if found is None or not (number or (alone and unit)):
        units = f", nor one of the units {', '.join(_UNITS)}" if alone else f", with one of {', '.join(_UNITS)} or none"
        raise ValueError(f"{text!r} is not a number{units}")
    try:
        length = float(Decimal(number or 1) * _UNITS[unit.lower() if unit else "m"])
    except ArithmeticError:
        length = inf
    if not isfinite(length):
        raise ValueError(f"{text} is not a finite number")
    if length <= 0:
        raise ValueError(f"{text} is not a positive number of metres")
    return length
