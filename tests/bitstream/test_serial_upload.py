"""``voxrt upload --to serial:PORT`` on a pseudo-terminal with a board behind it."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from fakes.ecp5_board import Board
from fakes.serial_terminal import terminal

import voxrt
from voxrt.board.registers import REGISTERS
from voxrt.boards.board_scenes import load_scene
from voxrt.octree import Octree, diff
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


def test_what_changed_little_is_sent_as_a_patch(tmp_path):
    """What Live of Blender does: a command for every change."""
    world = voxrt.World(voxrt.build("examples/house.obj", depth=5).rom)
    board, written = Board(sdram=True), []
    put = board.put
    board.put = lambda address, value: (written.append(address >= 0x800000), put(address, value))[1]
    with terminal(board) as port:
        for number in range(3):
            rom = world.rom()
            voxrt.convert(rom, tmp_path / "house.blob")
            written.clear()
            finished = run("upload", tmp_path / "house.blob", "--to", f"serial:{port}")
            assert finished.returncode == 0, finished.stderr
            words = len(rom.octree.words)
            assert sum(written) == words if number == 0 else 0 < sum(written) < words // 8
            root = board.core.read(REGISTERS["root"][0])
            memory = board.core.read_memory(0, 2 * words + 7)
            memory[0] = memory[root]
            assert diff(Octree(5, memory), rom.octree).voxels == 0
            world.fill(voxrt.Box((10 + number, 10, 10), (13 + number, 12, 13)), number % 2)


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
