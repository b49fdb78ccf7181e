"""What both engines take: palettes, shading and cameras as arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree import Rom
    from voxrt.octree.camera import Camera, Lighting


def palette_of(rom: Rom) -> NDArray[np.uint8]:
    """Return the colours that the engines take: uint8, shape (256, 3), sRGB, a row per material id.

    Examples
    --------
    >>> from voxrt.octree import Rom, from_points
    >>> from voxrt.voxelize import EMPTY, Material
    >>> rom = Rom("dot", from_points([[1, 1, 1]], [1], depth=2), (EMPTY, Material("red", (255, 0, 0))))
    >>> palette_of(rom)[1].tolist()
    [255, 0, 0]
    """
    palette = np.zeros((256, 3), dtype=np.uint8)
    for number, material in enumerate(rom.materials):
        palette[number] = material.colour
    return palette


def shading_of(rom: Rom, lighting: Lighting) -> dict[str, Any]:
    """Return the arguments of both engines that say what brightness depends on, and which materials are mirrors."""
    mirrors = np.zeros(256, dtype=np.uint8)
    mirrors[: len(rom.materials)] = [material.mirror for material in rom.materials]
    return {
        "flat": lighting.flat,
        "brightness": None if lighting.faces is None else np.array(lighting.faces, dtype=np.uint8),
        "light": np.array(lighting.position, dtype=np.int32) if lighting.on else None,
        "ambient": lighting.ambient if lighting.on else 0,
        "bounces": lighting.bounces,
        "mirrors": mirrors,
    }


def registers_of(camera: Camera) -> NDArray[np.int32]:
    """Return a camera's registers: int32, shape (4, 3): position, look, right, up."""
    return np.array([camera.position, camera.look, camera.right, camera.up], dtype=np.int32)
