"""The self-test of the boards, simulated whole: what a monitor sees, and what the host reads of good and bad boards."""

from __future__ import annotations

import numpy as np
import pytest
from fakes.simulated_port import SimulatedPort
from oracles.selftest_picture import selftest_picture
from oracles.verilator import needs_compiled_verilator

from voxrt.board.designs.build import clock_hz, read_board, selftest_of
from voxrt.board.designs.selftest import SELFTEST_REGISTERS, check_selftest
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.designs.simulation.board_simulation import BoardSimulation, compile_sources

pytestmark = [pytest.mark.xdist_group("selftest"), *needs_compiled_verilator]

PLAIN, CHIP, GOWIN = (selftest_of(read_board(name)) for name in ("icepi-zero", "ulx3s-85f-sdram", "tang-nano-20k"))
RELEASED = 0b111  # the buttons of this board are low when pressed
QUICK = {"LineBits": 8, "PowerOnUs": 2}


def ignore(_what, _done, _total):
    pass


def states(findings):
    return {finding.part: finding.state for finding in findings}


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    return compile_sources(PLAIN, tmp_path_factory.mktemp("plain"))


def test_a_monitor_sees_the_bars(program, tmp_path):
    with BoardSimulation(program, tmp_path) as board:
        board.press(RELEASED)
        (first, timing), (second, _) = board.frames(2)
        assert timing.is_vga, timing
        assert board.leds() & 0b1001 == 0b0001  # locked, no button
        lit = [first[470, 80 * number + 40, 0] == 255 for number in range(8)]
        assert lit[0]
        assert not any(lit[3:])
        for pixels in (first, second):
            lit[1:3] = [pixels[470, 80 * number + 40, 0] == 255 for number in (1, 2)]  # they blink
            np.testing.assert_array_equal(pixels, selftest_picture(lit))


def test_the_host_reads_the_results(program, tmp_path):
    with BoardSimulation(program, tmp_path) as board:
        link = SerialLink("simulation", SimulatedPort(board))
        board.press(RELEASED)
        board.run(2000)
        assert int(link.read(SELFTEST_REGISTERS["clock"], 1)[0]) == clock_hz(PLAIN)
        found = check_selftest(link, ignore)
        passed = dict.fromkeys(("serial line", "PLL", "clocks", "picture"), "passed")
        assert states(found) == passed | {"screen": "open", "buttons": "open"}
        assert found[-1].text.endswith("Not seen yet: pause, reverse, step")
        assert "bit clock 125.00 MHz, pixel clock 25.00 MHz" in found[2].text
        for pressed in (0b110, 0b101):
            board.press(pressed)
            board.run(100)
            assert board.leds() >> 3 & 1
            board.press(RELEASED)
            board.run(100)
            assert not board.leds() >> 3 & 1
        assert check_selftest(link, ignore)[-1].text.endswith("Not seen yet: step")
        board.press(0b011)
        board.run(100)
        board.press(RELEASED)
        assert states(check_selftest(link, ignore)) == passed | {"screen": "open", "buttons": "passed"}
        # Addresses without a register.
        assert link._ask(1, 0x1000, 16, b"") != b""
        with pytest.raises(Exception, match="address 0x001048 has no register"):
            link.read(0x1048, 1)


def test_a_gowin_has_the_same_self_test(tmp_path):
    with BoardSimulation(compile_sources(GOWIN, tmp_path / "program"), tmp_path / "run") as board:
        board.press(0)  # the buttons of this board are high when pressed, and its LEDs are low when lit
        [(pixels, timing)] = board.frames(1)
        assert timing.is_vga, timing
        lit = [pixels[470, 80 * number + 40, 0] == 255 for number in range(8)]
        np.testing.assert_array_equal(pixels, selftest_picture(lit))
        assert ~board.leds() & 0b1001 == 0b0001  # locked, no button
        link = SerialLink("simulation", SimulatedPort(board))
        assert int(link.read(SELFTEST_REGISTERS["clock"], 1)[0]) == clock_hz(GOWIN)
        found = check_selftest(link, ignore)
        passed = dict.fromkeys(("serial line", "PLL", "clocks", "picture"), "passed")
        assert states(found) == passed | {"screen": "open", "buttons": "open"}
        assert "bit clock 126.00 MHz, pixel clock 25.20 MHz" in found[2].text
        assert found[-1].text.endswith("Not seen yet: pause, reverse")


def test_a_button_that_is_always_pressed_fails(program, tmp_path):
    with BoardSimulation(program, tmp_path) as board:
        board.press(0b101)
        found = check_selftest(SerialLink("simulation", SimulatedPort(board)), ignore)
        assert states(found)["buttons"] == "failed"
        assert "always pressed: reverse;" in found[-1].text


@pytest.mark.parametrize(("stuck", "state"), [(0, "passed"), pytest.param(0x0208, "failed", marks=pytest.mark.slow)])
def test_an_sdram_is_tested(stuck, state, tmp_path):
    program = compile_sources(CHIP, tmp_path / "chip", **QUICK, StuckData=stuck)
    with BoardSimulation(program, tmp_path / "run") as board:
        board.run(2000)
        found = check_selftest(SerialLink("simulation", SimulatedPort(board)), ignore)[-1]
        assert (found.part, found.state) == ("SDRAM", state)
        assert (
            "768 lines of 32 bytes" if state == "passed" else "of 768 lines are wrong, the first is 0"
        ) in found.text
        assert state == "passed" or "data bits 3, 9:" in found.text
        assert board.leds() >> 6 == (0b10 if state == "passed" else 0b01)
