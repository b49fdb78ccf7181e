"""``voxrt info``."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import Annotated, Literal

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Reporting, levels
from voxrt.cli.memory_results import info_result
from voxrt.cli.messages import summarize, tabulate, warn
from voxrt.cli.results import print_json


def info(
    rom: Annotated[Path, Parameter(metavar="ROM")],
    /,
    *,
    depth: Annotated[int | None, Parameter(converter=levels, metavar="N")] = None,
    dialect: Literal["report", "seed-rtl", "msb"] | None = None,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Print what a memory holds: its size, levels and materials.

    Parameters
    ----------
    rom
        A .mem, .coe, .mif or .bin file, with its manifest beside it or without, or a .blob.
    depth
        Levels of the octree, for a memory without a manifest.
    dialect
        How the memory encodes materials, for a memory without a manifest.
    reporting
        How results are printed.
    """
    blob, warnings = voxrt.read_any(rom, depth=depth, dialect=dialect)
    warn(warnings)
    told = info_result(blob.rom)
    if reporting.json:
        print_json(told)
        return
    side, world = 1 << told.depth, told.world
    size = f", {world.voxel_size:.4g} m each" if world else ""
    unshared = 1 + 8 * told.unshared_blocks
    rows = [
        ("grid", f"{side} voxels per side (depth {told.depth}){size}"),
        ("solid", f"{told.voxels:,} voxels, {100 * told.voxels / side**3:.2f} %"),
        ("memory", f"{told.words:,} words, {told.words * 4 / 1024:,.1f} KiB; {unshared:,} words without sharing"),
    ]
    if told.shared_words < told.words:
        rows.append(("shared", f"{told.shared_words:,} words would do: equal blocks are stored more than once"))
    if told.bounds:
        rows.insert(2, ("within", "{} up to {}".format(*told.bounds)))
    rows += [
        (board.name, f"{'fits' if board.fits else 'does not fit'} its {board.words:,} words") for board in told.boards
    ]
    summarize(f"{rom.name}:", rows)
    tabulate(
        ("level", "side", "solid", "empty"),
        [(str(row.level), f"{1 << row.level:,}", f"{row.solid:,}", f"{row.empty:,}") for row in told.levels],
    )
    tabulate(
        ("material", "name", "colour", "voxels"),
        [
            (str(row.id), row.name, "#{:02x}{:02x}{:02x}".format(*row.colour), f"{row.voxels:,}")
            for row in told.materials
        ],
    )
