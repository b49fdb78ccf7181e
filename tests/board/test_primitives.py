"""The settings of the ECP5's primitives in what ships are those of docs/board-primitives.md."""

from __future__ import annotations

import bz2
import re
from collections import defaultdict
from functools import cache
from pathlib import Path

import pytest

from voxrt.board.designs.build import DESIGNS

PAGE = Path(__file__).resolve().parents[2] / "docs" / "board-primitives.md"
CONFIGS = sorted(DESIGNS.glob("*/*.config.bz2"))
# Cells of logic and routing are the placement's.
LINE = re.compile(r"^(?:(?:enum|word): (?!SLICE|LSR\d|CLK\d\.|CIB)(\S+)|(\.sysconfig \S+)) (\S+)$", re.MULTILINE)
SITE = re.compile(r"^(EBR|MULT18_|PIO|IOLOGIC)(?:\d|[A-D])\.")


def documented():
    """The values of each setting that the page allows."""
    found = {}
    for line in PAGE.read_text().splitlines():
        cells = line.split(" | ")
        names = re.findall(r"`([^`]+)`", cells[0])
        if line.startswith("| `"):
            found |= {name: set(re.findall(r"`([^`]+)`", cells[1])) for name in names}
    return found


@cache
def settings_of(config):
    found = defaultdict(set)
    for name, option, value in LINE.findall(bz2.decompress(config.read_bytes()).decode()):
        found[SITE.sub(lambda site: site[1].rstrip("_") + ".", name or option)].add(value)
    return found


@pytest.mark.parametrize("config", CONFIGS, ids=lambda path: f"{path.parent.name}-{path.name.split('.')[0]}")
def test_settings_are_those_of_the_page(config):
    allowed, found = documented(), settings_of(config)
    for name, values in allowed.items():
        assert found[name] <= values, name
    assert found["ICP_CURRENT"]
    assert found["PIO.DRIVE"]


def test_the_page_names_every_setting_that_the_designs_have():
    """All of the PLL's words, of memories, multipliers and pins; routing, ports and sizes are the placement's."""
    allowed = documented()
    everywhere = set().union(*(settings_of(config) for config in CONFIGS))
    assert set(allowed) <= everywhere
    words = {name for name in everywhere if re.match(r"^(?:MFG|LPF|ICP|KVCO|FREQ_LOCK|PLL_LOCK)", name)}
    words |= {name for name in everywhere if re.search(r"GSR$|RESETMODE$|REGMODE_|PIO\.(?:DRIVE|SLEW|PULL|HYST)", name)}
    assert words <= set(allowed)
