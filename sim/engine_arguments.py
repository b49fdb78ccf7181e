"""What both engines take: palettes, shading and cameras as arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from voxrt.octree import Rom
    from voxrt.octree.camera import Camera, Lighting
    from voxrt.voxelize import Material


def palette_of(materials: Sequence[Material]) -> NDArray[np.uint8]:
    """Return the colours that the engines take: uint8, shape (256, 3), sRGB, a row per material id.

    Examples
    --------
    >>> from voxrt.voxelize import EMPTY, Material
    >>> palette_of((EMPTY, Material("red", (255, 0, 0))))[1].tolist()
    [255, 0, 0]
    """
    palette = np.zeros((256, 3), dtype=np.uint8)
    for number, material in enumerate(materials):
        palette[number] = material.colour
    return palette


def mirrors_of(materials: Sequence[Material]) -> NDArray[np.bool_]:
    """Return which materials are mirrors: bool, shape (256,), by id."""
    mirrors = np.zeros(256, dtype=np.bool_)
    mirrors[: len(materials)] = [material.mirror for material in materials]
    return mirrors


def shading_of(rom: Rom, lighting: Lighting) -> dict[str, Any]:
    """Return the arguments of both engines that say what brightness depends on, and which materials are mirrors."""
    return {
        "flat": lighting.flat,
        "brightness": None if lighting.faces is None else np.array(lighting.faces, dtype=np.uint8),
        "light": np.array(lighting.position, dtype=np.int32) if lighting.on else None,
        "ambient": lighting.ambient if lighting.on else 0,
        "bounces": lighting.bounces,
        "mirrors": mirrors_of(rom.materials).astype(np.uint8),
    }


def registers_of(camera: Camera) -> NDArray[np.int32]:
    """Return a camera's registers: int32, shape (4, 3): position, look, right, up."""
    return np.array([camera.position, camera.look, camera.right, camera.up], dtype=np.int32)
