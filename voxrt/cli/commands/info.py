"""``voxrt info``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.cli.inputs.source import read_source
from voxrt.cli.results.build_results import print_json
from voxrt.cli.results.memory_results import info_result
from voxrt.cli.terminal.messages import frames_row, summarize, tabulate

if TYPE_CHECKING:
    from voxrt.options.memory_commands import InfoCommand


def run(options: InfoCommand) -> None:
    """Print what a memory holds: its size, levels and materials."""
    blob = read_source(options.scene, options.depth, options.dialect, frames=True).blob
    info = info_result(blob)
    if options.reporting.json:
        print_json(info)
        return
    side, world = 1 << info.depth, info.world
    size = f", {world.voxel_size:.4g} m each" if world else ""
    without = f"; {1 + 8 * info.unshared_blocks:,} words without sharing"
    rows = [
        ("grid", f"{side} voxels per side (depth {info.depth}){size}"),
        ("solid", f"{info.voxels:,} voxels, {100 * info.voxels / side**3:.2f} %"),
        ("memory", f"{info.words:,} words, {info.words * 4 / 1024:,.1f} KiB" + ("" if blob.animation else without)),
    ]
    if info.shared_words < info.words and blob.animation is None:
        rows.append(("shared", f"{info.shared_words:,} words would do: equal blocks are stored more than once"))
    if info.mean_materials is not None:
        rows.append(("lod", f"mean materials for {info.mean_materials:,} of {info.blocks:,} blocks"))
    if blob.animation is not None:
        rows.append(("frames", frames_row(blob.animation, info.words)))
    if info.bounds:
        rows.insert(2, ("within", "{} up to {}".format(*info.bounds)))
    rows += [
        (board.name, f"{'fits' if board.fits else 'does not fit'} its {board.words:,} words") for board in info.boards
    ]
    summarize(f"{options.scene.name}:", rows, answer=True)
    tabulate(
        ("level", "side", "solid", "empty"),
        [(str(row.level), f"{1 << row.level:,}", f"{row.solid:,}", f"{row.empty:,}") for row in info.levels],
        answer=True,
    )
    tabulate(
        ("material", "name", "colour", "voxels"),
        [
            (str(row.id), row.name, "#{:02x}{:02x}{:02x}".format(*row.colour), f"{row.voxels:,}")
            for row in info.materials
        ],
        answer=True,
    )
    if info.frames is not None:
        tabulate(
            ("frame", "root", "words", "time", "name"),
            [
                (str(row), str(one.root), f"{one.words:,}", "" if one.time is None else f"{one.time:.4g}", one.name)
                for row, one in enumerate(info.frames)
            ],
            answer=True,
        )
