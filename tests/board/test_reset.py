"""A board is in reset until its PLL has been locked for a while, and again when it loses its lock."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from fakes.verilated import compile_bench
from oracles.verilator import needs_compiled_verilator

pytestmark = [pytest.mark.xdist_group("sdram"), *needs_compiled_verilator]

DESIGNS = Path(__file__).resolve().parents[2] / "board" / "designs"
SOURCES = [DESIGNS / "board_synchronizer.sv", DESIGNS / "board_reset.sv", Path(__file__).with_name("reset_bench.cpp")]


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    return compile_bench("board_reset", SOURCES, tmp_path_factory.mktemp("reset"))


def expected(locked: str) -> str:
    """The synchronizer takes two clocks, the count 15 that are locked without a break, the output one."""
    seen = "00" + locked
    return "".join("01"[i >= 15 and "0" not in seen[i - 15 : i + 1]] for i in range(len(locked)))


@pytest.mark.parametrize(
    "locked",
    ["0" * 5 + "1" * 40, "1" * 40, "0" + "1" * 10 + "0" + "1" * 40, "1" * 30 + "0" + "1" * 40, "10" * 30 + "1" * 20],
)
def test_the_reset_lasts_until_the_lock_has_lasted(locked, program):
    finished = subprocess.run([program, locked], capture_output=True, text=True, check=True)
    assert finished.stdout == expected(locked)
