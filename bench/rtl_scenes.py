"""The scenes that the ray tracer is measured with, for rtl.py and threads.py."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import from_dense
from voxrt.octree.dialects import leaf_materials

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Scene:
    """A memory, where it is seen from, and where a light would be, in 1/16 voxel."""

    name: str
    words: NDArray[np.uint32]
    depth: int
    camera: NDArray[np.int32]
    light: NDArray[np.int32]


def grid(side: int) -> NDArray[np.float64]:
    """Give the middles of voxels, indexed [axis, x, y, z]."""
    return np.stack(np.meshgrid(*[np.arange(side) + 0.5] * 3, indexing="ij"))


def terrain(depth: int) -> NDArray[np.uint8]:
    side = 1 << depth
    x, y, z = grid(side)
    height = side / 3 + sum(
        side / (8 * f) * np.sin(f * 6.3 * x / side + f) * np.cos(f * 5.1 * z / side) for f in (1, 2, 3.7, 7)
    )
    return np.where(y < height, np.where(y < side / 3, 1, 2), 0).astype(np.uint8)


def sphere_and_boxes(depth: int) -> NDArray[np.uint8]:
    side = 1 << depth
    place = grid(side) / side
    voxels = np.where(((place - 0.55) ** 2).sum(axis=0) < 0.06, 1, 0).astype(np.uint8)
    for number, corner in enumerate([(0.1, 0, 0.2), (0.7, 0, 0.1), (0.15, 0.1, 0.7), (0.75, 0, 0.75)]):
        low = np.array(corner)[:, None, None, None]
        voxels[((place >= low) & (place < low + 0.17)).all(axis=0)] = number + 2
    voxels[:, 0] = 6
    return voxels


def menger(depth: int) -> NDArray[np.uint8]:
    """Make a Menger sponge of four steps, 81 voxels per side."""
    x, y, z = np.meshgrid(*[np.arange(81)] * 3, indexing="ij")
    solid = np.ones((81,) * 3, bool)
    for power in (1, 3, 9, 27):
        middle = sum((axis // power % 3 == 1).astype(int) for axis in (x, y, z))
        solid &= middle < 2
    voxels = np.zeros((1 << depth,) * 3, np.uint8)
    voxels[20:101, 20:101, 20:101] = solid
    return voxels


def corner_camera(depth: int, size: tuple[int, int]) -> NDArray[np.int32]:
    """Look at the world's middle from above its near corner; the world fills the picture."""
    side = 1 << depth
    eye = np.array([-0.25, 1.1, -0.3]) * side
    look = np.array([0.5, 0.45, 0.5]) * side - eye
    look /= np.linalg.norm(look)
    right = np.cross(look, [0, 1, 0])
    right /= np.linalg.norm(right)
    up = np.cross(right, look)
    scale = 0.9 / max(size)
    frame = np.array([look, right * scale, up * scale]) * 30000
    return np.array([np.rint(eye * 16), *np.rint(frame)], np.int32)


def published_house(folder: Path) -> NDArray[np.uint32]:
    """Read the published house; its air is both FFFFFFF0 and FFFFFF00."""
    words = np.array([int(word, 16) for word in (folder / "house.mem").read_text().split()], np.uint32)
    return leaf_materials(words, "seed-rtl")


def scenes(memories: Path, size: tuple[int, int]) -> list[Scene]:
    found = []
    if (memories / "house.mem").exists():
        camera = np.array([[450 * 16, 600 * 16, 300 * 16], [0, 0, 90], [1, 0, 0], [0, 1, 0]], np.int32)
        light = np.array([600, 800, 350], np.int32) * 16
        found.append(Scene("published house, depth 10", published_house(memories), 10, camera, light))
    for name, make in (("terrain", terrain), ("sphere and boxes", sphere_and_boxes), ("Menger sponge", menger)):
        words = from_dense(make(7)).words
        light = np.array([32, 192, 16], np.int32) * 16
        found.append(Scene(f"{name}, 128 per side", words, 7, corner_camera(7, size), light))
    return found
