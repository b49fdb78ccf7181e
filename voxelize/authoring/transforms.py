"""Placement of solids: scale, rotation and translation as one matrix."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import arguments

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

FARTHEST = 1e9
"""The largest length and coordinate, in metres; products of three lengths stay finite."""


class SolidError(ValueError):
    """Dimensions or a surface that make no solid; the message is one line, without a full stop."""


def placement(
    translate: Sequence[float] = (0, 0, 0), rotate: Sequence[float] = (0, 0, 0), scale: float | Sequence[float] = 1
) -> NDArray[np.float64]:
    """Return the matrix that scales, then rotates, then moves: float64, shape (4, 4), column vectors.

    Parameters
    ----------
    translate
        Metres along x, y and z.
    rotate
        Degrees about x, then y, then z, counter-clockwise as seen from the positive end of the axis. Quarter turns are
        exact.
    scale
        One factor, or one per axis; a negative factor mirrors.

    Raises
    ------
    TypeError, ValueError
        An argument that is not finite numbers of that shape.
    SolidError
        A scale of 0, or a number beyond :data:`FARTHEST`.

    Examples
    --------
    >>> placement(translate=(1, 2, 3), scale=2)
    array([[2., 0., 0., 1.],
           [0., 2., 0., 2.],
           [0., 0., 2., 3.],
           [0., 0., 0., 1.]])
    """
    factors = arguments.real_array("scale", scale, (3,) if np.ndim(scale) else ())
    if not factors.all():
        raise SolidError(f"scale must not be 0, not {factors.tolist()}")
    rotate, translate = arguments.vector("rotate", rotate), arguments.vector("translate", translate)
    for name, values in (("translate", translate), ("rotate", rotate), ("scale", factors)):
        if not (np.abs(np.asarray(values)) <= FARTHEST).all():
            raise SolidError(f"{name} {np.asarray(values).tolist()} is beyond {FARTHEST:g}")
    turn = np.eye(3)
    for axis, degrees in enumerate(rotate):
        cosine, sine = _exact_cosine(degrees), _exact_cosine(degrees - 90)
        one = np.eye(3)
        after, last = (axis + 1) % 3, (axis + 2) % 3
        one[[after, after, last, last], [after, last, after, last]] = cosine, -sine, sine, cosine
        turn = one @ turn
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.broadcast_to(factors, 3)
    matrix[:3, 3] = translate
    return matrix


def _exact_cosine(degrees: float) -> float:
    quarter, rest = divmod(degrees % 360.0, 90.0)
    if rest == 0:
        return (1.0, 0.0, -1.0, 0.0)[int(quarter) % 4]
    return float(np.cos(np.deg2rad(degrees)))
