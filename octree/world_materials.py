"""The materials of a world, which grow."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize import DoesNotFitError
from voxrt.voxelize.materials import MATERIAL_LIMIT

if TYPE_CHECKING:
    from collections.abc import Iterable

    from voxrt.voxelize import Material


def add_missing(materials: tuple[Material, ...], wanted: Iterable[Material]) -> tuple[Material, ...]:
    """Return a world's materials, and behind them those of `wanted` that it has not; DoesNotFitError for too many.

    Entry 0, empty space, is none of those that it has.
    """
    missing = [material for material in dict.fromkeys(wanted) if material not in materials[1:]]
    if missing and len(materials) + len(missing) > MATERIAL_LIMIT + 1:
        raise DoesNotFitError(
            f"the world has {len(materials) - 1} materials and can have {MATERIAL_LIMIT}: there is no room for "
            f"{missing[0].name!r}"
        )
    return (*materials, *missing)
