"""The view of a frame: camera, size, background, lighting."""

from __future__ import annotations

from voxrt.octree.camera import (
    FACES,
    FEATURES,
    PLAIN_LIGHTING,
    Camera,
    Faces,
    Lighting,
    Shading,
    Triple,
    frame_world,
    refit,
)
from voxrt.voxelize.value import Value

__all__ = ["FACES", "FEATURES", "Camera", "Faces", "Lighting", "Shading", "Triple", "View", "frame_world", "refit"]


class View(Value, frozen=True):
    """A frame that a device is asked for.

    Attributes
    ----------
    camera
        Where from.
    size
        Columns and rows.
    background
        sRGB of pixels that hit nothing, 0 ... 255 each.
    lighting
        Brightness of faces, light, mirrors.
    frame
        Frame of the scene's animation, counted from 0.
    """

    camera: Camera
    size: tuple[int, int]
    background: Triple = (0, 0, 0)
    lighting: Lighting = PLAIN_LIGHTING
    frame: int = 0
