"""Figures in pages are those of the results that they name."""

from __future__ import annotations

import json
import re
import runpy
from decimal import Decimal
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
RESULTS = ROOT / "bench" / "results"
BOARDS = ROOT / "board" / "designs"
NUMBER = re.compile(r"(?<![\w.])(\d[\d,]*(?:\.\d+)?)( k\b)?")


def rows(page: str, heads: str) -> list[list[str]]:
    """Give the rows of the table whose first line starts with `heads`."""
    lines = page[page.index(heads) :].splitlines()[2:]
    table = lines[: next((i for i, line in enumerate(lines) if not line.startswith("|")), len(lines))]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def numbers(text: str) -> list[tuple[Decimal, Decimal]]:
    """Give each number of a text, and the unit of its last digit."""
    found = []
    for digits, thousand in NUMBER.findall(text):
        number = Decimal(digits.rstrip(",").replace(",", ""))
        scale = 1000 if thousand else 1
        found.append((number * scale, Decimal(10) ** number.as_tuple().exponent * scale))
    return found


def is_rounded(shown: Decimal, unit: Decimal, measured: Decimal) -> bool:
    return abs(shown - measured) <= unit / 2


README = rows((ROOT / "README.md").read_text(), "| what | voxrt | for comparison |")


@pytest.mark.parametrize("row", README, ids=[row[0] for row in README])
def test_figures_of_the_readme(row):
    _, ours, _, source = row
    place = re.search(r"\((.*?)\)", source)[1]
    known = [number for number, _ in numbers((ROOT / place).read_text())]
    for number, unit in numbers(ours):
        assert any(is_rounded(number, unit, each) for each in known), (str(number), place)


def test_cycles_of_the_hardware_page():
    results = (RESULTS / "rtl.md").read_text()
    known = {
        (scene.split(",")[0], config): (words, cycles)
        for scene, config, frame, _, words, cycles, *_ in rows(results, "| scene | configuration | frame |")
        if frame == "plain"
    }
    for scene, words, *cycles, _ in rows((ROOT / "rtl" / "README.md").read_text(), "| scene | words per ray |"):
        configurations = ("tiny", "duo", "quad", "octo", "z1", "banked")
        for config, shown in zip(configurations, cycles, strict=True):
            measured = known[scene.split(",")[0], config]
            for text, found in ((words, measured[0]), (shown, measured[1])):
                (number, unit), *_ = numbers(text)
                assert is_rounded(number, unit, Decimal(found)), (scene, config)


def test_boards_of_the_manual():
    page = (ROOT / "docs" / "ecp5_boards.md").read_text()
    shown = {row[0].strip("`"): row[1:] for row in rows(page, "| board | design | clock of the ray tracer")}
    names = {path.parent.name for path in BOARDS.glob("*/base.json")}
    assert shown.keys() == names
    for name in names:
        base = json.loads((BOARDS / name / "base.json").read_text())
        _, system, pixel, cells = shown[name]
        for text, clock in ((system, "system"), (pixel, "pixel")):
            number, unit = numbers(text)[-1]
            assert is_rounded(number, unit, Decimal(str(base["fmax_mhz"][clock]))), (name, clock)
        used = base["utilisation"]
        for cell, label in (("TRELLIS_COMB", "LUT4"), ("DP16KD", "block RAMs"), ("MULT18X18D", "multipliers")):
            assert f"{used[cell][0]:,} of {used[cell][1]:,} {label}" in cells, (name, cell)
        assert f"{used['TRELLIS_FF'][0]:,} FF" in cells, name


def test_table_of_configurations():
    joined = runpy.run_path(str(ROOT / "bench" / "configurations.py"))["joined"]
    assert (RESULTS / "configurations.md").read_text() == joined()
