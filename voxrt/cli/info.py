"""``voxrt info``."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import Annotated

from cyclopts import Parameter

from voxrt.cli.arguments import Depth, Reporting, choice
from voxrt.cli.memory_results import info_result
from voxrt.cli.messages import frames_row, summarize, tabulate
from voxrt.cli.results import print_json
from voxrt.cli.source import read_source
from voxrt.options.build_options import Dialect  # noqa: TC001 - cyclopts reads the signature


def info(
    scene: Annotated[Path, Parameter(metavar="ROM|ASSET")],
    /,
    *,
    depth: Depth = None,
    dialect: Annotated[Dialect | None, Parameter(converter=choice)] = None,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Print what a memory holds: its size, levels and materials.

    Parameters
    ----------
    scene
        A memory (.mem or another format), with its manifest beside it or without; or an asset, which is built first.
    depth
        Levels of the octree, for an asset or for a memory without a manifest.
    dialect
        How the memory encodes materials, for a memory without a manifest.
    reporting
        How results are printed.
    """
    blob = read_source(scene, depth, dialect, frames=True).blob
    told = info_result(blob)
    if reporting.json:
        print_json(told)
        return
    side, world = 1 << told.depth, told.world
    size = f", {world.voxel_size:.4g} m each" if world else ""
    without = f"; {1 + 8 * told.unshared_blocks:,} words without sharing"
    rows = [
        ("grid", f"{side} voxels per side (depth {told.depth}){size}"),
        ("solid", f"{told.voxels:,} voxels, {100 * told.voxels / side**3:.2f} %"),
        ("memory", f"{told.words:,} words, {told.words * 4 / 1024:,.1f} KiB" + ("" if blob.animation else without)),
    ]
    if told.shared_words < told.words and blob.animation is None:
        rows.append(("shared", f"{told.shared_words:,} words would do: equal blocks are stored more than once"))
    if told.mean_materials is not None:
        rows.append(("lod", f"mean materials for {told.mean_materials:,} of {told.blocks:,} blocks"))
    if blob.animation is not None:
        rows.append(("frames", frames_row(blob.animation, told.words)))
    if told.bounds:
        rows.insert(2, ("within", "{} up to {}".format(*told.bounds)))
    rows += [
        (board.name, f"{'fits' if board.fits else 'does not fit'} its {board.words:,} words") for board in told.boards
    ]
    summarize(f"{scene.name}:", rows, answer=True)
    tabulate(
        ("level", "side", "solid", "empty"),
        [(str(row.level), f"{1 << row.level:,}", f"{row.solid:,}", f"{row.empty:,}") for row in told.levels],
        answer=True,
    )
    tabulate(
        ("material", "name", "colour", "voxels"),
        [
            (str(row.id), row.name, "#{:02x}{:02x}{:02x}".format(*row.colour), f"{row.voxels:,}")
            for row in told.materials
        ],
        answer=True,
    )
    if told.frames is not None:
        tabulate(
            ("frame", "root", "words", "time", "name"),
            [
                (str(row), str(one.root), f"{one.words:,}", "" if one.time is None else f"{one.time:.4g}", one.name)
                for row, one in enumerate(told.frames)
            ],
            answer=True,
        )
