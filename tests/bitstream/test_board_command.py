"""``voxrt board`` on a pseudo-terminal with a board behind it, and over TCP with a fake PYNQ."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from fakes.ecp5_board import Board
from fakes.serial_terminal import terminal

from voxrt.board.designs import serial_link
from voxrt.board.designs.boot_table import BOARD_REGISTERS, RUN, TURN
from voxrt.board.designs.selftest import SELFTEST_REGISTERS
from voxrt.board.registers import REGISTERS
from voxrt.boards.board_scenes import load_scene
from voxrt.cli import run as cli_run

pytest.importorskip("serial", reason="pyserial is not installed")

GOOD = {
    "identity": int.from_bytes(b"VXST", "big"),
    "version": 0x101,
    "clock": 75_000_000,
    "lock": 1,
    "bit_clocks": 1_747_584,
    "pixel_clocks": 349_504,
    "buttons": 0x00070700,
    "sdram": 0x301,
    "sdram_lines": 2_097_408,
    "pixel_clock": 25_000_000,
    "button_count": 3,
}


class SelfTest(Board):
    """The registers of a self-test; frames go on."""

    def __init__(self, **values):
        super().__init__()
        named = dict.fromkeys(SELFTEST_REGISTERS, 0) | GOOD | values
        self.registers = {SELFTEST_REGISTERS[name]: value for name, value in named.items()}

    def answer(self, data):
        before = self.registers[SELFTEST_REGISTERS["buttons"]]  # where other designs count requests
        answer = super().answer(data)
        self.registers[SELFTEST_REGISTERS["buttons"]] = before
        return answer

    def blank(self):
        self.registers[SELFTEST_REGISTERS["frames"]] += 1


def run(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "voxrt", "board", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


def test_a_good_board():
    with terminal(SelfTest()) as port:
        finished = run("check", f"serial:{port}")
    assert finished.returncode == 0, finished.stderr
    for text in (
        "serial line passed: 256 words went there and came back",
        "PLL        passed: locked since the bitstream was loaded; the system clock is 75 MHz",
        "clocks     passed: bit clock 125.00 MHz, pixel clock 25.00 MHz, by the system clock",
        "picture    passed: the board draws frames",
        "screen     open: look at it:",
        "buttons    passed: each was pressed and let go",
        "SDRAM      passed: 2,097,408 lines of 32 bytes hold two patterns",
    ):
        assert text in finished.stdout


@pytest.mark.parametrize(
    ("values", "part", "text"),
    [
        ({"lock": 0x301}, "PLL", "it lost its lock 3 times"),
        ({"lock": 0}, "PLL", "it is not locked now"),
        ({"pixel_clocks": 300_000}, "clocks", "pixel clock 21.46 MHz, by the system clock; they must be 125 and 25"),
        ({"sdram_wrong": 5, "sdram_bits": 0xFFFF}, "SDRAM", "all data bits: the data are taken too early or too late"),
        (
            {"sdram_wrong": 5, "sdram_bits": 0x10, "sdram_first": 77},
            "SDRAM",
            "the first is 77, data bits 4: these pins",
        ),
        ({"sdram": 0x101}, "SDRAM", "the test stands still after 2,097,408 lines"),
    ],
)
def test_a_fault_says_what_to_do(values, part, text):
    with terminal(SelfTest(**values)) as port:
        finished = run("check", f"serial:{port}", "--json")
    assert finished.returncode == 5
    assert f"the self-test found faults: {part}; each line above says what to do" in finished.stderr
    found = {each["part"]: each for each in json.loads(finished.stdout)["findings"]}
    assert found[part]["state"] == "failed"
    assert text in found[part]["text"]


def test_a_board_with_a_scene_is_no_self_test():
    with terminal(Board()) as port:
        finished = run("check", f"serial:{port}")
    assert finished.returncode == 5
    assert "the board shows a scene; load its self-test: voxrt bitstream" in finished.stderr


@pytest.fixture
def report(monkeypatch, capsys):
    """Runs the command in this process: the ray tracer behind the port takes longer than a serial line may."""

    def run_report(board, *options):
        board.registers[0x1008] = 2 << 4 | RUN | TURN  # pictures of 160 x 120
        monkeypatch.setattr(serial_link, "open_serial", lambda name: serial_link.SerialLink(name, board))
        assert cli_run.run(["board", "report", "serial:board", *options]) == 0
        return capsys.readouterr().out

    return run_report


def test_a_report_compares_with_the_exact_model(report):
    board = Board()
    found = json.loads(report(board, "--views", "3", "--json"))
    scene = load_scene(Path("examples/house.obj"), 5)
    assert (found["words"], found["crc32"]) == (len(scene.words), scene.crc32)
    assert len(found["views"]) == 3
    for view in found["views"]:
        assert view["equal"]
        assert view["crc32"] == view["expected_crc32"]
        assert 0 < view["hits"] < view["size"][0] * view["size"][1]
    assert len({view["expected_crc32"] for view in found["views"]}) == 3
    assert found["registers"]["board.identity"] == int.from_bytes(b"VXBD", "big")
    assert board.played[-1] == 0  # its scene, as before


@pytest.mark.parametrize("wrong", [REGISTERS["hits"][0], BOARD_REGISTERS["frame_crc"]])
def test_a_report_tells_a_difference(report, wrong):
    class Wrong(Board):
        def get(self, address):
            return super().get(address) ^ (address == wrong)

    assert "DIFFERS from the exact model; expected" in report(Wrong(), "--views", "1")


def test_a_report_of_a_design_without_crcs_compares_hits(report):
    found = json.loads(report(Board(has_crc=False), "--views", "2", "--json"))
    assert [(view["equal"], view["crc32"]) for view in found["views"]] == [(True, None)] * 2
    assert "board.frame_crc" not in found["registers"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["check", "tcp://pynq:4810"], "self-tests are read by a serial line"),
        (["report", "model"], "model is no board; name it as serial:PORT or tcp://BOARD:PORT"),
        (["look", "serial:x"], "is none of"),
    ],
)
def test_what_is_no_board_is_refused(words, message):
    finished = run(*words)
    assert finished.returncode == 2
    assert message in finished.stderr
