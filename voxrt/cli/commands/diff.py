"""``voxrt diff``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import voxrt
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.results.memory_results import DiffResult, RegionEntry
from voxrt.cli.terminal.messages import summarize
from voxrt.cli.results.build_results import print_json
from voxrt.cli.inputs.source import Source, is_asset, read_source

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.options.memory_commands import DiffCommand


def run(options: DiffCommand) -> None:
    """Compare the voxels of two memories and print where they differ. The order of their words does not matter."""
    if options.second is None:
        blob = read_source(options.first, options.depth, frames=True).blob
        if blob.animation is None:
            raise UsageError(f"{options.first} is no animation: name a second memory to compare it with")
        one = options.frame or 0
        other = (one + 1) % len(blob.animation.frames) if options.to_frame is None else options.to_frame
        roms, labels = [blob.frame(one), blob.frame(other)], (f"frame {one}", f"frame {other}")
    else:
        sources: dict[Path, Source] = {}
        for path in sorted((options.first, options.second), key=is_asset):  # memories first: they know their depth
            known = options.depth if options.depth is not None or not sources else next(iter(sources.values())).rom.octree.depth
            sources[path] = read_source(path, known if is_asset(path) else options.depth, frames=True)
        roms = [sources[options.first].blob.frame(options.frame or 0), sources[options.second].blob.frame(options.to_frame or 0)]
        labels = options.first.name, options.second.name
    depths = [rom.octree.depth for rom in roms]
    if depths[0] != depths[1]:
        raise UsageError(f"{options.first} has depth {depths[0]} and {options.second} {depths[1]}: only equal depths can be compared")
    found = voxrt.diff(roms[0].octree, roms[1].octree)
    regions = voxrt.differing_regions(roms[0].octree, roms[1].octree)
    if options.reporting.json:
        entries = [RegionEntry(part.bounds, part.appeared, part.vanished, part.recoloured) for part in regions]
        print_json(
            DiffResult(found.voxels, found.appeared, found.vanished, found.recoloured, found.bounds, entries),
        )
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
