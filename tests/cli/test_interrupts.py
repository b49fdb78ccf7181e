"""Whoever interrupts a run finds the old files or the new ones, whole, and exit code 130."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from itertools import count

import pytest

import voxrt as library

ARGUMENTS = ["build", "house.obj", "-o", "out", "--preview", "--size", "16x12", "--engine", "model"]

# Sends itself a signal at the n-th time that the run touches a file below a folder.
AT_A_TOUCH = """
import os, signal, sys
moment, number, folder = int(sys.argv.pop(1)), int(sys.argv.pop(1)), sys.argv.pop(1)
touches = 0
def watch(event, arguments):
    global touches
    if event in {"open", "os.rename", "os.remove", "os.mkdir", "os.chmod"} and folder in str(arguments[0]):
        touches += 1
        if touches == moment:
            signal.raise_signal(number)
from voxrt.cli import main
sys.addaudithook(watch)
main()
"""

# Sends itself a signal while the model renders.
IN_NATIVE_CODE = """
import os, signal, sys, threading
from voxrt.sim import _model
render = _model.render
def render_interrupted(*arguments):
    threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT)).start()
    return render(*arguments)
_model.render = render_interrupted
from voxrt.cli import main
main()
"""


def run(folder, code, *arguments):
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=300)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_at_every_touch_of_a_file(folder, number):
    states = {}
    for depth in (3, 4):
        finished = run(folder, AT_A_TOUCH, -1, 0, "-", *ARGUMENTS, "--depth", depth)
        assert finished.returncode == 0, finished.stderr
        states[depth] = {path.name: path.read_bytes() for path in (folder / "out").iterdir()}
    for moment in count(1):
        for name, content in states[3].items():
            (folder / "out" / name).write_bytes(content)
        finished = run(folder, AT_A_TOUCH, moment, int(number), str(folder / "out"), *ARGUMENTS, "--depth", 4)
        if finished.returncode == 0:
            break
        assert finished.returncode == 128 + number
        assert len(finished.stderr.splitlines()) == 1, finished.stderr
        now = {path.name: path.read_bytes() for path in (folder / "out").iterdir()}
        assert set(now) == set(states[3])
        assert now["house.preview.png"] in {states[3]["house.preview.png"], states[4]["house.preview.png"]}
        rom, warnings = library.read_rom(folder / "out/house.mem")
        assert warnings == ()
        assert now["house.mem"] == states[rom.octree.depth]["house.mem"]
        assert json.loads(now["house.json"])["depth"] == rom.octree.depth
    assert moment > 5


def test_in_native_code(folder):
    assert run(folder, AT_A_TOUCH, -1, 0, "-", "build", "house.obj", "--depth", 6).returncode == 0
    finished = run(folder, IN_NATIVE_CODE, "render", "house.mem", "--engine", "model", "--size", "16000x16000")
    assert finished.returncode == 130
    assert finished.stderr == "voxrt: error: interrupted: every file is as it was, or complete\n"
    assert not (folder / "house.png").exists()


@pytest.mark.parametrize("arguments", [["build", "house.obj", "--depth", "3", "--json"], ["--help"]])
def test_nobody_reads_stdout(folder, arguments):
    reader, writer = os.pipe()
    os.close(reader)
    command = [sys.executable, "-m", "voxrt", *arguments]
    finished = subprocess.run(command, cwd=folder, stdout=writer, stderr=subprocess.PIPE, check=False)
    os.close(writer)
    assert finished.returncode == 128 + signal.SIGPIPE
    assert finished.stderr == b""


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full here")
def test_stdout_is_full(folder):
    command = [sys.executable, "-m", "voxrt", "build", "house.obj", "--depth", "3", "--json"]
    with open("/dev/full", "w") as full:
        finished = subprocess.run(command, cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert finished.returncode == 2
    assert finished.stderr == "voxrt: error: standard output: No space left on device\n"
