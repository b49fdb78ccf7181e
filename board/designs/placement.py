"""What a placement has made of what: the record that ties a netlist, its placed design and the report of nextpnr.

``python -m voxrt.board.designs.build`` writes one per placement, ``placements/NAME-SEED.json.bz2`` beside the board's
description. ``docs/board-files.md`` says how the tests use it.
"""

from __future__ import annotations

import bz2
import hashlib
from typing import TYPE_CHECKING, Any

import msgspec

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

_FILES = {
    "netlist": "top.json",
    "constraints": "top.lpf",
    "config": "top.config",
    "placed": "placed.json",
    "bitstream": "top.fs",
}


class Placement(msgspec.Struct, frozen=True):
    """The record of a placement.

    Attributes
    ----------
    sources
        SHA-256 of sources, parameters and pins.
    seed
        Of the placement.
    tools
        Their versions.
    digests
        SHA-256 of the ``netlist`` that yosys wrote, of ``constraints`` (the LPF file), of ``config`` (what nextpnr
        wrote and the board's files hold, compressed), and of ``placed``, the netlist after place and route, which is
        simulated; of a GW2A, ``bitstream``.
    report
        What nextpnr reported: `fmax`, `utilization`, `critical_paths`.
    """

    sources: str
    seed: int
    tools: dict[str, str]
    digests: dict[str, str]
    report: dict[str, Any]


def digests_of(folder: Path) -> dict[str, str]:
    """Give the SHA-256 of what the tools have written into a folder, by what it is."""
    files = {name: folder / file for name, file in _FILES.items()}
    return {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in files.items() if path.is_file()}


def write_placement(described: Mapping[str, Any], folder: Path, file: Path) -> None:
    """Write the record of the placement in a folder, which `build.describe` described."""
    report = msgspec.json.decode((folder / "report.json").read_bytes())
    record = Placement(described["sources"], described["seed"], described["tools"], digests_of(folder), report)
    file.parent.mkdir(exist_ok=True)
    file.write_bytes(bz2.compress(msgspec.json.encode(record)))


def read_placement(file: Path) -> Placement:
    """Read the record of a placement."""
    return msgspec.json.decode(bz2.decompress(file.read_bytes()), type=Placement)


def crossing_delays(report: Mapping[str, Any], clocks: Mapping[str, str]) -> dict[str, float]:
    """Give the longest delay from each clock to each other one, ns, such as ``pixel to bit``.

    Parameters
    ----------
    report
        Of nextpnr.
    clocks
        Names of clocks by their nets.
    """
    found = {}
    for path in report["critical_paths"]:
        start, end = (
            clocks.get(path[side].removeprefix("posedge ").removeprefix("negedge ")) for side in ("from", "to")
        )
        if start and end and start != end:
            found[f"{start} to {end}"] = round(sum(part["delay"] for part in path["path"]), 2)
    return found
