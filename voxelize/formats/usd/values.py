"""Attribute values as numbers: a layer may give an attribute any type, whatever the schema requires."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray
    from pxr import Usd


def integers(attribute: Usd.Attribute, time: Usd.TimeCode, path: Path) -> NDArray[np.int64]:
    """Return an attribute's integers, int64, flat; none where it has no value. Raise AssetError for other values."""
    value = attribute.Get(time)
    try:
        found = np.array([] if value is None else value)
        if found.size and not np.issubdtype(found.dtype, np.integer):
            raise TypeError  # noqa: TRY301 -- one report for every wrong kind
    except (TypeError, ValueError):
        raise _wrong(attribute, path, "integers") from None
    return found.astype(np.int64).reshape(-1)


def points(attribute: Usd.Attribute, time: Usd.TimeCode, path: Path) -> NDArray[np.float64]:
    """Return an attribute's points, float64, shape (N, 3); none where it has no value.

    Raise AssetError for other values.
    """
    value = attribute.Get(time)
    try:
        found = np.array([] if value is None else value, dtype=np.float64)
        if found.size and found.shape != (len(found), 3):
            raise TypeError  # noqa: TRY301
    except (TypeError, ValueError):
        raise _wrong(attribute, path, "points") from None
    return found.reshape(-1, 3)


def numbers(value: object, count: int) -> tuple[float, ...] | None:
    """Return the first `count` numbers of a value; None where it has fewer or is something else."""
    if isinstance(value, (int, float)) and count == 1:
        return (float(value),)
    try:
        found = [float(one) for one in value]  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        return None
    return tuple(found[:count]) if len(found) >= count else None


def _wrong(attribute: Usd.Attribute, path: Path, wanted: str) -> AssetError:
    problem = f"{attribute.GetName()} holds values that are not {wanted}"
    return AssetError(path, problem, place=str(attribute.GetPrim().GetPath()), fix="export it again")
