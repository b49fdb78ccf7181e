"""Whoever interrupts or kills a command finds whole sets of files, the old or the new, and nothing left over."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import voxrt

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
INTERRUPTIONS = int(os.environ.get("VOXRT_INTERRUPTIONS", "10"))
"""Per command. With 60 they are 240 in all."""

# Runs a command again and again in children of its own, over the same old files, and signals the n-th child at some
# moment between its start and its end: at some event that Python audits. Prints the exit codes.
DRIVER = """
import json, os, shutil, signal, sys
from voxrt.cli.start import start
from voxrt.cli.commands import build, convert, edit, upload, view
import voxrt.boards.board_scenes, voxrt.cli.run
import PIL.PngImagePlugin, trimesh, voxrt.export.blob, voxrt.board.simulated.model, voxrt.board.scene_memory
arguments, count, signals = json.loads(sys.argv[1])
events = moment = number = 0
def watch(event, _arguments):
    global events
    if os.getpid() == child_of_interest:
        events += 1
        if events == moment:
            os.kill(os.getpid(), number)
def run():
    global child_of_interest
    reader, writer = os.pipe()
    child = os.fork()
    if child:
        os.close(writer)
        seen = os.read(reader, 20)
        os.close(reader)
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), int(seen or 0)
    child_of_interest = os.getpid()
    os.dup2(os.open("errors", os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 2)
    sys.addaudithook(watch)
    try:
        start(arguments)
    except SystemExit as end:
        os.write(writer, b"%d" % events)
        os._exit(end.code)
code, total = run()
assert code == 0, code
shutil.move("work", "new")
codes = []
for turn in range(count):
    shutil.copytree("old", "work")
    number = signals[turn % len(signals)]
    moment = 1 + total * turn // count
    codes.append((run()[0], number))
    shutil.move("work", f"work-{turn}")
    shutil.copy("errors", f"errors-{turn}")
print(json.dumps(codes))
"""

COMMANDS = {
    "build": ["build", "house.obj", "-o", "work", "--depth", "4", "--preview", "--size", "32x24", "--engine", "model"],
    "convert": ["convert", "new4.mem", "work/house.mem"],
    "edit": ["edit", "work/house.mem", "--script", "edits.jsonl", "-o", "work/house.mem"],
    "view": ["view", "new4.mem", "-o", "work/house.html"],
    "upload": ["upload", "new4.mem", "--device", "model"],
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("house.obj", "house.mtl"):
        shutil.copy(EXAMPLES / name, tmp_path)
    old = voxrt.build(tmp_path / "house.obj", tmp_path / "old", depth=3, preview=True, size=(32, 24), engine="model")
    voxrt.convert(old.rom, tmp_path / "old" / "house.html")
    (tmp_path / "old" / "tmp").mkdir()
    shutil.copytree(tmp_path / "old", tmp_path / "work")
    voxrt.build(tmp_path / "house.obj", tmp_path / "new4.mem", depth=4)
    edit = {"op": "fill", "box": {"low": [0, 0, 0], "high": [4, 4, 4]}, "material": 0}
    (tmp_path / "edits.jsonl").write_text(json.dumps(edit))
    return tmp_path


def contents(folder: Path) -> dict[str, object]:
    """The files of a folder; the manifest without its times."""
    found: dict[str, object] = {}
    for path in sorted(folder.rglob("*")):
        data: object = path.read_bytes() if path.is_file() else None
        if path.suffix == ".json":
            data = {key: value for key, value in json.loads(path.read_bytes()).items() if key != "seconds"}
        found[str(path.relative_to(folder))] = data
    return found


def drive(folder: Path, command: str, signals: list[int]) -> list[list[int]]:
    task = json.dumps([COMMANDS[command], INTERRUPTIONS, signals])
    finished = subprocess.run(
        [sys.executable, "-c", DRIVER, task],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(folder / "work" / "tmp")},
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )
    assert finished.returncode == 0, finished.stderr
    codes: list[list[int]] = json.loads(finished.stdout)
    return codes


@pytest.mark.parametrize("command", COMMANDS)
def test_interrupted_anywhere(folder, command):
    codes = drive(folder, command, [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
    old, new = contents(folder / "old"), contents(folder / "new")
    assert old.keys() == new.keys()
    assert command == "upload" or old != new
    for turn, (code, number) in enumerate(codes):
        errors = (folder / f"errors-{turn}").read_text()
        assert code in {0, 128 + number}, (turn, errors)
        if code:
            assert errors.count("\n") == 1, errors
            assert errors.startswith("voxrt: error: "), errors
        assert contents(folder / f"work-{turn}") in ([new] if code == 0 else [old, new])


@pytest.mark.parametrize("command", ["build", "convert", "edit"])
def test_killed_anywhere(folder, command):
    codes = drive(folder, command, [signal.SIGKILL])
    old, new = contents(folder / "old"), contents(folder / "new")
    for turn, (code, _number) in enumerate(codes):
        work = folder / f"work-{turn}"
        rom, assumed = voxrt.read_rom(work / "house.mem")
        assert assumed == ()
        assert (work / "house.mem").read_bytes() in (old["house.mem"], new["house.mem"])
        assert rom.octree.depth in {3, 4}
        assert code in {0, -signal.SIGKILL}
        if contents(work).keys() != old.keys():  # the next writer tidies up
            voxrt.build(folder / "house.obj", work, depth=4, preview=True, size=(32, 24), engine="model")
            assert contents(work).keys() == old.keys()


# Edits a memory in place again and again; the kernel kills the n-th child where it writes byte n of a file.
WRITES = """
import json, os, resource, shutil, signal, sys
from voxrt.cli.start import start
from voxrt.cli.commands import edit
arguments, limits = json.loads(sys.argv[1])
shutil.rmtree("work")
codes = []
for turn, limit in enumerate(limits):
    shutil.copytree("old", "work")
    child = os.fork()
    if not child:
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
        signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
        try:
            start(arguments)
        except SystemExit as end:
            os._exit(end.code or 0)
    codes.append(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
    shutil.move("work", f"work-{turn}")
print(json.dumps(codes))
"""


def test_killed_at_any_byte_of_an_edited_memory(folder):
    sizes = [(folder / "old" / name).stat().st_size for name in ("house.mem", "house.json")]
    limits = [0, 1, *range(50, max(sizes), max(sizes) // 10), max(sizes) - 1, 10 * max(sizes)]
    finished = subprocess.run(
        [sys.executable, "-c", WRITES, json.dumps([COMMANDS["edit"], limits])],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(folder)},
        capture_output=True,
        text=True,
        check=False,
        timeout=600,
    )
    assert finished.returncode == 0, finished.stderr
    codes = json.loads(finished.stdout)
    assert codes[-1] == 0
    old, new = contents(folder / "old"), contents(folder / f"work-{len(limits) - 1}")
    killed = 0
    for turn, code in enumerate(codes[:-1]):
        assert code in {0, -signal.SIGXFSZ}
        killed += code != 0
        found = contents(folder / f"work-{turn}")
        kept = {name: data for name, data in found.items() if name in old}
        assert kept == (new if code == 0 else old)
        assert voxrt.read_rom(folder / f"work-{turn}" / "house.mem")[1] == ()
    assert killed > 5


# Signals itself at every n-th module that is imported, in children of its own. Prints how each ended.
IMPORTS = """
import json, os, signal, sys
from voxrt.cli.start import start
step, imports, results = int(sys.argv[1]), 0, []
def watch(event, _arguments):
    global imports
    if event == "import":
        imports += 1
        if imports == moment:
            os.kill(os.getpid(), signal.SIGINT)
moment = 1
while True:
    imports = 0
    child = os.fork()
    if not child:
        os.dup2(os.open("errors", os.O_WRONLY | os.O_CREAT | os.O_TRUNC), 2)
        sys.addaudithook(watch)
        try:
            start(["build", "house.obj", "--depth", "3"])
        except SystemExit as end:
            os._exit(end.code)
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    with open("errors") as file:
        results.append([code, file.read()])
    if code != 130:
        break
    moment += step
print(json.dumps(results))
"""


def test_interrupted_while_modules_are_imported(folder):
    finished = subprocess.run(
        [sys.executable, "-c", IMPORTS, "30"], cwd=folder, capture_output=True, text=True, check=True, timeout=600
    )
    *interrupted, (last, _) = json.loads(finished.stdout)
    assert last == 0
    assert len(interrupted) >= 5
    for code, errors in interrupted:
        assert (code, errors) == (130, "voxrt: error: interrupted: every file is as it was, or complete\n")


def test_a_signal_that_is_ignored_stays_ignored(folder):
    code = (
        "import os, signal, sys\nsignal.signal(signal.SIGINT, signal.SIG_IGN)\nfrom voxrt.cli import main\n"
        "import voxrt.export.rom_files as files\nwrite = files.write_together\n"
        "def signalled(these):\n    os.kill(os.getpid(), signal.SIGINT)\n    write(these)\n"
        "files.write_together = signalled\nmain()"
    )
    command = [sys.executable, "-c", code, "build", "house.obj", "--depth", "3", "-o", "ignored"]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)
    assert (folder / "ignored" / "house.mem").is_file()
