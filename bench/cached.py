"""Benchmark of the octree memory behind caches: real scenes, traced by the verilated core, against the exact model.

Usage: ``python bench/cached.py [--config NAME] [--latency N] [--interval N] [--only TEXT] [--write]``. Scenes are
scans and textured models from the folder of assets (``VOXRT_ASSETS``); their octrees are kept in ``build/cached``.
Every frame is 640x480 and every pixel is compared. ``--write`` puts the table into ``bench/results/cached.md`` too.
"""

from __future__ import annotations

import pickle
import sys
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from report import ASSETS, ROOT, options_of, write_page

import voxrt
from voxrt.sim import Dram

if TYPE_CHECKING:
    from collections.abc import Iterator

    from voxrt import Camera, Octree, Rom

KEPT = ROOT / "build" / "cached"
SIZE = (640, 480)


class Row(NamedTuple):
    """A scene from a kind of place, and what a model of the caches' cycles has found there."""

    scene: str
    asset: str
    depth: int
    view: str
    modelled: str


SKULL = "obj/odedstein-meshes/skull/skull.obj"
GARGO = "ply/USD-Fileformat-plugins/gargo.ply"
GARDEN = "gltf/3d-demo-data/scene.glb"
TRUCK = "gltf/trimesh/CesiumMilkTruck.glb"
# Cycles per pixel: of a memory that always answers, then behind caches. The model drew other close and grazing places.
ROWS = [
    Row("truck", TRUCK, 12, "default", "2.05, 2.30"),
    Row("truck", TRUCK, 12, "close", "2.13, 2.15"),
    Row("skull", SKULL, 11, "default", "1.61, 2.65"),
    Row("skull", SKULL, 11, "close", "2.49, 2.51"),
    Row("skull", SKULL, 11, "graze", "2.26, 2.39"),
    Row("garden", GARDEN, 11, "default", "1.84, 2.69"),
    Row("garden", GARDEN, 11, "graze", "4.51, 4.58"),
    Row("gargo", GARGO, 10, "default", "1.56, 2.63"),
    Row("gargo", GARGO, 10, "close", "2.25, 2.27"),
    Row("gargo", GARGO, 10, "graze", "2.29, 2.38"),
]
HEADS = ("scene", "depth", "M words", "view", "words per ray", "cycles per pixel", "requests per word", "L1 hits %")
HEADS += ("L2 hits %", "lines per pixel", "bytes per pixel", "modelled", "wrong pixels")


def rom_of(name: str, asset: str, depth: int) -> Rom:
    """Give the memory of an asset; its words are kept, as it takes a minute to make them."""
    file = KEPT / f"{name}-{depth}.pickle"
    if file.exists():
        return pickle.loads(file.read_bytes())
    rom = voxrt.build(ASSETS / asset, depth=depth).rom
    KEPT.mkdir(parents=True, exist_ok=True)
    file.write_bytes(pickle.dumps(rom))
    return rom


def camera_of(rom: Rom, view: str) -> Camera:
    """Give a camera: the default one; 0.1 world sides before a surface; or 0.02 above it, looking along it.

    Of 400 places that are drawn at random, the first with 90 % of its rays on a surface, or else the best.
    """
    if view == "default":
        return voxrt.sim.frame_scene(rom, SIZE)
    side = 1 << rom.octree.depth
    best = None
    for position, look in _places(rom.octree, side, 0.1 if view == "close" else 0.02, along=view == "graze"):
        camera = voxrt.aim_camera(rom, (32, 24), position=position, look=look)
        frame = voxrt.render(rom, camera, size=(32, 24), engine="model")
        covered = np.count_nonzero(frame.material) / frame.material.size
        if best is None or covered > best[0]:
            best = covered, position, look
        if covered >= 0.9:
            break
    assert best is not None
    return voxrt.aim_camera(rom, SIZE, position=best[1], look=best[2])


def _places(octree: Octree, side: int, distance: float, *, along: bool) -> Iterator[tuple[tuple[int, ...], ...]]:
    random = np.random.default_rng(1)
    found = 0
    while found < 400:
        origin = side / 2 + side * 1.5 * _direction(random)
        hits = voxrt.cast_rays(octree, np.rint(origin), np.rint(1000 * (random.uniform(0, side, 3) - origin) / side))
        if not hits.hit[0]:
            continue
        found += 1
        axis, voxel = int(hits.face[0]), hits.voxel[0]
        outwards = np.zeros(3)
        outwards[axis] = 1 if origin[axis] > voxel[axis] else -1
        position = voxel + 0.5 + distance * side * outwards
        look = _direction(random)
        look -= outwards * (look @ outwards)
        look = look / np.linalg.norm(look) - 0.2 * outwards if along else 0.3 * look - outwards
        yield tuple(int(x) for x in np.rint(16 * position)), tuple(int(x) for x in np.rint(20000 * look))


def _direction(random: np.random.Generator) -> np.ndarray:
    direction = random.normal(size=3)
    return direction / np.linalg.norm(direction)


def measure(row: Row, config: str, dram: Dram) -> str:
    rom = rom_of(row.scene, row.asset, row.depth)
    camera = camera_of(rom, row.view)
    checked = voxrt.check(rom, camera, SIZE, config=config, dram=dram)
    cost = checked.rtl.cost
    assert cost.cycles is not None
    assert cost.words_read is not None
    assert cost.cache is not None
    cache, rays = cost.cache, cost.rays
    return (
        f"| {row.scene} | {row.depth} | {len(rom.octree.words) / 1e6:.1f} | {row.view} "
        f"| {cost.words_read / rays:.1f} | {cost.cycles / rays:.2f} | {cache.word_requests / cost.words_read:.2f} "
        f"| {100 * cache.l1_hits:.1f} | {100 * cache.l2_hits:.1f} | {cache.lines_read / rays:.3f} "
        f"| {cache.bytes_read / rays:.1f} | {row.modelled} | {checked.wrong_pixels} |"
    )


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--config", default="cached16")
    parser.add_argument("--latency", type=int, default=50)
    parser.add_argument("--interval", type=int, default=3)
    parser.add_argument("--only", default="", help="scenes whose name, depth and view contain this")
    options = parser.parse_args()
    dram = Dram(latency=options.latency, interval=options.interval)
    only = f" --only '{options.only}'" if options.only else ""
    lines = [
        f"`python bench/cached.py --write{only}`: {options.config}, {SIZE[0]}x{SIZE[1]}, latency {dram.latency},",
        f"a line per {dram.interval} clocks. The caches are empty at the start of each frame. Modelled: cycles per",
        "pixel of a cycle model of such caches, with a memory that always answers and behind the caches; its cameras",
        "were its own.",
        "",
        f"| {' | '.join(HEADS)} |",
        "|" + "---|" * len(HEADS),
    ]
    print("\n".join(lines), flush=True)
    for row in ROWS:
        if options.only in f"{row.scene} {row.depth} {row.view}":
            lines.append(measure(row, options.config, dram))
            print(lines[-1], flush=True)
    if options.write:
        write_page("cached.md", "# The octree memory behind caches\n\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    sys.exit(main())
