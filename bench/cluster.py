"""What a cluster costs and what it would gain: ``python bench/cluster.py ASSET --depth 12``.

First the asset is built in one process, and by two workers with one thread each on this machine: processor seconds,
of the whole command and its children. Then each tile is made alone, and the times and sizes that were measured are
scheduled on paper for more workers: tiles in order to whoever is free, then the squares that workers join, then the
last join and the writing on one machine.
"""

from __future__ import annotations

import argparse
import heapq
import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import NamedTuple

import voxrt
from voxrt import octree
from voxrt.blockwise import block_voxelizer, plan_build
from voxrt.cluster import cluster_side

FAN_IN = 4
MOST_PIECES = 16


class Made(NamedTuple):
    """A tile or a join of tiles: its octree, and the processor seconds that it took."""

    tree: octree.Octree
    seconds: float


def main() -> None:
    """Measure, and print the plan."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("asset", type=Path)
    parser.add_argument("--depth", type=int, default=12)
    parser.add_argument("--fill", default="surface", choices=("surface", "auto", "solid"))
    parser.add_argument("--workers", type=int, nargs="*", default=[2, 8, 64])
    parser.add_argument("--plan-only", action="store_true", help="do not build on a cluster of two workers")
    options = parser.parse_args()
    if not options.plan_only:
        compare(options.asset, options.depth, options.fill)
    plan(options.asset, options.depth, options.fill, options.workers)


def compare(asset: Path, depth: int, fill: str) -> None:
    """Build alone and on two workers, and print what the cluster costs."""
    with TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "voxrt", "build", str(asset), "--depth", str(depth), "--fill", fill, "-q"]
        alone = processor_seconds([*command, "--memory", "2G", "-o", f"{folder}/alone.bin"])
        two = processor_seconds([*command, "--workers", "2", "-o", f"{folder}/two.bin"])
        same = Path(folder, "alone.bin").read_bytes() == Path(folder, "two.bin").read_bytes()
        started = processor_seconds([sys.executable, "-c", START], folder)
    print(f"alone                    {alone:8.1f} s of processor time")
    print(f"two workers              {two:8.1f} s, {100 * (two / alone - 1):+.0f} %, the same bytes: {same}")
    print(f"of it to start a cluster {started:8.1f} s; without, {100 * ((two - started) / alone - 1):+.0f} %")


START = """
import voxrt, voxrt.pipeline
from voxrt.cluster import connected
if __name__ == "__main__":
    with connected(None, 2) as client:
        client.run(__import__, "voxrt.cluster_tasks")
"""


def processor_seconds(command: list[str], folder: str | None = None) -> float:
    """Run a command; returns its processor seconds, with those of its children."""
    if command[1] == "-c":  # processes that are spawned import the script
        script = Path(folder or ".") / "start.py"
        script.write_text(command[2])
        command = [command[0], str(script)]
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"{command} failed")
    return usage.ru_utime + usage.ru_stime


def plan(asset: Path, depth: int, fill: str, workers: list[int]) -> None:
    """Make each tile alone, and print how long so many workers would take."""
    build_options = voxrt.BuildOptions(depth=depth, fill=fill, threads=1)
    scene = voxrt.load(asset)
    grid = voxrt.fit_grid(scene, depth=depth)
    scene = voxrt.voxelize.assign_colours(scene, grid)
    begun = process_time()
    voxelizer = block_voxelizer(scene, grid, build_options)
    blocks = voxelizer.blocks(cluster_side(grid, plan_build(scene, grid, build_options, on_disk=True)))
    analysis = process_time() - begun
    tiles: dict[tuple[int, int], Made] = {}
    for block in blocks:
        begun = process_time()
        tree = octree.build(voxelizer.voxelize(block)[0], threads=1)
        tiles[block.x // block.side, block.y // block.side] = Made(tree, process_time() - begun)
    levels = [tiles]
    while len(levels[-1]) > MOST_PIECES:
        groups: dict[tuple[int, int], list[Made]] = {}
        for (x, y), piece in levels[-1].items():
            groups.setdefault((x // FAN_IN, y // FAN_IN), []).append(piece)
        levels.append({place: joined(depth, parts) for place, parts in groups.items()})
    last = joined(depth, list(levels[-1].values()))
    size = sum(one.tree.words.nbytes for one in tiles.values())
    largest = max(one.seconds for one in tiles.values())
    total = sum(one.seconds for one in tiles.values())
    print(f"analysis on each worker  {analysis:8.2f} s")
    print(f"{len(tiles):4d} tiles              {total:8.2f} s, at most {largest:.2f} s; {size / 1e6:.0f} MB")
    for level in levels[1:]:
        joins = sum(one.tree.words.nbytes for one in level.values()) / 1e6
        seconds = [one.seconds for one in level.values()]
        print(f"{len(level):4d} joins             {sum(seconds):8.2f} s, at most {max(seconds):.2f} s; {joins:.0f} MB")
    print(f"the last join            {last.seconds:8.2f} s; {last.tree.words.nbytes / 1e6:.0f} MB")
    for count in workers:
        path = analysis + last.seconds
        path += sum(scheduled([one.seconds for one in level.values()], count) for level in levels)
        gain = (analysis + total + last.seconds) / path
        print(f"{count:4d} workers             {path:8.2f} s, {gain:.1f} times as fast as one")


def joined(depth: int, parts: list[Made]) -> Made:
    """Join octrees."""
    begun = process_time()
    whole = octree.Assembly(depth)
    for part in parts:
        whole.add(part.tree)
    return Made(whole.octree(), process_time() - begun)


def scheduled(seconds: list[float], workers: int) -> float:
    """Return when the last of some tasks ends that go in order to whoever is free."""
    free = [0.0] * workers
    for one in seconds:
        heapq.heappush(free, heapq.heappop(free) + one)
    return max(free)


if __name__ == "__main__":
    main()
