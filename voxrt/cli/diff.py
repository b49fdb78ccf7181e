"""``voxrt diff``."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import Annotated

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Reporting, UsageError
from voxrt.cli.memory_results import DiffResult
from voxrt.cli.messages import summarize, warn
from voxrt.cli.results import print_json


def diff(
    first: Annotated[Path, Parameter(metavar="FIRST")],
    second: Annotated[Path, Parameter(metavar="SECOND")],
    /,
    *,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Compare the voxels of two memories, however their words are arranged.

    Parameters
    ----------
    first
        A memory in any format.
    second
        Another, of the same depth.
    reporting
        How to tell it.
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
    if reporting.json:
        print_json(DiffResult(found.voxels, found.appeared, found.vanished, found.recoloured, found.bounds))
        return
    rows = [
        ("differ", f"{found.voxels:,} voxels"),
        ("appeared", f"{found.appeared:,}"),
        ("vanished", f"{found.vanished:,}"),
        ("recoloured", f"{found.recoloured:,}"),
    ]
    if found.bounds:
        rows.append(("within", "{} up to {}".format(*found.bounds)))
    summarize(f"{first.name} to {second.name}:", rows if found.voxels else rows[:1])
