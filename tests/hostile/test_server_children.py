"""Children of the server that do not end by themselves: each gets an answer, and none stays."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from fakes.serving import until

from voxrt.board.errors import Refused
from voxrt.serve import scene_process
from voxrt.serve.scene_process import ChildReader

STAGE = rb'{"type": "Stage", "stage": "read", "done": 0, "total": 1}\n'
SCENE = (
    rb'{"type": "Described", "name": "a", "depth": 1, "words": 1000000, "camera": null, "lighting": null,'
    rb' "roots": [0], "period": null, "warnings": [], "names": []}\n'
)
LATE = "takes more than 2 s to build"
NONSENSE = "it sent what is no scene"

CHILDREN = {
    "writes without end": ("while True: os.write(1, b'x' * 65536)", NONSENSE),
    "writes a long line": ("os.write(1, b'x' * (1 << 20)); time.sleep(600)", NONSENSE),
    "reports without end": (f"while True: os.write(1, b'{STAGE.decode()}')", LATE),
    "says nothing": ("time.sleep(600)", LATE),
    "stops": ("os.kill(os.getpid(), signal.SIGSTOP)", LATE),
    "stops within its scene": (f"os.write(1, b'{SCENE.decode()}' + bytes(5000)); time.sleep(600)", LATE),
    "closes its output": ("os.close(1); time.sleep(600)", "it closed its output and went on"),
    "leaves its output to a child": ("if os.fork(): os._exit(0)\ntime.sleep(600)", LATE),
    "is deaf": ("for one in (1, 2, 13, 15): signal.signal(one, signal.SIG_IGN)\ntime.sleep(600)", LATE),
    "ends": ("pass", "exit code 0"),
}


def reader(code, seconds=2.0):
    note = "open(os.path.join(sys.argv[1], str(os.getpid())), 'w').close()"
    return ChildReader((".x",), ("-c", f"import os, signal, sys, time\n{note}\n{code}"), seconds)


async def none_left(folder):
    """Wait until no process is left of those that left a note."""
    pids = [path.name for path in folder.iterdir()]
    assert pids
    await until(lambda: not any(alive(pid) for pid in pids))


def alive(pid):
    try:
        return Path("/proc", pid, "stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


pytestmark = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="looks at processes by /proc")


@pytest.mark.parametrize("kind", CHILDREN)
async def test_every_child_gets_an_answer(tmp_path, monkeypatch, kind):
    code, problem = CHILDREN[kind]
    monkeypatch.setattr(scene_process, "_END_SECONDS", 1.0)
    with pytest.raises(Refused, match=problem):
        await reader(code).read([tmp_path], lambda *_: None)
    await none_left(tmp_path)


@pytest.mark.parametrize("kind", [kind for kind in CHILDREN if CHILDREN[kind][1] == LATE])
async def test_every_child_can_be_cancelled(tmp_path, kind):
    reading = asyncio.ensure_future(reader(CHILDREN[kind][0], 600.0).read([tmp_path], lambda *_: None))
    await until(lambda: list(tmp_path.iterdir()))
    reading.cancel()
    with pytest.raises(asyncio.CancelledError):
        await reading
    await none_left(tmp_path)
