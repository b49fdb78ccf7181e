"""Cameras of files as viewpoints: glTF and USD cameras both look along -z of their own frame, and y is up."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.scene import Viewpoint

if TYPE_CHECKING:
    from numpy.typing import NDArray


def camera_viewpoint(
    name: str, transform: NDArray[np.float64], field_of_view: float, shift: tuple[float, float] = (0.0, 0.0)
) -> Viewpoint | None:
    """Return the viewpoint of a camera; None where its transform or its field of view makes no picture.

    `transform`, float64, shape (4, 4), column vectors, takes the camera's frame to the scene frame; its scale has no
    effect. `field_of_view` is in degrees from the picture's top to its bottom, and `shift` as in :class:`Viewpoint`.
    """
    if not (np.isfinite(transform).all() and np.isfinite(shift).all() and 0 < field_of_view < 180):
        return None
    eye, sight, up = transform[:3, 3], -transform[:3, 2], transform[:3, 1]
    lengths = [float(np.linalg.norm(vector)) for vector in (sight, up)]
    if min(lengths) < np.finfo(np.float64).tiny:
        return None
    sight, up = sight / lengths[0], up / lengths[1]
    if np.linalg.norm(np.cross(sight, up)) < _LEAST_SINE:
        return None
    # Far enough from the eye that rounding does not turn the line of sight.
    target = eye + sight * max(1.0, float(np.abs(eye).max()))
    return Viewpoint(_triple(eye), _triple(target), field_of_view, _triple(up), name, shift)


_LEAST_SINE = 1e-6


def _triple(vector: NDArray[np.float64]) -> tuple[float, float, float]:
    x, y, z = vector.tolist()
    return x, y, z
