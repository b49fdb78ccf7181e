"""Benchmark of ``--interior``: the words of scenes whose hidden voxels keep their materials, take one, or take any.

Usage: ``python bench/interior.py [--write]``. ``--write`` puts the table into ``bench/results/interior.md`` as well.
Scenes: the project's own, MagicaVoxel scenes where they are there, generated balls. "one" is the material that most
solid voxels have. Seconds are those of finding what is hidden, and of sharing it.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np
from report import ASSETS, ROOT, options_of, publish, table

import voxrt
from voxrt import export, octree

if TYPE_CHECKING:
    from collections.abc import Iterator

HEAD = ("scene", "side", "solid", "hidden", "keep", "one", "any", "saved", "find", "share")


def scenes() -> Iterator[tuple[str, octree.Octree]]:
    """Give the name and the octree of each scene."""
    for path in sorted((ROOT / "examples").glob("*.glb")):
        yield path.stem, voxrt.build(path, depth=9).rom.octree
    for path in sorted(ASSETS.glob("vox/*/vox/scene_*.vox")):
        rom, _ = export.read_vox(path)
        yield rom.name, rom.octree
    for name, materials in balls(256):
        yield name, octree.from_dense(materials)


def balls(side: int) -> Iterator[tuple[str, np.ndarray]]:
    """Balls of 64 colours in patches, in noise, or as shells of two voxels; uint8, cubes indexed [x, y, z]."""
    axis = np.arange(side) + 0.5 - side / 2
    distance = np.sqrt(axis[:, None, None] ** 2 + axis[None, :, None] ** 2 + axis[None, None, :] ** 2)
    ball, inside = distance < 0.45 * side, distance < 0.45 * side - 2
    x, y, z = (place // 3 for place in np.indices((side,) * 3, np.uint16))
    patches = (1 + (7 * x + 13 * y + 29 * z) % 64).astype(np.uint8)
    noise = np.random.default_rng(0).integers(1, 65, ball.shape, np.uint8)
    yield "ball of one material", ball.astype(np.uint8)
    for name, texture in (("patches", patches), ("noise", noise)):
        yield f"ball, shell of 64 colours in {name}", np.where(inside, 65, texture * ball).astype(np.uint8)
        yield f"ball, 64 colours in {name} throughout", texture * ball


def measure(name: str, tree: octree.Octree) -> tuple[str, ...]:
    tree = octree.share(tree)
    start = time.perf_counter()
    hidden = octree.hidden_voxels(tree)
    found = time.perf_counter()
    shared = octree.share_hidden(tree, hidden)
    end = time.perf_counter()
    voxels = octree.census(tree).voxels
    common = max((count, material) for material, count in voxels.items() if material != 0)[1]
    words = [len(each.words) for each in (tree, octree.fill_hidden(tree, hidden, common), shared)]
    return (
        name,
        f"{tree.size}",
        f"{octree.census(tree).solid_voxels:,}",
        f"{octree.census(hidden).solid_voxels:,}",
        *(f"{count:,}" for count in words),
        f"{100 - 100 * words[2] / words[0]:.1f} %",
        f"{found - start:.2f} s",
        f"{end - found:.2f} s",
    )


def main() -> None:
    parser = options_of(__doc__)
    options = parser.parse_args()
    text = table(HEAD, (measure(name, tree) for name, tree in scenes()))
    title = "# Hidden voxels that may be anything\n\nMemory words by `--interior`.\n\n"
    publish("interior.md", title + text, write=options.write)


if __name__ == "__main__":
    main()
