"""Which voxels of an object are filled: its inside or not, which of those that it touches, and what of thin parts."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

ObjectFill: TypeAlias = Literal["solid", "surface", "auto"]
Rule: TypeAlias = Literal["touch", "centre", "half"]
Thin: TypeAlias = Literal["keep", "drop"]
OBJECT_FILLS: tuple[ObjectFill, ...] = get_args(ObjectFill)
RULES: tuple[Rule, ...] = get_args(Rule)
THIN_CHOICES: tuple[Thin, ...] = get_args(Thin)
