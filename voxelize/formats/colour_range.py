"""Colours of files that are beyond their range: they are clamped to it, and counted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from voxrt.voxelize.warning_log import WarningLog

CLAMPED = "colours beyond their range, which is 0 to 1 for real numbers, were clamped"


def clamped(colours: ArrayLike, log: WarningLog) -> NDArray[np.float64]:
    """Return colours within 0 … 1, float64, shape (…, C), and count those that were not; what is no number becomes 0.

    >>> from voxrt.voxelize.warning_log import WarningLog
    >>> log = WarningLog()
    >>> clamped([[0.5, 3.0, -1.0], [0.0, 0.0, 1.0]], log)
    array([[0.5, 1. , 0. ],
           [0. , 0. , 1. ]])
    >>> log.warnings()[0].count
    1
    """
    values = np.asarray(colours, np.float64)
    within = (values >= 0.0) & (values <= 1.0)
    if within.all():
        return values
    log.add("colour-range", CLAMPED, int((~within).any(axis=-1).sum()))
    return np.clip(np.nan_to_num(values, nan=0.0, posinf=1.0, neginf=0.0), 0.0, 1.0)
