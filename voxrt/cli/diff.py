"""``voxrt diff``."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import Annotated

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Reporting, UsageError
from voxrt.cli.memory_results import DiffResult, RegionEntry
from voxrt.cli.messages import summarize, warn
from voxrt.cli.results import print_json

SHOWN = 5
"""The most regions that are printed."""


def diff(
    first: Annotated[Path, Parameter(metavar="FIRST")],
    second: Annotated[Path, Parameter(metavar="SECOND")],
    /,
    *,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Compare the voxels of two memories and print where they differ. The order of their words does not matter.

    Parameters
    ----------
    first
        A memory in any format.
    second
        Another, of the same depth.
    reporting
        How results are printed.
    """
    roms = []
    for path in (first, second):
        blob, warnings = voxrt.read_any(path)
        warn(warnings)
        roms.append(blob.rom)
    depths = [rom.octree.depth for rom in roms]
    if depths[0] != depths[1]:
        raise UsageError(f"{first} has depth {depths[0]} and {second} {depths[1]}: only equal depths can be compared")
    found = voxrt.diff(roms[0].octree, roms[1].octree)
    regions = voxrt.differing_regions(roms[0].octree, roms[1].octree)
    if reporting.json:
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
        *(("region", _described(region)) for region in regions[:SHOWN]),
    ]
    if len(regions) > SHOWN:
        rest = sum(region.voxels for region in regions[SHOWN:])
        rows.append(("regions", f"{len(regions):,} in all; {rest:,} voxels in those not shown (--json tells all)"))
    summarize(f"{first.name} to {second.name}:", rows if found.voxels else rows[:1])


def _described(region: voxrt.Region) -> str:
    counts = (("appeared", region.appeared), ("vanished", region.vanished), ("recoloured", region.recoloured))
    kinds = ", ".join(f"{count:,} {kind}" for kind, count in counts if count)
    low, high = (",".join(map(str, corner)) for corner in region.bounds)
    return f"{low} up to {high}: {kinds}"
