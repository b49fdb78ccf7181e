"""What several processes cost and what a cluster would gain: ``python bench/cluster.py ASSET:DEPTH ... [--write]``.

First each asset is built by one process, and by two workers with one thread each on this machine: processor seconds
of the whole command with its children, the least of several rounds that take turns. Then each tile is made alone, and
the times and sizes that were measured are scheduled on paper for more workers: tiles in order to whoever is free, then
the squares that workers join, then the last join on one machine.
"""

from __future__ import annotations

import filecmp
import heapq
import os
import platform
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import NamedTuple

from report import options_of, write_page

import voxrt
from voxrt import octree
from voxrt.plans.by_workers import JOINERS, MOST_PIECES, cluster_side, squares
from voxrt.plans.plan import plan_build
from voxrt.plans.tile_tasks import block_voxelizer

MEMORY = "2G"


class Made(NamedTuple):
    """A tile or a join of tiles: its octree, and the processor seconds that it took."""

    tree: octree.Octree
    seconds: float


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("assets", nargs="+", metavar="ASSET:DEPTH")
    parser.add_argument("--fill", default="surface", choices=("surface", "auto", "solid"))
    parser.add_argument("--workers", type=int, nargs="*", default=[2, 8, 64], help="of the plan")
    parser.add_argument("--rounds", type=int, default=2)
    options = parser.parse_args()
    runs = [(Path(path), int(depth)) for path, _, depth in (one.rpartition(":") for one in options.assets)]
    costs = ["| asset | side | one process, s | two workers, s | more |", "|---|--:|--:|--:|--:|"]
    print("\n".join(costs))
    for asset, depth in runs:
        costs.append(compare(asset, depth, options.fill, options.rounds))
        print(costs[-1], flush=True)
    plans = [
        "| asset | side | workers | tiles | s | largest, s | MB | joins on workers, s | last join, s | all, s | gain |",
        "|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|",
    ]
    print("\n" + "\n".join(plans))
    for asset, depth in runs:
        for workers in options.workers:
            plans.append(plan(asset, depth, options.fill, workers))
            print(plans[-1], flush=True)
    if options.write:
        about = ABOUT.format(
            machine=platform.machine(), python=platform.python_version(), memory=MEMORY, rounds=options.rounds
        )
        write_page("cluster.md", "\n".join([about, *costs, PLANS, *plans]) + "\n")


ABOUT = """# Several processes

Surfaces (`--fill surface`) of scans, by `bench/cluster.py`; {machine}, Python {python}, `--memory {memory}`; processor
seconds of the whole command with its children, the least of {rounds} rounds. *more*: what two workers on one machine
take beyond one process; their results have the same bytes.
"""

PLANS = """
Each tile made alone, and the processor seconds scheduled on paper. *all*: the longest path of analysis, tiles, joins on
workers, and the last join; loading and writing are left out. *gain*: that of one worker, who joins nothing, over it.
"""


def compare(asset: Path, depth: int, fill: str, rounds: int) -> str:
    """Build alone and by two workers; returns a row of what that costs."""
    with TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "voxrt", "build", str(asset), "--depth", str(depth), "--fill", fill, "-q"]
        command += ["--memory", MEMORY]
        alone, two = [], []
        for _ in range(rounds):
            alone.append(processor_seconds([*command, "-o", f"{folder}/alone.bin"]))
            two.append(processor_seconds([*command, "--workers", "2", "-o", f"{folder}/two.bin"]))
        if not filecmp.cmp(f"{folder}/alone.bin", f"{folder}/two.bin", shallow=False):
            raise SystemExit(f"{asset}: two workers gave other bytes")
    more = 100 * (min(two) / min(alone) - 1)
    return f"| {asset.stem} | {1 << depth:,} | {min(alone):.2f} | {min(two):.2f} | {more:+.0f} % |"


def processor_seconds(command: list[str]) -> float:
    """Run a command; returns its processor seconds, with those of its children."""
    process = subprocess.Popen(command)
    _, status, usage = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"{command} failed")
    return usage.ru_utime + usage.ru_stime


def plan(asset: Path, depth: int, fill: str, workers: int) -> str:
    """Make each tile alone; returns a row of how long so many workers would take."""
    options = voxrt.BuildOptions(depth=depth, fill=fill, threads=1)
    scene = voxrt.load(asset)
    grid = voxrt.fit_grid(scene, depth=depth)
    scene = voxrt.voxelize.assign_colours(scene, grid)
    begun = process_time()
    voxelizer = block_voxelizer(scene, grid, options)
    voxelizer.prepare()
    analysis = process_time() - begun
    blocks = voxelizer.blocks(cluster_side(voxelizer, plan_build(scene, grid, options, on_disk=True), workers))
    tiles: dict[tuple[int, int], Made] = {}
    for block in blocks:
        begun = process_time()
        tree = octree.build(voxelizer.voxelize(block)[0], threads=1)
        tiles[block.x // block.side, block.y // block.side] = Made(tree, process_time() - begun)
    levels = [tiles]
    while workers >= JOINERS and len(levels[-1]) > MOST_PIECES:
        levels.append({place: joined(depth, parts) for place, parts in squares(levels[-1]).items()})
    last = joined(depth, list(levels[-1].values())).seconds
    size = sum(one.tree.words.nbytes for one in tiles.values()) / 1e6
    total, largest = sum(one.seconds for one in tiles.values()), max(one.seconds for one in tiles.values())
    joins = sum(one.seconds for level in levels[1:] for one in level.values())
    path = analysis + last + sum(scheduled([one.seconds for one in level.values()], workers) for level in levels)
    return (
        f"| {asset.stem} | {1 << depth:,} | {workers} | {len(tiles)} | {total:.2f} | {largest:.2f} | {size:.0f} | "
        f"{joins:.2f} | {last:.2f} | {path:.2f} | {(analysis + total) / path:.1f} |"
    )


def joined(depth: int, parts: list[Made]) -> Made:
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
