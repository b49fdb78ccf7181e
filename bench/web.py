"""Time the WebAssembly module beside the native one: `make site`, then python bench/web.py.

Voxelizing with the octree, and frames of the exact model; one thread each, in Node, the best of some repeats, in turns.
Times are those of the processor, which other work on the machine hardly changes. bench/web_page.py times the page.
"""

from __future__ import annotations

import json
import subprocess
import sys
from time import process_time
from typing import TYPE_CHECKING

from report import ROOT

import voxrt
from voxrt import octree
from voxrt.sim import frame_scene, render
from voxrt.voxelize import fit_grid, load, voxelize

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

SITE = ROOT / "build" / "site"
CASES = [("courtyard.glb", 7), ("courtyard.glb", 9), ("planet.glb", 8), ("planet.glb", 10)]
SIZE = (640, 480)
REPEATS = 9
ROUNDS = 2

SCRIPT = """
import { readFile } from "node:fs/promises";
globalThis.self = globalThis;
const { site, file, depth, camera, size, repeats } = JSON.parse(process.argv[1]);
const { Voxrt } = await import(`file://${site}/voxrt/voxrt.js`);
const { readFiles } = await import(`file://${site}/files.js`);
const voxrt = await Voxrt.load(await readFile(`${site}/voxrt/voxrt.wasm`));
const given = { name: file.split("/").at(-1), bytes: new Uint8Array(await readFile(file)) };
const { scene } = await readFiles([given], voxrt);
const best = (work) => Math.min(...Array.from({ length: repeats }, () => {
  const start = process.cpuUsage();
  work();
  const { user, system } = process.cpuUsage(start);
  return (user + system) / 1e6;
}));
let built;
const build = best(() => { built = voxrt.voxelize(scene, { depth }); });
voxrt.setMemory(built.words, depth);
voxrt.shade({ materials: built.materials.map((material) => material.colour) });
const frame = best(() => voxrt.render(camera, size));
console.log(JSON.stringify({ build, frame }));
"""


def best(work: Callable[[], object]) -> float:
    seconds = []
    for _ in range(REPEATS):
        start = process_time()
        work()
        seconds.append(process_time() - start)
    return min(seconds)


def native(path: Path, depth: int) -> tuple[voxrt.Rom, float, float]:
    """Return the memory, and the seconds of building it and of a frame."""
    scene = load(path)
    grid = fit_grid(scene, depth=depth)
    build = best(lambda: octree.build(voxelize(scene, grid, fill="auto", threads=1).voxels, threads=1))
    rom = voxrt.build(path, depth=depth).rom
    camera = frame_scene(rom, SIZE)
    return rom, build, best(lambda: render(rom, camera, SIZE, engine="model", threads=1))


def in_node(path: Path, depth: int, rom: voxrt.Rom) -> tuple[float, float]:
    """Return the seconds of the same in WebAssembly."""
    camera = frame_scene(rom, SIZE)
    job = {
        "site": str(SITE),
        "file": str(path),
        "depth": depth,
        "size": SIZE,
        "repeats": REPEATS,
        "camera": {name: getattr(camera, name) for name in ("position", "look", "right", "up")},
    }
    command = ["node", "--input-type=module", "-e", SCRIPT, json.dumps(job)]
    found = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    return found["build"], found["frame"]


def main() -> None:
    if not SITE.exists():
        sys.exit("build/site is not here: make site")
    print("| scene | build native | wasm | ratio | frame native | wasm | ratio |\n|---|---|---|---|---|---|---|")
    for name, depth in CASES:
        path = ROOT / "examples" / name
        rows = []
        for _ in range(ROUNDS):
            rom, build, frame = native(path, depth)
            rows.append((build, *in_node(path, depth, rom), frame))
        build, wasm_build, wasm_frame, frame = (min(column) for column in zip(*rows, strict=True))
        print(
            f"| {path.stem} {2**depth}³ | {build * 1e3:.1f} ms | {wasm_build * 1e3:.1f} ms | {wasm_build / build:.2f} "
            f"| {frame * 1e3:.1f} ms | {wasm_frame * 1e3:.1f} ms | {wasm_frame / frame:.2f} |"
        )


if __name__ == "__main__":
    main()
