"""Benchmark of edits: voxels per second, shapes, picks and patches, beside a rebuild of the same voxels.

Usage: ``python bench/edit.py [--write] [--edits 20000] [--operations 100000]``. ``--write`` puts the tables into
``bench/results/edit.md`` as well. The edited voxels stand on the surface, as those that people dig. After each 1,000 of
the random operations all that was edited is compared with a dictionary of voxels, and the counts of references are
checked; at the end, with a build of all voxels.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

import numpy as np
from report import ROOT, machine, options_of, publish, table

import voxrt
from voxrt import octree
from voxrt.octree import Rom, Sphere, World
from voxrt.sim import _model
from voxrt.voxelize import EMPTY, Material

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

MATERIALS = (EMPTY, *(Material(f"layer {i}", (60 + 20 * i, 200 - 20 * i, 90)) for i in range(1, 8)))
RADIUS = 100
SHAPES = 21


def scenes() -> Iterator[tuple[str, Rom, NDArray[np.int64]]]:
    """Give the name of each scene, its memory, and many voxels of its surface."""
    rng = np.random.default_rng(0)
    tree = octree.from_points(*terrain(rng, 12), depth=12)
    yield "terrain, 4096³", Rom("terrain", tree, MATERIALS), surface(tree, rng)
    courtyard = voxrt.build(ROOT / "examples" / "courtyard.glb", depth=12).rom
    yield "courtyard, 4096³", courtyard, surface(courtyard.octree, rng)


def terrain(rng: np.random.Generator, depth: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Give the voxels of a rough terrain, a shell of two, and their materials."""
    side = 1 << depth
    height = np.full((side, side), side / 2)
    for level in range(3, 9):
        knots = rng.normal(size=((1 << level) + 1,) * 2)
        place = np.linspace(0, 1 << level, side, endpoint=False)
        low = place.astype(int)
        part = place - low
        rows = knots[low] * (1 - part)[:, None] + knots[low + 1] * part[:, None]
        height += (rows[:, low] * (1 - part) + rows[:, low + 1] * part) * side / 2 ** (level + 3)
    x, z = np.indices((side, side))
    points = np.concatenate([np.stack([x, height.astype(int) - down, z], axis=-1).reshape(-1, 3) for down in (0, 1)])
    return points, 1 + points[:, 1] // 64 % 4


def surface(tree: octree.Octree, rng: np.random.Generator) -> NDArray[np.int64]:
    """Give voxels that rays from above hit."""
    origins = rng.integers(0, tree.size, (100_000, 3)) + np.array([0.5, 0, 0.5])
    origins[:, 1] = tree.size
    hits = voxrt.cast_rays(tree, origins, [0, -1, 0])
    return hits.voxel[hits.hit].astype(np.int64)


def seconds(work: Callable[[], object]) -> float:
    """Return the processor's seconds, which do not depend on what else the machine does."""
    start = time.process_time()
    work()
    return time.process_time() - start


def measure(name: str, rom: Rom, ground: NDArray[np.int64], edits: int) -> tuple[list[str], list[str]]:
    """Measure the single voxels of a scene, and its shapes."""
    world = World(rom)
    load = seconds(lambda: World(rom))
    voxels = ground[:edits, None]
    alone = seconds(lambda: [world.set(voxel, 0) for voxel in voxels])
    world = World(rom, undo_steps=0)
    sizes = []

    def dig_and_show() -> None:
        for voxel in voxels:
            older = world.live_roots[-1]
            world.set(voxel, 0)
            sizes.append(len(world.commit().addresses))
            if older != world.live_roots[-1]:
                world.release(older)

    shown = seconds(dig_and_show)
    figures = world.figures()
    garbage = 100 * (figures.kept + figures.free) / figures.blocks
    rays = [((x + 0.5, world.size, z + 0.5), (3, -200, 2)) for x, _, z in ground[:10_000].tolist()]
    picks = seconds(lambda: [voxrt.pick(world, *ray) for ray in rays]) / len(rays)
    registers = [([int(16 * one) for one in origin], direction) for origin, direction in rays]
    traces = seconds(lambda: [_model.pick(world.native, *ray) for ray in registers]) / len(rays)
    points, ids = octree.to_points(world.rom().octree, limit=1 << 34) if rom.name == "terrain" else (None, None)
    rebuild = "" if points is None else f"{seconds(lambda: octree.from_points(points, ids, depth=world.depth)):.1f} s"
    single = [
        name,
        f"{len(rom.octree.words):,}",
        f"{load:.2f} s",
        f"{len(voxels) / alone:,.0f}",
        f"{len(voxels) / shown:,.0f}",
        f"{np.mean(sizes):.1f}, at most {max(sizes)}",
        f"{garbage:.2f} %",
        f"{1e6 * picks:.1f} µs, {1e6 * traces:.1f} µs",
        f"{seconds(world.rom):.2f} s",
        rebuild,
    ]
    shapes = [name]
    world = World(rom)
    centres = ground[-SHAPES:]
    for edit in (
        lambda centre: world.fill(Sphere(centre, RADIUS), 0),
        lambda centre: world.paint(Sphere(centre, 2 * RADIUS), 1),
        lambda centre: world.fill(Sphere(centre, RADIUS), 1),
        lambda centre: world.paste(
            world.copy(centre - RADIUS, centre + RADIUS), np.add(centre, (13, 57, -31)), turned=1
        ),
        lambda centre: (world.fill(Sphere(centre, RADIUS), 0), world.commit()),
    ):
        times = [1e3 * seconds(lambda centre=centre, edit=edit: edit(centre)) for centre in centres]
        shapes.append(f"{np.median(times):.2f}, {max(times):.2f}")
    return single, shapes


