"""What ``voxrt bitstream --json`` prints, and its report holds."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from voxrt.cli.results.build_results import BudgetEntry, budget_entry
from voxrt.cli.terminal.messages import name_file

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.boards.beam import BeamFit
    from voxrt.boards.bitstream import PlacedBoard
    from voxrt.building.fitting import BudgetFit
    from voxrt.octree import Rom


class BitstreamResult(msgspec.Struct, frozen=True):
    """``voxrt bitstream --json``."""

    name: str
    board: str
    title: str
    bitstream: str
    """The file."""
    words: int
    capacity: int
    """Words of the board's octree memory."""
    depth: int
    lanes: int
    clock_hz: int
    fmax_mhz: dict[str, float]
    """Frequency that place and route reach, per clock."""
    utilisation: dict[str, tuple[int, int]]
    """Cells of the part: used, available."""
    seed: int
    """Seed of the placement."""
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
    revision: str | None = None
    """The revision of the board that the design is for; null: all."""
    other_revisions: str | None = None
    """What differs in the others."""


def bitstream_result(
    rom: Rom, placed: PlacedBoard, beam: BeamFit, file: Path, budget: BudgetFit | None
) -> BitstreamResult:
    """Put together what a bitstream shows."""
    design = placed.design
    return BitstreamResult(
        name=rom.name,
        board=placed.name,
        title=placed.title,
        revision=placed.revision,
        other_revisions=placed.other_revisions,
        bitstream=name_file(file),
        words=len(rom.octree.words),
        capacity=design.capacity,
        depth=rom.octree.depth,
        lanes=design.core["Lanes"],
        **{name: getattr(design, name) for name in ("clock_hz", "fmax_mhz", "utilisation", "seed")},
        size=beam.size,
        cycles_per_pixel=round(beam.cycles_per_pixel, 4),
        lead_lines=None if design.frame_buffer else round(beam.lead, 2),
        frames_per_second=round(beam.frames_per_second, 3),
        budget=None if budget is None else budget_entry(budget),
    )
