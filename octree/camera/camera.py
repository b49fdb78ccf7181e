"""The camera's registers and the rays that they make."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

Triple = tuple[int, int, int]

POSITION_UNITS = 16
"""Camera positions count in this fraction of a voxel."""

DIRECTION_LIMIT = 1 << 20
"""Every component of a pixel's direction is smaller than this."""

REGISTER_LIMIT = 1 << 15
"""Every component of look, right and up is smaller than this."""


class Camera(Value, frozen=True):
    """What the ray generator reads: direction = look + right * (column - W // 2) + up * (H // 2 - row).

    Attributes
    ----------
    position
        Signed, 1/16 voxel, grid frame; may stand outside the world.
    look, right, up
        Signed 16 bit each, grid axes, any common scale. Cameras made for people are right-handed: right = look x up.
    """

    position: Triple
    look: Triple
    right: Triple
    up: Triple


def camera_from_registers(position: ArrayLike, look: ArrayLike, right: ArrayLike, up: ArrayLike) -> Camera:
    """Make a camera of raw direction triples, of either handedness.

    Parameters
    ----------
    position
        float, shape (3,), voxels, grid frame; rounded to 1/16 voxel.
    look, right, up
        int, shape (3,), signed 16 bit.

    Raises
    ------
    ValueError
        A value that its register cannot hold.
    """
    place = np.asarray(position, dtype=np.float64)
    if place.shape != (3,) or not np.all(np.abs(place) < 2**31 / POSITION_UNITS - 1):
        raise ValueError(f"camera position {place.tolist()} is not three numbers that fit signed 32 bits of 1/16 voxel")
    return Camera(
        position=as_triple(np.rint(place * POSITION_UNITS)),
        look=_register("look", look),
        right=_register("right", right),
        up=_register("up", up),
    )


def pixel_directions(camera: Camera, size: tuple[int, int]) -> NDArray[np.int64]:
    """Compute the direction of every pixel's ray (int64, shape (H, W, 3)), as the ray generator does."""
    width, height = size
    look, right, up = (np.array(triple, dtype=np.int64) for triple in (camera.look, camera.right, camera.up))
    columns = np.arange(width, dtype=np.int64) - width // 2
    rows = height // 2 - np.arange(height, dtype=np.int64)
    directions: NDArray[np.int64] = look + right * columns[None, :, None] + up * rows[:, None, None]
    return directions


def _register(name: str, values: ArrayLike) -> Triple:
    array = np.asarray(values)
    if array.shape != (3,) or not np.all(array == np.rint(array)) or not np.all(np.abs(array) < REGISTER_LIMIT):
        raise ValueError(f"camera {name} {array.tolist()} is not three whole numbers of signed 16 bits")
    return as_triple(array)


def as_triple(values: NDArray[np.generic]) -> Triple:
    """Return three whole numbers of an array."""
    x, y, z = (int(value) for value in values.tolist())
    return x, y, z
