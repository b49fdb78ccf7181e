"""What ``voxrt bitstream --json`` prints, and its report holds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec

from voxrt.cli.results.build_results import BudgetEntry, budget_entry
from voxrt.cli.terminal.messages import name_file

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.boards.beam import BeamFit
    from voxrt.boards.bitstream import PlacedBoard
    from voxrt.building.fitting import BudgetFit
    from voxrt.octree import Rom


class PlacedResult(msgspec.Struct, frozen=True, kw_only=True):
    """``voxrt bitstream --selftest --json``: the placed design of a board."""

    board: str
    title: str
    bitstream: str
    """The file."""
    clock_hz: int
    fmax_mhz: dict[str, float]
    """Frequency that place and route reach, per clock."""
    utilisation: dict[str, tuple[int, int]]
    """Cells of the part: used, available."""
    seed: int
    """Seed of the placement."""
    revision: str | None = None
    """The revision of the board that the design is for; null: all."""
    other_revisions: str | None = None
    """What differs in the others."""


class BitstreamResult(PlacedResult, frozen=True, kw_only=True):
    """``voxrt bitstream --json``."""

    name: str
    words: int
    capacity: int
    """Words of the board's octree memory."""
    depth: int
    lanes: int
    size: tuple[int, int]
    """Columns and rows of the pictures; the screen has 640 x 480."""
    cycles_per_pixel: float
    """Cycles per pixel in the slowest of eight views of the orbit."""
    lead_lines: float | None
    """How many lines of the screen each row is complete before it is shown, at least; negative: rows are repeated; null
    where whole pictures are shown from a frame buffer."""
    frames_per_second: float
    """New pictures; the screen repeats them at 59.5 Hz."""
    budget: BudgetEntry | None = None
    """What fitting an asset to the board took; null for a memory, which must fit as it is."""


def selftest_result(placed: PlacedBoard, file: Path) -> PlacedResult:
    """Put together what the bitstream of a self-test is."""
    return PlacedResult(**_of_placed(placed, file))


def bitstream_result(
    rom: Rom, placed: PlacedBoard, beam: BeamFit, file: Path, budget: BudgetFit | None
) -> BitstreamResult:
    """Put together what a bitstream shows."""
    design = placed.design
    return BitstreamResult(
        **_of_placed(placed, file),
        name=rom.name,
        words=len(rom.octree.words),
        capacity=design.capacity,
        depth=rom.octree.depth,
        lanes=design.core["Lanes"],
        size=beam.size,
        cycles_per_pixel=round(beam.cycles_per_pixel, 4),
        lead_lines=None if design.frame_buffer else round(beam.lead, 2),
        frames_per_second=round(beam.frames_per_second, 3),
        budget=None if budget is None else budget_entry(budget),
    )


def _of_placed(placed: PlacedBoard, file: Path) -> dict[str, Any]:
    return {
        "board": placed.name,
        "bitstream": name_file(file),
        **{name: getattr(placed, name) for name in ("title", "revision", "other_revisions")},
        **{name: getattr(placed.design, name) for name in ("clock_hz", "fmax_mhz", "utilisation", "seed")},
    }
