"""Which of the voxels that a solid touches are filled, and what becomes of parts that are too thin for that."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

Rule: TypeAlias = Literal["touch", "centre", "half"]
Thin: TypeAlias = Literal["keep", "drop"]
RULES: tuple[Rule, ...] = get_args(Rule)
THIN_CHOICES: tuple[Thin, ...] = get_args(Thin)
