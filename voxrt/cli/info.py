"""``voxrt info``."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import Annotated, Literal

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Reporting, whole
from voxrt.cli.messages import summarize, tabulate, warn
from voxrt.cli.results import print_json, rom_info


def info(
    rom: Annotated[Path, Parameter(metavar="ROM")],
    /,
    *,
    depth: Annotated[int | None, Parameter(converter=whole, metavar="N")] = None,
    dialect: Literal["report", "seed-rtl", "msb"] | None = None,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Tell what a memory holds.

    Parameters
    ----------
    rom
        A .mem file, with its manifest beside it or without.
    depth
        Levels of the octree, where no manifest says.
    dialect
        How the memory spells a material, where no manifest says.
    reporting
        How to tell it.
    """
    memory, warnings = voxrt.read_rom(rom, depth=depth, dialect=dialect)
    warn(warnings)
    told = rom_info(memory)
    if reporting.json:
        print_json(told)
        return
    side = 1 << told.depth
    world = told.world
    summarize(
        f"{rom.name}:",
        [
            (
                "grid",
                f"{side} voxels a side (depth {told.depth})" + (f", {world.voxel_size:.4g} m each" if world else ""),
            ),
            *([("lowest", "({:.6g}, {:.6g}, {:.6g}) m".format(*world.origin))] if world else []),
            ("solid", f"{told.voxels:,} voxels, {100 * told.voxels / side**3:.2f} %"),
            ("memory", f"{told.words:,} words, {told.words * 4 / 1024:,.1f} KiB, {told.blocks:,} blocks"),
        ],
    )
    tabulate(
        ("level", "side", "solid", "empty"),
        [(str(row.level), f"{row.side:,}", f"{row.solid:,}", f"{row.empty:,}") for row in told.levels],
    )
    tabulate(
        ("material", "name", "colour", "voxels"),
        [
            (str(row.id), row.name, "#{:02x}{:02x}{:02x}".format(*row.colour), f"{row.voxels:,}")
            for row in told.materials
        ],
    )
