"""Scenes of devices as the memories that worlds begin with, and back."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.octree import Octree, Rom, census
from voxrt.sim.engine_arguments import mirrors_of, palette_of
from voxrt.voxelize import Material

if TYPE_CHECKING:
    from collections.abc import Sequence

    from voxrt.board.scene import Scene

_IDS = tuple(str(number) for number in range(256))


def rom_of(scene: Scene) -> Rom:
    """Give the memory of a scene, with the materials that it uses.

    Materials whose names are not known are called by their ids.
    """
    octree = Octree(scene.depth, scene.words)
    count = max(len(scene.names), 1 + max(census(octree).voxels))
    names = ["empty", *(f"material {number}" for number in range(1, count))]
    names[: len(scene.names)] = scene.names
    rows = zip(names, scene.colours[:count].tolist(), scene.mirrors[:count].tolist(), strict=True)
    return Rom(scene.name, octree, tuple(Material(name, tuple(colour), mirror) for name, colour, mirror in rows))


def with_materials(scene: Scene, materials: Sequence[Material]) -> Scene:
    """Give a scene other materials, by id."""
    names = tuple(material.name for material in materials)
    return replace(scene, colours=palette_of(materials), mirrors=mirrors_of(materials), names=names)


def with_numbers(scene: Scene) -> Scene:
    """Give the materials of a scene their ids as names and one colour, so that worlds keep the ids."""
    return replace(scene, names=_IDS, colours=palette_of(()), mirrors=mirrors_of(()))


def same_materials(scene: Scene, other: Scene) -> bool:
    """Whether two scenes have the same colours and mirrors."""
    return np.array_equal(scene.colours, other.colours) and np.array_equal(scene.mirrors, other.mirrors)