def check(rom: Rom, ground: NDArray[np.int64], operations: int) -> str:
    """Run random operations, and compare what they leave with a dictionary of voxels."""
    rng = np.random.default_rng(1)
    world, edited = World(rom), {}
    history: list[dict[tuple[int, ...], int]] = []
    for number in range(1, operations + 1):
        if history and rng.random() < 0.1:
            world.undo()
            edited |= history.pop()
        else:
            middle = ground[rng.integers(len(ground))]
            points = np.clip(middle + rng.integers(-6, 7, (rng.integers(1, 9), 3)), 0, world.size - 1)
            ids = rng.integers(0, 4, len(points))
            before = world.material_at(points)
            steps = world.steps[0]
            world.set(points, ids)
            keys = list(map(tuple, points.tolist()))
            if world.steps[0] > steps or steps == 100:
                changed = dict(zip(keys, before.tolist(), strict=True))
                if any(changed[key] != new for key, new in dict(zip(keys, ids.tolist(), strict=True)).items()):
                    history = [*history, changed][-100:]
            edited |= dict(zip(keys, ids.tolist(), strict=True))
        if number % 1000 == 0:
            world.native.check()
            found = world.material_at(np.array(list(edited)))
            assert found.tolist() == list(edited.values()), number
    words = world.rom().octree.words
    points, ids = octree.to_points(rom.octree, limit=1 << 34)
    points = np.concatenate([np.array(list(edited)), points])
    ids = np.concatenate([np.array(list(edited.values())), ids])
    _, first = np.unique(octree.morton.morton(points.astype(np.int64)), return_index=True)
    first = first[ids[first] != 0]
    built = octree.from_points(points[first], ids[first], depth=world.depth)
    assert np.array_equal(words, built.words)
    return (
        f"{operations:,} random operations on the terrain, of which one in ten undoes the one before: the voxels are "
        "those of a dictionary after each 1,000, with all counts of references exact; at the end, the "
        f"{len(words):,} words are those of a build.\n"
    )


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--edits", type=int, default=20_000)
    parser.add_argument("--operations", type=int, default=100_000)
    options = parser.parse_args()
    singles, shapes, checked = [], [], ""
    for name, rom, ground in scenes():
        single, shape = measure(name, rom, ground, options.edits)
        singles.append(single)
        shapes.append(shape)
        checked = checked or check(rom, ground, options.operations)
    heads = ("scene", "words", "load", "edits per second", "with a patch each", "blocks per patch", "garbage", "pick")
    page = (
        f"# Edits\n\n{options.edits:,} single voxels of the surface are dug from Python, one per call, on one thread "
        f"({machine()}; times are those of the processor). Garbage: blocks that the current octree does not use, "
        "beside those that it uses, when each edit was sent as a patch and the root before it was released. Pick: from "
        "Python, and its C++ alone. `rom`: the memory of the result. Rebuild: `from_points` of all its voxels.\n\n"
        f"{table((*heads, 'rom', 'rebuild'), singles, 1)}\n"
        f"Shapes at {SHAPES} places of the surface, median and worst, ms. Spheres have a radius of {RADIUS} voxels, "
        f"those that paint of {2 * RADIUS}; the copy has {2 * RADIUS} voxels per side and is turned.\n\n"
        f"{table(('scene', 'dig', 'paint', 'build', 'copy and paste', 'dig with a patch'), shapes, 1)}\n{checked}"
    )
    publish("edit.md", page, write=options.write)


if __name__ == "__main__":
    main()
