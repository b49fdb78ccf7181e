"""Anti-aliasing: several rays per pixel, averaged in linear light.

Each sample is a whole frame of a camera that is moved by a part of a pixel. So every device can take them, and two
devices can be compared sample by sample.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.octree.camera.camera import DIRECTION_LIMIT, REGISTER_LIMIT, as_triple

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from voxrt.octree.camera.camera import Camera

SAMPLES = (1, 2, 4)
"""Samples per pixel on each axis of the picture."""


def sample_cameras(camera: Camera, size: tuple[int, int], samples: int) -> tuple[Camera, ...]:
    """Give the ``samples**2`` cameras of the samples of a picture: rows of samples from the top, each from the left.

    `samples`, one of :data:`SAMPLES`, is per pixel on each axis. With 1 it is the camera itself. The looks are moved to
    the middles of equal parts of a pixel, rounded to whole registers. Where a register would not fit, all looks are
    shortened alike, by less than a thousandth.

    Examples
    --------
    >>> from voxrt.octree.camera import Camera
    >>> cameras = sample_cameras(Camera((0, 0, 0), (0, 0, -900), (4, 0, 0), (0, 4, 0)), (64, 48), 2)
    >>> [camera.look[:2] for camera in cameras]
    [(-1, 1), (1, 1), (-1, -1), (1, -1)]
    """
    if samples == 1:
        return (camera,)
    scale = _room(camera, size)
    look, right, up = (scale * np.array(triple, np.int64) for triple in (camera.look, camera.right, camera.up))
    # In units of 1 / (2 samples) pixel the middles are the odd numbers around 0.
    steps = np.arange(1 - samples, samples, 2)
    looks = [look + (right * x - up * y + samples) // (2 * samples) for y in steps for x in steps]
    longest = max(int(np.abs(moved).max()) for moved in looks)
    if longest >= REGISTER_LIMIT:
        looks = [np.sign(moved) * (np.abs(moved) * (REGISTER_LIMIT - 1) // longest) for moved in looks]
    return tuple(replace(camera, look=as_triple(moved), right=as_triple(right), up=as_triple(up)) for moved in looks)


def average_samples(pictures: Iterable[NDArray[np.uint8]]) -> NDArray[np.uint8]:
    """Average one or more pictures in linear light: uint8, shape (H, W, 3), sRGB, rounded to nearest, halves up.

    Examples
    --------
    >>> import numpy as np
    >>> black, white = np.zeros((1, 1, 3), np.uint8), np.full((1, 1, 3), 255, np.uint8)
    >>> average_samples([black, white]).tolist()
    [[[188, 188, 188]]]
    """
    light = [_LIGHT[picture] for picture in pictures]
    return _encoded(sum(light[1:], start=light[0]), np.array(len(light)))


def average_cut_out(pictures: Iterable[NDArray[np.uint8]], hits: Iterable[NDArray[np.bool_]]) -> NDArray[np.uint8]:
    """Average what is seen of a scene in linear light, on a transparent background.

    The pictures, one or more, are uint8, shape (H, W, 3), sRGB. Each has its `hits`, bool, shape (H, W): the pixels
    that show the scene. Returns uint8, shape (H, W, 4): sRGB of the samples that hit, and the share of samples that do,
    0 … 255; all 0 where none does.
    """
    masks = list(hits)
    light = [_LIGHT[picture] * mask[..., None] for picture, mask in zip(pictures, masks, strict=True)]
    count = np.asarray(np.sum(masks, axis=0, dtype=np.int64))
    colour = _encoded(sum(light[1:], start=light[0]), np.maximum(count, 1)[..., None])
    alpha = (2 * 255 * count + len(masks)) // (2 * len(masks))
    return np.concatenate([colour, alpha[..., None].astype(np.uint8)], axis=2)


def _room(camera: Camera, size: tuple[int, int]) -> int:
    """Give the largest factor that leaves all registers and directions in their ranges: parts of a pixel need it."""
    width, height = size
    rows = np.abs(np.array((camera.look, camera.right, camera.up), np.int64))
    reach = rows[0] + rows[1] * (width // 2 + 1) + rows[2] * (height // 2 + 1)
    largest, longest = int(rows.max()), int(reach.max())
    return max(1, min((REGISTER_LIMIT - 1) // max(1, largest), (DIRECTION_LIMIT - 1) // max(1, longest)))


def _encoded(light: NDArray[np.int64], count: NDArray[np.int64]) -> NDArray[np.uint8]:
    return np.searchsorted(_BETWEEN, light / count, side="right").astype(np.uint8)


def _light(srgb: NDArray[np.float64]) -> NDArray[np.int64]:
    # IEC 61966-2-1:1999; whole numbers, so that a sum is the same on every machine.
    encoded = srgb / 255
    linear = np.where(encoded <= 0.04045, encoded / 12.92, np.power((encoded + 0.055) / 1.055, 2.4))
    return np.floor(linear * (1 << 24) + 0.5).astype(np.int64)


_LIGHT = _light(np.arange(256.0))
_BETWEEN = _light(np.arange(0.5, 255))
