"""The self-tests after place and route, simulated: the netlist of the shipped ``.config`` does what the sources do."""

from __future__ import annotations

import bz2
import json

import numpy as np
import pytest
from fakes.simulated_port import SimulatedPort
from oracles.selftest_picture import selftest_picture
from oracles.verilator import needs_compiled_verilator

from voxrt.board.designs import build
from voxrt.board.designs.gowin_bitstream import BlockRams
from voxrt.board.designs.selftest import SELFTEST_REGISTERS, check_selftest
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.designs.simulation import placed_gowin, placed_netlist
from voxrt.board.designs.simulation.board_simulation import BoardSimulation, compile_placed

pytestmark = [pytest.mark.slow, *needs_compiled_verilator]


@pytest.mark.parametrize("name", build.board_names())
def test_a_placed_self_test_does_what_its_sources_do(name, tmp_path):
    board = build.selftest_of(build.read_board(name))
    for package in build.tools_of(board):
        pytest.importorskip(package, reason="the tools that place designs are not installed")
    described = build.build(name, tmp_path, write_netlist=True, selftest=True)
    kind = build.config_kind(board)
    config = bz2.decompress((build.DESIGNS / name / f"selftest.{kind}.bz2").read_bytes()).decode()
    assert (tmp_path / f"top.{kind}").read_text() == config
    cells = placed_gowin if build.is_gowin(board) else placed_netlist
    (tmp_path / "placed.v").write_text(cells.placed_verilog(json.loads((tmp_path / "placed.json").read_text())))
    program = compile_placed(board, [*cells.MODELS, tmp_path / "placed.v"], tmp_path / "program")
    if build.is_gowin(board):
        placed_gowin.write_block_rams(config, BlockRams(**described["block_rams"]), tmp_path)
    else:
        placed_netlist.write_block_rams(config, tmp_path)
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
