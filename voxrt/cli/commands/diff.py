"""``voxrt diff``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import asdict

import voxrt
from voxrt.cli.inputs.source import Source, is_asset, read_source
from voxrt.cli.results.build_results import print_json
from voxrt.cli.results.memory_results import DiffResult
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import summarize

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.options.memory_commands import DiffCommand


def run(options: DiffCommand) -> None:
    """Compare the voxels of two memories and print where they differ. The order of their words does not matter."""
    first, second, depth = options.first, options.second, options.depth
    if second is None:
        blob = read_source(first, depth, frames=True).blob
        if blob.animation is None:
            raise UsageError(f"{first} is no animation: name a second memory to compare it with")
        one = options.frame or 0
        other = (one + 1) % len(blob.animation.frames) if options.to_frame is None else options.to_frame
        roms, labels = [blob.frame(one), blob.frame(other)], (f"frame {one}", f"frame {other}")
    else:
        sources: dict[Path, Source] = {}
        for path in sorted((first, second), key=is_asset):  # memories first: they know their depth
            known = depth if depth is not None or not sources else next(iter(sources.values())).rom.octree.depth
            sources[path] = read_source(path, known if is_asset(path) else depth, frames=True)
        roms = [sources[first].blob.frame(options.frame or 0), sources[second].blob.frame(options.to_frame or 0)]
        labels = first.name, second.name
    depths = [rom.octree.depth for rom in roms]
    if depths[0] != depths[1]:
        raise UsageError(f"{first} has depth {depths[0]} and {second} {depths[1]}: only equal depths can be compared")
    found = voxrt.diff(roms[0].octree, roms[1].octree)
    regions = voxrt.differing_regions(roms[0].octree, roms[1].octree)
    if options.reporting.json:
        print_json(DiffResult(found.voxels, **asdict(found), regions=regions))
        return
    rows = [
        ("differ", f"{found.voxels:,} voxels"),
        ("appeared", f"{found.appeared:,}"),
        ("vanished", f"{found.vanished:,}"),
        ("recoloured", f"{found.recoloured:,}"),
        *(("region", _described(region)) for region in regions),
    ]
    summarize(f"{labels[0]} to {labels[1]}:", rows if found.voxels else rows[:1], answer=True)


def _described(region: voxrt.Region) -> str:
    counts = (("appeared", region.appeared), ("vanished", region.vanished), ("recoloured", region.recoloured))
    kinds = ", ".join(f"{count:,} {kind}" for kind, count in counts if count)
    low, high = (",".join(map(str, corner)) for corner in region.bounds)
    return f"{low} up to {high}: {kinds}"
