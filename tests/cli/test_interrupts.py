"""Whoever interrupts a run finds the old files or the new ones, whole, and exit code 130."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import voxrt as library

# Builds again and again over the same old files, in children of its own, and signals the n-th of them at the n-th time
# that it touches a file; leaves what it finds each time in a folder of its own.
AT_EVERY_TOUCH = """
import os, shutil, signal, sys
from itertools import count
import voxrt.building.pipeline
from voxrt.cli import main
number, folder = int(sys.argv[1]), os.getcwd()
touches = moment = 0
def watch(event, arguments):
    global touches
    if event in {"open", "os.rename", "os.remove", "os.mkdir", "os.chmod"} and not isinstance(arguments[0], int):
        if os.path.abspath(os.fsdecode(arguments[0])).startswith(folder):
            touches += 1
            if touches == moment:
                signal.raise_signal(number)
def build(depth):
    child = os.fork()
    if not child:
        os.dup2(os.open("errors", os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 2)
        sys.argv = ["voxrt", "build", "house.obj", "-o", "out", "--depth", str(depth)]
        sys.argv += ["--preview", "--size", "16x12", "--engine", "model"]
        sys.addaudithook(watch)
        try:
            main()
        except SystemExit as end:
            os._exit(end.code)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
for depth in (4, 3):
    assert build(depth) == 0
    shutil.copytree("out", f"depth-{depth}")
for moment in count(1):
    code = build(4)
    shutil.move("out", f"moment-{moment}")
    shutil.move("errors", f"moment-{moment}.errors")
    if code == 0:
        break
    assert code == 128 + number, code
    shutil.copytree("depth-3", "out")
"""

# Sends itself a signal while the model renders.
IN_NATIVE_CODE = """
import os, signal, sys, threading
from voxrt.sim import _model
class Memory(_model.Memory):
    def render(self, *arguments, **options):
        threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT)).start()
        return super().render(*arguments, **options)
_model.Memory = Memory
from voxrt.cli import main
main()
"""


def run(folder, code, *arguments):
    command = [sys.executable, "-c", code, *map(str, arguments)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=300)


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_at_every_touch_of_a_file(folder, number):
    finished = run(folder, AT_EVERY_TOUCH, int(number))
    assert finished.returncode == 0, finished.stderr
    states = {depth: files(folder / f"depth-{depth}") for depth in (3, 4)}
    *interrupted, complete = sorted(folder.glob("moment-*[0-9]"), key=lambda path: int(path.name.split("-")[1]))
    assert len(interrupted) >= 6
    found = set()
    for moment in interrupted:
        assert (folder / f"{moment.name}.errors").read_text().count("\n") == 1
        now = files(moment)
        assert set(now) == set(states[3])
        assert now["house.preview.png"] in {states[3]["house.preview.png"], states[4]["house.preview.png"]}
        rom, warnings = library.read_rom(moment / "house.mem")
        assert warnings == ()
        assert now["house.mem"] == states[rom.octree.depth]["house.mem"]
        assert json.loads(now["house.json"])["depth"] == rom.octree.depth
        found.add(rom.octree.depth)
    assert found == {3, 4}
    assert files(complete)["house.preview.png"] == states[4]["house.preview.png"]


def test_in_native_code(folder):
    library.build(folder / "house.obj", folder, depth=6)
    finished = run(folder, IN_NATIVE_CODE, "render", "house.mem", "--engine", "model", "--size", "8000x8000")
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


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_stdout_is_full(folder):
    command = [sys.executable, "-m", "voxrt", "build", "house.obj", "--depth", "3", "--json"]
    with Path("/dev/full").open("w") as full:
        finished = subprocess.run(command, cwd=folder, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert finished.returncode == 2
    assert finished.stderr == "voxrt: error: standard output: No space left on device\n"
