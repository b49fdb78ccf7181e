"""``voxrt upload --to serial:PORT`` on a pseudo-terminal with a board behind it."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from fakes.ecp5_board import Board
from fakes.serial_terminal import terminal

import voxrt
from voxrt.boards.board_scenes import load_scene
from voxrt.views.viewpoint import orbit

pytest.importorskip("serial", reason="pyserial is not installed")


def run(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "voxrt", *map(str, arguments)], capture_output=True, text=True, timeout=300, check=False
    )


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    folder = tmp_path_factory.mktemp("house")
    voxrt.build("examples/house.obj", folder, depth=4)
    return folder / "house.mem"


def test_upload(house):
    board = Board()
    with terminal(board) as port:
        finished = run("upload", house, "--to", f"serial:{port}")
    assert finished.returncode == 0, finished.stderr
    assert "loaded" in finished.stdout + finished.stderr
    scale = board.registers[0x1008] >> 4 & 3
    size = (640 >> scale, 480 >> scale)
    rom = voxrt.read_any(house)[0].rom
    # One camera of the orbit is loaded at each vertical blanking: play the first one.
    board.play(2048, 16)
    expected = voxrt.render(rom, orbit(rom, size)[0], size=size, engine="model").colour
    np.testing.assert_array_equal(board.screen(), expected)


def test_dry_run_writes_nothing(house):
    board = Board()
    with terminal(board) as port:
        finished = run("upload", house, "--to", f"serial:{port}", "--dry-run")
    assert finished.returncode == 0, finished.stderr
    assert not board.played
    assert not board.table.any()


def test_a_scene_that_does_not_fit_is_refused(tmp_path):
    voxrt.build("examples/courtyard.glb", tmp_path, depth=7)
    board = Board()
    with terminal(board) as port:
        finished = run("upload", tmp_path / "courtyard.mem", "--to", f"serial:{port}")
    assert finished.returncode == 4
    assert len(load_scene(tmp_path / "courtyard.mem").words) > board.words
    assert "build it with a smaller" in finished.stderr
    assert not board.played


def test_no_port_is_one_line(tmp_path, house):
    finished = run("upload", house, "--to", f"serial:{tmp_path / 'tty'}")
    assert finished.returncode == 5
    assert len(finished.stderr.strip().splitlines()) == 1
    assert "cannot be opened (No such file or directory)" in finished.stderr
