"""Benchmark of the level of detail: how close its pictures are to supersampled ones, and what far views cost.

Usage: ``python bench/lod.py [--only pictures|cost | --write]``. Assets come from the folder ``VOXRT_ASSETS``.
Pictures, 320x240 from the default camera at depth 10, are compared with pictures of 16 samples per pixel without level
of detail. The cost, 640x480, is that of the verilated core with a memory of latency 50 and interval 3; every pixel is
compared with the exact model. Rays stop at cells of several widths. ``--write`` puts the tables into
``bench/results/lod.md``.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import NamedTuple

import voxrt
from voxrt.octree import with_means
from voxrt.sim.similarity import peak_signal_to_noise, structural_similarity

sys.path.insert(0, str(Path(__file__).resolve().parent))
from cached import ASSETS, GARDEN, GARGO, ROOT, SKULL, TRUCK, rom_of

RESULTS = ROOT / "bench" / "results" / "lod.md"
SIZE, FAR_SIZE, DEPTH = (640, 480), (320, 240), 10
PICTURE_CELLS = (0.5, 0.75, 1.0)
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


class Table(NamedTuple):
    """A title and rows of a table, the first one its heads."""

    title: str
    rows: list[tuple[str, ...]]

    def text(self) -> str:
        """Give it in Markdown."""
        heads, *rows = self.rows
        lines = ["| " + " | ".join(row) + " |" for row in (heads, *rows)]
        lines.insert(1, "|---|" + "--:|" * (len(heads) - 1))
        return f"## {self.title}\n\n" + "\n".join(lines) + "\n"


def pictures() -> Table:
    """Compare pictures with and without level of detail with those of 16 samples."""
    heads = ["asset", "off: SSIM, dB", *(f"{cell:g}: SSIM, dB" for cell in PICTURE_CELLS)]
    rows = [tuple(heads)]
    better = dict.fromkeys(PICTURE_CELLS, 0)
    for name, asset in PICTURES.items():
        rom = with_means(rom_of(name, asset, DEPTH))
        wanted = voxrt.render(rom, size=FAR_SIZE, engine="model", samples=4).colour
        found = []
        for cell in (0.0, *PICTURE_CELLS):
            shown = voxrt.render(rom, size=FAR_SIZE, engine="model", lod=cell).colour
            found.append((structural_similarity(wanted, shown), peak_signal_to_noise(wanted, shown)))
            if cell:
                better[cell] += found[-1][0] > found[0][0] and found[-1][1] > found[0][1]
        rows.append((name, *(f"{likeness:.4f}, {noise:.2f}" for likeness, noise in found)))
        print(*rows[-1], flush=True)
    rows.append(("both better", "", *map(str, better.values())))
    return Table(f"Pictures of {FAR_SIZE[0]}x{FAR_SIZE[1]}, depth {DEPTH}, against 16 samples per pixel", rows)


def costs(config: str) -> Table:
    """Measure what far views cost the hardware."""
    heads = ("scene", "words per ray", "cycles per pixel", "L1 hits %", "lines per pixel", "wrong pixels")
    rows = [heads]
    for name, asset, depth in COSTS:
        rom = with_means(rom_of(name, asset, depth))
        camera = voxrt.aim_camera(rom, SIZE)
        for cell in COST_CELLS:
            checked = voxrt.check(rom, camera, SIZE, config=config, lod=cell)
            cost = checked.rtl.cost
            assert cost.words_read is not None
            assert cost.cycles is not None
            assert cost.cache is not None
            rows.append(
                (
                    f"{name} {depth}, {f'cells of {cell:g}' if cell else 'off'}",
                    f"{cost.words_read / cost.rays:.2f}",
                    f"{cost.cycles / cost.rays:.2f}",
                    f"{100 * (1 - cost.cache.line_requests / cost.words_read):.1f}",
                    f"{cost.cache.lines_read / cost.rays:.3f}",
                    str(checked.wrong_pixels),
                )
            )
            print(*rows[-1], flush=True)
    return Table(f"Far views of {SIZE[0]}x{SIZE[1]}, {config}, latency 50, interval 3", rows)


def main() -> None:
    """Run it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=("pictures", "cost"))
    parser.add_argument("--config", default="cached16")
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    if asked.only and asked.write:
        parser.error("--write puts both tables into the file: leave --only out")
    if not ASSETS.is_dir():
        sys.exit(f"there is no folder of assets at {ASSETS}; name one by VOXRT_ASSETS")
    tables = []
    if asked.only != "cost":
        tables.append(pictures())
    if asked.only != "pictures":
        tables.append(costs(asked.config))
    text = "# Level of detail\n\n`python bench/lod.py --write`. "
    text += "A number is the width in pixels of the widest cell that rays stop at.\n\n"
    text += "\n".join(table.text() for table in tables)
    print(text)
    if asked.write:
        RESULTS.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
