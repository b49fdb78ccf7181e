"""Benchmark of the demo: seconds per stage, clocks of the hardware, hardware simulated against its model.

Usage: ``python bench/demo.py [--depth N] [--size WxH] [--write]``. ``--write`` puts the table into
``bench/results/demo.md`` as well. Each time is the least of three.
"""

from __future__ import annotations

from report import ROOT, frame_size, machine, options_of, publish, table

import voxrt

SCENE = ROOT / "examples" / "courtyard.glb"
REPEATS = 3


def measure(depth: int, size: tuple[int, int]) -> list[tuple[str, str]]:
    builds = [voxrt.build(SCENE, depth=depth) for _ in range(REPEATS)]
    rom = builds[0].rom
    rows = [
        ("scene", f"{SCENE.name}, depth {depth}, {size[0]}x{size[1]} pixels"),
        ("machine", machine()),
        ("solid voxels", f"{builds[0].solid_voxels:,}"),
        ("memory", f"{len(rom.octree.words):,} words in {rom.octree.blocks:,} blocks"),
    ]
    rows += [(stage, f"{min(build.seconds[stage] for build in builds) * 1e3:.1f} ms") for stage in builds[0].seconds]
    costs = {}
    for engine in ("rtl", "model"):
        frames = [voxrt.render(rom, size=size, engine=engine) for _ in range(REPEATS)]
        costs[engine] = min((frame.cost for frame in frames), key=lambda cost: cost.seconds)
        rows.append((f"render, {engine}", f"{costs[engine].seconds * 1e3:.1f} ms"))
    rtl, model = costs["rtl"], costs["model"]
    return [
        *rows,
        ("model against simulated hardware", f"{rtl.seconds / model.seconds:.0f} times as fast"),
        ("cycles", f"{rtl.cycles:,}"),
        ("cycles per pixel", f"{rtl.cycles / rtl.rays:.3f}"),
        ("words per ray", f"{rtl.words_read / rtl.rays:.3f}"),
        ("words per clock", f"{rtl.words_read / rtl.cycles:.4f}"),
        ("clocks simulated a second", f"{rtl.cycles / rtl.seconds:,.0f}"),
        ("pixels that differ", f"{voxrt.check(rom, voxrt.aim_camera(rom, size), size).wrong_pixels}"),
    ]


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--depth", type=int, default=7)
    parser.add_argument("--size", type=frame_size, default="640x480")
    options = parser.parse_args()
    text = table(("what", "measured"), measure(options.depth, options.size))
    publish("demo.md", f"# The demo, measured by bench/demo.py\n\n{text}", write=options.write)


if __name__ == "__main__":
    main()
