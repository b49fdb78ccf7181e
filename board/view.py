"""The view of a frame: camera, size, background, light and features."""

from __future__ import annotations

from dataclasses import dataclass

Triple = tuple[int, int, int]

FEATURES = ("flat", "shadows", "mirrors")
"""Optional features of a device, in the order in which users see them."""


@dataclass(frozen=True, slots=True)
class Camera:
    """The ray generator's registers: direction = look + right * (column - W // 2) + up * (H // 2 - row).

    Attributes
    ----------
    position
        Signed, 1/16 voxel, grid frame.
    look, right, up
        Signed 16 bit each, grid axes, any common scale.
    """

    position: Triple
    look: Triple
    right: Triple
    up: Triple


@dataclass(frozen=True, slots=True)
class View:
    """All that decides the pixels of a frame besides the scene.

    Attributes
    ----------
    camera
        Where from.
    size
        Columns and rows.
    background
        sRGB of pixels that hit nothing, 0 ... 255 each.
    light
        Where the point light of the shadows stands, 1/16 voxel.
    ambient
        0 ... 255, in 1/256: the brightness that no shadow goes below.
    features
        Which of :data:`FEATURES` are on.
    bounces
        How many mirrors a ray may meet, 0 ... 15.
    """

    camera: Camera
    size: tuple[int, int]
    background: Triple = (0, 0, 0)
    light: Triple = (0, 0, 0)
    ambient: int = 32
    features: frozenset[str] = frozenset()
    bounces: int = 4
