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


def rows(page: Path, heads: str) -> list[list[str]]:
    """Give the rows of the first table of a page whose line of heads starts with `heads`."""
    text = page.read_text()
    lines = text[text.index(heads) :].splitlines()[2:]
    table = lines[: next((i for i, line in enumerate(lines) if not line.startswith("|")), len(lines))]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def shows(text: str, *measured: float | str) -> bool:
    """Tell whether the numbers of a text are the measured ones, each rounded to the digits that are shown."""
    found = NUMBER.findall(text)
    assert len(found) == len(measured), text
    for (digits, thousand), value in zip(found, measured, strict=True):
        number = Decimal(digits.replace(",", ""))
        scale = 1000 if thousand else 1
        unit = Decimal(10) ** number.as_tuple().exponent * scale
        if abs(number * scale - Decimal(str(value).replace(",", ""))) > unit / 2:
            return False
    return True


def cycles_of(scene: str, config: str) -> tuple[str, str]:
    """Give words and cycles per pixel, 256x256 pixels, plain."""
    for name, configuration, frame, _, words, cycles, *_ in rows(RESULTS / "rtl.md", "| scene | configuration |"):
        if (name.split(",")[0], configuration, frame) == (scene, config, "plain"):
            return words, cycles
    raise KeyError((scene, config))


def row_of(result: str, heads: str, *first: str) -> list[str]:
    """Give the row of a table of results that starts with these cells."""
    return next(row for row in rows(RESULTS / result, heads) if tuple(row[: len(first)]) == first)


def base(board: str) -> dict:
    return json.loads((BOARDS / board / "base.json").read_text())


def readme_figures() -> dict[str, list[str]]:
    """Give what was measured, by a part of the first cell of a row of the README's table."""
    area = row_of("area.md", "| configuration | lanes |", "z1")
    sphere = row_of("voxelize.md", "| scene | triangles |", "sphere-70k", "70,224", "1024³")
    peers = [cell.split(" / ") for cell in row_of("peers.md", "| tool | makes |", "voxrt")]
    columns = [cell.split(" / ") for cell in row_of("peers.md", "| tool | makes |", "Open3D columns")]
    return {
        "wrong pixels": [row_of("demo.md", "| what | measured |", "pixels that differ")[1]],
        ", one lane": [cycles_of("published house", "tiny")[1]],
        ", 16 lanes": [cycles_of("published house", "z1")[1]],
        "area of 16 lanes": [area[3], area[7]],
        "clock of an eight-lane board": [base("ulx3s-85f")["fmax_mhz"]["system"]],
        "sphere of 70,000 triangles": [sphere[4].removesuffix(" ms")],
        "the whole process": [peers[5][0], peers[5][2].removesuffix(" MB")],
        "Open3D columns": [columns[5][0], columns[5][2].removesuffix(" MB")],
    }


def test_figures_of_the_readme():
    measured = readme_figures()
    for what, ours, others, _ in rows(ROOT / "README.md", "| what | voxrt | for comparison |"):
        (figures,) = [values for name, values in measured.items() if name in what]
        assert shows(ours, *figures), what
        if others.startswith("Open3D columns:"):
            assert shows(others.split(":")[1], *measured["Open3D columns"]), what


CYCLES = rows(ROOT / "rtl" / "README.md", "| scene | words per ray |")


@pytest.mark.parametrize("row", CYCLES, ids=[row[0] for row in CYCLES])
def test_cycles_of_the_hardware_page(row):
    scene, words, *cycles = row
    scene = scene.split(",")[0]
    for config, shown in zip(("tiny", "duo", "quad", "octo", "z1", "banked"), cycles, strict=True):
        measured = cycles_of(scene, config)
        assert shows(words, measured[0]), config
        assert shows(shown, measured[1]), config


def test_boards_of_the_manual():
    shown = {row[0].strip("`"): row[1:] for row in rows(ROOT / "docs" / "ecp5_boards.md", "| board | design |")}
    assert shown.keys() == {path.parent.name for path in BOARDS.glob("*/base.config.bz2")}
    for name, (_, system, pixel, cells) in shown.items():
        design = base(name)
        assert shows(system, design["clock_hz"] / 1e6, design["fmax_mhz"]["system"]), name
        assert shows(pixel, 25, design["fmax_mhz"]["pixel"]), name
        used = design["utilisation"]
        for cell, label in (("TRELLIS_COMB", "LUT4"), ("DP16KD", "block RAMs"), ("MULT18X18D", "multipliers")):
            assert f"{used[cell][0]:,} of {used[cell][1]:,} {label}" in cells, (name, cell)
        assert f"{used['TRELLIS_FF'][0]:,} FF" in cells, name


def test_clocks_of_the_shipped_designs():
    for row in rows(RESULTS / "clock.md", "| design | lanes | MHz |"):
        if (BOARDS / row[0] / "base.json").exists():
            design = base(row[0])
            assert shows(row[2].split(", ")[design["seed"] - 1], design["fmax_mhz"]["system"]), row[0]


def test_table_of_configurations():
    joined = runpy.run_path(str(ROOT / "bench" / "configurations.py"))["joined"]
    assert (RESULTS / "configurations.md").read_text() == joined()


def test_figures_of_the_tutorial():
    measured = dict(rows(RESULTS / "demo.md", "| what | measured |"))
    text = (ROOT / "docs" / "tutorial.md").read_text()
    line = next(line for line in text.splitlines() if line.startswith("  checked"))
    assert shows(line.split("differ,")[1], measured["cycles per pixel"])
    solid = next(line for line in text.splitlines() if line.startswith("  solid"))
    assert shows(solid, measured["solid voxels"])


def test_likeness_of_the_rules():
    """Docs/voxels.md: on how many assets `centre` looks nearer."""
    row = row_of("rule_likeness.md", "| rule | at |", "centre", "equal words")
    by_ssim, by_psnr = (cell.split(" of ")[0] for cell in row[2:4])
    text = (ROOT / "docs" / "voxels.md").read_text()
    assert f"on {by_ssim} of 40 assets by SSIM, on {by_psnr} by PSNR" in " ".join(text.split())
