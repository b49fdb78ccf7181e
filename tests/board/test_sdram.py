"""The SDRAM of a board: controller, arbiter and AXI port, with a model of the chip that stops at a broken rule."""

from __future__ import annotations

import pytest
from fakes.sdram_bench import clocks_per_line, run_bench
from oracles.verilator import needs_compiled_verilator

pytestmark = [pytest.mark.xdist_group("sdram"), *needs_compiled_verilator]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where the bench is compiled; what does not depend on its parameters is compiled once."""
    return tmp_path_factory.mktemp("bench")


def test_four_ports_read_what_was_written(folder):
    finished = run_bench(folder, 300_000)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    mixed, *measured = finished.stdout.splitlines()
    *lines, longest = map(int, mixed.split())
    assert min(lines) > 2000
    # No port starves: two others have a line before, each after one of the screen; 23 clocks each, and a refresh.
    assert longest <= 8 * 25
    clocks = clocks_per_line(measured)
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
