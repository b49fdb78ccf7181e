"""Level of detail on the command line: built, told, converted, rendered, refused."""

from __future__ import annotations

import json

import numpy as np
import pytest

from voxrt import Material, Rom
from voxrt.export import write_rom
from voxrt.octree import from_dense
from voxrt.voxelize import EMPTY


@pytest.fixture
def noise(folder):
    """A memory of 32 voxels per side, without level of detail."""
    rng = np.random.default_rng(2)
    dense = (rng.random((32,) * 3) < 0.4).astype(np.uint8) * rng.integers(1, 3, (32,) * 3).astype(np.uint8)
    table = (EMPTY, Material("black", (0, 0, 0)), Material("white", (255, 255, 255)))
    write_rom(folder, Rom("noise", from_dense(dense), table))
    return folder


def test_a_memory_goes_into_the_dialect_and_back(voxrt, noise):
    assert voxrt("convert", "noise.mem", "detailed.mem", "--dialect", "lod").code == 0
    assert json.loads((noise / "detailed.json").read_text())["dialect"] == "lod"
    info = json.loads(voxrt("info", "detailed.mem", "--json").out)
    assert 0 < info["mean_materials"] <= info["blocks"]
    assert "mean materials for" in voxrt("info", "detailed.mem").out
    assert json.loads(voxrt("info", "noise.mem", "--json").out)["mean_materials"] is None
    assert json.loads(voxrt("diff", "noise.mem", "detailed.mem", "--json").out)["voxels"] == 0
    assert voxrt("convert", "detailed.mem", "back.mem").code == 0
    assert (noise / "back.mem").read_bytes() == (noise / "noise.mem").read_bytes()


@pytest.mark.usefixtures("noise")
def test_pictures_do_not_depend_on_when_the_means_were_made(voxrt, folder):
    voxrt("convert", "noise.mem", "detailed.mem", "--dialect", "lod")
    options = ("--engine", "model", "--size", "24x24")
    for picture, memory, *more in (
        ("plain", "noise"),
        ("also", "detailed"),
        ("one", "noise", "--lod"),
        ("other", "detailed", "--lod"),
        ("fine", "detailed", "--lod", "--lod-cell", "0.25"),
    ):
        assert voxrt("render", f"{memory}.mem", *options, *more, "-o", f"{picture}.png").code == 0
    read = {name: (folder / f"{name}.png").read_bytes() for name in ("plain", "also", "one", "other", "fine")}
    assert read["plain"] == read["also"]
    assert read["one"] == read["other"]
    assert read["one"] != read["plain"]
    assert read["one"] != read["fine"]


@pytest.mark.usefixtures("noise")
def test_what_does_not_go_together_is_told_in_one_line(voxrt):
    voxrt.fails(
        2,
        "--lod does not go with --light or --bounces",
        "render",
        "noise.mem",
        "--lod",
        "--engine",
        "model",
        "--bounces",
        "2",
    )
    voxrt.fails(2, "--lod-cell is of --lod; give both", "render", "noise.mem", "--lod-cell", "2")
    voxrt.fails(
        2,
        "--lod-cell must be a finite number above 0 and below 1024, not -2",
        "render",
        "noise.mem",
        "--lod",
        "--lod-cell",
        "-2",
    )
    voxrt.fails(
        2, "--lod has its own dialect, and msb has no mean materials", "build", "noise.mem", "--lod", "--dialect", "msb"
    )
