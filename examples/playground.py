"""The scene of playground.toml, made in Python: ``python examples/playground.py`` builds and renders it."""

from __future__ import annotations

from functools import reduce
from typing import TYPE_CHECKING

import numpy as np

import voxrt
from voxrt import octree, voxelize
from voxrt.voxelize import authoring
from voxrt.voxelize.authoring import Solid, box, box_between, extrude, sphere

if TYPE_CHECKING:
    from voxrt.voxelize import Scene

COLOURS = {
    "grass": "#6aa84f",
    "red": "#d9453c",
    "blue": "#3f6fd0",
    "mirror": "#c8ccd8",
    "plaster": "#faecc8",
    "tiles": "#d65438",
    "timber": "#845434",
    "fur": "#eca95c",
    "paws": "#fff4e2",
    "nose": "#302a30",
}


def block(size: tuple[float, float, float], corner: tuple[float, float, float]) -> Solid:
    """Return a box by its lowest corner."""
    return box_between(corner, np.add(corner, size))


def walls() -> Solid:
    """Return the walls of the house: a prism without its room, its doorway and its windows."""
    prism = extrude([(0, 0), (1.5, 0), (3, 1.5), (1.5, 3), (0, 3)], 3.25, axis="x")
    openings = [
        block((2.75, 1.375, 2.5), (0.25, 0.125, 0.25)),
        block((0.75, 1.125, 1), (1, 0.125, 2.5)),
        block((0.5, 0.5, 1), (0.375, 0.625, 2.5)),
        block((0.5, 0.5, 1), (2.375, 0.625, 2.5)),
    ]
    return reduce(Solid.__sub__, openings, prism)


def legs() -> Solid:
    """Return the dog's legs."""
    feet = [(-0.25, 0, -0.05), (0.1, 0, -0.05), (-0.25, 0, -0.9), (0.1, 0, -0.9)]
    return reduce(Solid.__or__, (block((0.15, 0.4, 0.15), foot) for foot in feet))


def playground() -> Scene:
    """Return the scene."""
    made = authoring.Author("playground", background="#b4d8f0")
    for name, colour in COLOURS.items():
        made.material(name, colour, mirror=name == "mirror")

    made.add("blocks/red", block((1, 1, 1), (1, 0, 5)), material="red", collider="box")
    made.add("blocks/blue", block((1, 2, 1), (2.5, 0, 5)), material="blue", collider="box")
    made.add("blocks/ball", sphere(0.5, centre=(3, 2.5, 5.5)), material="mirror")

    at = (1, 0, 1)
    roof = [(1.25, -0.25), (1.5, -0.25), (3.25, 1.5), (1.5, 3.25), (1.25, 3.25), (3, 1.5)]
    made.add("house/door", block((0.75, 1.25, 0.125), (1.25, 0, 2.75)), material="timber", collider="box", translate=at)
    made.add("house/chimney", block((0.5, 1.5, 0.5), (2.5, 2.25, 0.75)), material="tiles", translate=at)
    made.add("house/roof", extrude(roof, 3.75, axis="x"), material="tiles", translate=at)
    made.add("house/walls", walls(), material="plaster", translate=(1.25, 0, 1))

    eyes = box((0.08, 0.08, 0.06), centre=(-0.14, 1.1, 0.48)) | box((0.08, 0.08, 0.06), centre=(0.14, 1.1, 0.48))
    for name, material, solid in (
        ("nose", "nose", box((0.12, 0.12, 0.06), centre=(0, 0.9, 0.78))),
        ("snout", "paws", box((0.3, 0.25, 0.3), centre=(0, 0.85, 0.62))),
        ("eyes", "nose", eyes),
        ("head", "fur", box((0.5, 0.5, 0.5), centre=(0, 1, 0.25))),
        ("body", "fur", box((0.5, 0.4, 1), centre=(0, 0.6, -0.4))),
        ("legs", "paws", legs()),
        ("tail", "fur", box((0.12, 0.5, 0.12), centre=(0, 0.95, -0.85))),
    ):
        made.add(f"dog/{name}", solid, material=material, translate=(5.75, 0, 5.25), rotate=(0, -30, 0))

    made.add("lawn", block((8, 0.25, 8), (0, -0.25, 0)), material="grass", collider="box")
    made.look((13, 7, 15), (3.75, 1, 4))
    made.light((6, 9, 12))
    return made.build()


if __name__ == "__main__":
    scene = playground()
    grid = voxelize.fit_grid(scene, depth=7)
    voxels = voxelize.voxelize(scene, grid).voxels
    rom = octree.Rom(scene.name, octree.build(voxels), scene.materials, grid)
    frame = voxrt.render(rom, size=(640, 480), engine="rtl")
    print(f"{len(scene.objects)} objects, {rom.octree.blocks} blocks, {frame.cost.cycles:,} clocks per frame")
