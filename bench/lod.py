"""Benchmark of the level of detail: how close its pictures are to supersampled ones, and what far views cost.

Usage: ``python bench/lod.py [--only pictures|cost] [--write]``. Assets come from the folder ``VOXRT_ASSETS``.
Pictures, 320x240 at depth 10, are compared with pictures of 16 samples per pixel without level of detail: from the
default camera, and from cameras farther away. The cost, 640x480, is that of the verilated core with a memory of latency
50 and interval 3; every pixel is compared with the exact model. Rays stop at cells of several widths. ``--write`` puts
the tables into ``bench/results/lod.md``; those that were not asked for stay.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from report import RESULTS, publish, table

import voxrt
from voxrt.octree import with_means
from voxrt.sim.similarity import peak_signal_to_noise, structural_similarity

sys.path.insert(0, str(Path(__file__).resolve().parent))
from cached import ASSETS, GARDEN, GARGO, SKULL, TRUCK, rom_of

if TYPE_CHECKING:
    from voxrt import Camera, Rom

SIZE, FAR_SIZE, DEPTH = (640, 480), (320, 240), 10
PICTURE_CELLS = (0.5, 0.75, 1.0)
DISTANCES = {1: "the default camera", 2: "twice as far", 4: "four times as far"}
"""Where pictures are taken from: times the distance of the default camera."""
COST_CELLS = (0.0, 0.5, 1.0, 1.5, 2.0)
"""Widths of the widest cell that rays stop at, in pixels."""
PICTURES = {
    "skull": SKULL,
    "gargo": GARGO,
    "truck": TRUCK,
    "garden": GARDEN,
    "man": "usd/usd-wg-assets/test_assets/USDZ/CesiumMan/CesiumMan.usdz",
    "cake": "gltf/bevy/AlienCake/cakeBirthday.glb",
    "pirate": "gltf/meshoptimizer/pirate.glb",
    "pizza": "obj/kaolin/pizza.obj",
    "fox": "gltf/bevy/animated/Fox.glb",
    "amsterdam": "obj/kaolin/amsterdam.obj",
}
COSTS = (("skull", SKULL, 11), ("gargo", GARGO, 10), ("gargo", GARGO, 12))


def camera_from(rom: Rom, times: int) -> Camera:
    """Give the default camera, moved back along its look: so many times as far from the middle of the world."""
    camera = voxrt.aim_camera(rom, FAR_SIZE)
    position, look = np.array(camera.position), np.array(camera.look)
    middle = 16 * (1 << DEPTH) / 2
    moved = position - (times - 1) * np.linalg.norm(position - middle) * look / np.linalg.norm(look)
    place = tuple(int(x) for x in np.rint(moved))
    return voxrt.aim_camera(rom, FAR_SIZE, position=place, look=camera.look)


def pictures(times: int) -> tuple[str, str]:
    """Compare pictures with and without level of detail with those of 16 samples; give a title and a table."""
    heads = ("asset", "off: SSIM, dB", *(f"{cell:g}: SSIM, dB" for cell in PICTURE_CELLS))
    rows: list[tuple[str, ...]] = []
    better = dict.fromkeys(PICTURE_CELLS, 0)
    for name, asset in PICTURES.items():
        rom = with_means(rom_of(name, asset, DEPTH))
        camera = camera_from(rom, times)
        wanted = voxrt.render(rom, camera, size=FAR_SIZE, engine="model", samples=4).colour
        found = []
        for cell in (0.0, *PICTURE_CELLS):
            shown = voxrt.render(rom, camera, size=FAR_SIZE, engine="model", lod=cell).colour
            found.append((structural_similarity(wanted, shown), peak_signal_to_noise(wanted, shown)))
            if cell:
                better[cell] += found[-1][0] > found[0][0] and found[-1][1] > found[0][1]
        rows.append((name, *(f"{likeness:.4f}, {noise:.2f}" for likeness, noise in found)))
        print(*rows[-1], flush=True)
    rows.append(("both better", "", *map(str, better.values())))
    return f"Pictures from {DISTANCES[times]}", table(heads, rows, left=1)


def costs(config: str) -> tuple[str, str]:
    """Measure what far views cost the hardware; give a title and a table."""
    heads = ("scene", "words per ray", "cycles per pixel", "L1 hits %", "lines per pixel", "wrong pixels")
    rows = []
    for name, asset, depth in COSTS:
        rom = with_means(rom_of(name, asset, depth))
        camera = voxrt.aim_camera(rom, SIZE)
        for cell in COST_CELLS:
            checked = voxrt.check(rom, camera, SIZE, config=config, lod=cell)
            cost = checked.rtl.cost
            assert cost.words_read is not None
            assert cost.cycles is not None
            assert cost.cache is not None
            scene = f"{name} {depth}, {f'cells of {cell:g}' if cell else 'off'}"
            words, cycles = f"{cost.words_read / cost.rays:.2f}", f"{cost.cycles / cost.rays:.2f}"
            hits = f"{100 * (1 - cost.cache.line_requests / cost.words_read):.1f}"
            lines = f"{cost.cache.lines_read / cost.rays:.3f}"
            rows.append((scene, words, cycles, hits, lines, str(checked.wrong_pixels)))
            print(*rows[-1], flush=True)
    title = f"Far views of {SIZE[0]}x{SIZE[1]}, {config}, latency 50, interval 3"
    return title, table(heads, rows, left=1)


def written() -> dict[str, str]:
    """Give the texts of the tables in the written file, by title."""
    page = RESULTS / "lod.md"
    parts = page.read_text(encoding="utf-8").split("## ")[1:] if page.exists() else []
    return {part.split("\n")[0]: f"## {part.rstrip()}\n" for part in parts}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=("pictures", "cost"))
    parser.add_argument("--config", default="cached16")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    if not ASSETS.is_dir():
        sys.exit(f"there is no folder of assets at {ASSETS}; name one by VOXRT_ASSETS")
    tables = []
    if options.only != "cost":
        tables += [pictures(times) for times in DISTANCES]
    if options.only != "pictures":
        tables.append(costs(options.config))
    found = {title: f"## {title}\n\n{text}" for title, text in tables}
    if options.write and options.only:
        found = written() | found
    text = "# Level of detail\n\n`python bench/lod.py --write`. "
    text += "A number is the width in pixels of the widest cell that rays stop at.\n"
    text += f"Pictures have {FAR_SIZE[0]}x{FAR_SIZE[1]} pixels and depth {DEPTH}. "
    text += "They are compared with pictures of 16 samples per pixel.\n\n"
    text += "\n".join(found.values())
    publish("lod.md", text, write=options.write)


if __name__ == "__main__":
    main()
