"""One measurement of bench/peers.py."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Run:
    """What one tool made of one mesh at one depth, or why it did not: medians of the runs."""

    tool: str
    mesh: str
    depth: int
    failure: str = ""
    wall: float = 0.0
    """Seconds of the whole process."""
    step: float = 0.0
    """Seconds from the mesh's arrays to the voxels."""
    peak: float = 0.0
    """Most resident memory, MB."""
    voxels: int = 0
    words: int = 0
