"""USD files that crash usd-core, take memory or time without end, or lie: one line, and this process goes on."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from voxrt import voxelize
from voxrt.voxelize import AssetError
from voxrt.voxelize.formats import scene_message
from voxrt.voxelize.formats.reader_process.limits import Limits
from voxrt.voxelize.formats.usd import isolated
from voxrt.voxelize.formats.usd.isolated import read_isolated
from voxrt.voxelize.warning_log import WarningLog

SMALL = Limits(memory=1 << 30, most_memory=1 << 30, seconds=4)

CUBE = """#usda 1.0
(
 metersPerUnit = 1
 upAxis = "Y"
)
def Cube "cube" (prepend apiSchemas = ["PhysicsCollisionAPI"]) {
 color3f[] primvars:displayColor = [(1, 0, 0)]
}
"""

# Ten prims of ten prims of ten, by inheritance: a million.
LAUGHS = (
    "#usda 1.0\n"
    + "".join(
        f'class "c{level}" {{\n'
        + "".join(f' def "p{i}" (inherits = </c{level - 1}>) {{\n }}\n' for i in range(10))
        + "}\n"
        if level
        else 'class "c0" {\n def Cube "cube" {\n }\n}\n'
        for level in range(7)
    )
    + 'def "all" (inherits = </c6>) {\n}\n'
)


def written(tmp_path, text, name="stage.usda"):
    path = tmp_path / name
    path.write_text(text)
    return path


def test_the_parent_never_imports_usd_core(tmp_path):
    path = written(tmp_path, CUBE)
    code = f"import sys, voxrt; print(voxrt.load({str(path)!r})); assert 'pxr' not in sys.modules"
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "objects=1" in printed.stdout


def test_a_million_prims_by_inheritance_end_at_the_limit(tmp_path):
    path = written(tmp_path, LAUGHS)
    with pytest.raises(AssetError, match=r"stage\.usda: (takes more than 4 seconds|needs more memory)") as caught:
        read_isolated(path, limits=SMALL)
    assert "\n" not in str(caught.value)


def test_memory_is_limited(tmp_path):
    points = ", ".join(["(0, 0, 0)"] * 300_000)
    path = written(tmp_path, CUBE + f'def Points "p" {{\n point3f[] points = [{points}]\n}}\n')
    least = Limits(memory=150 << 20, most_memory=150 << 20, seconds=60)
    with pytest.raises(AssetError, match=r"needs more memory than a file of its size may take|crashed while") as caught:
        read_isolated(path, limits=least)
    assert "\n" not in str(caught.value)


def died(tmp_path, monkeypatch, code):
    """What reading says where the process that reads runs `code` instead."""
    (tmp_path / "broken_child.py").write_text(code)
    monkeypatch.setattr(isolated, "_CHILD", "broken_child")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    with pytest.raises(AssetError) as caught:
        read_isolated(written(tmp_path, CUBE), limits=SMALL)
    assert "\n" not in str(caught.value)
    assert str(tmp_path / "stage.usda") in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("name", ["SIGABRT", "SIGSEGV", "SIGBUS", "SIGKILL"])
def test_whatever_ends_the_child_is_one_line(tmp_path, monkeypatch, name):
    message = died(tmp_path, monkeypatch, f"import os, signal; os.kill(os.getpid(), signal.{name})")
    assert f"usd-core crashed while it read the file ({name})" in message


def test_a_child_that_waits_for_ever_is_ended(tmp_path, monkeypatch):
    message = died(
        tmp_path, monkeypatch, "import signal, time; signal.setitimer(signal.ITIMER_REAL, 0.2); time.sleep(600)"
    )
    assert "takes more than 4 seconds" in message


@pytest.mark.parametrize(
    "message",
    [
        b"",
        b"\0" * 15,
        scene_message.LENGTHS.pack(1 << 60, 0),
        scene_message.LENGTHS.pack(100, 0) + b"{}",
        scene_message.LENGTHS.pack(2, 0) + b"{}",
        scene_message.LENGTHS.pack(2, 0) + b"xx",
        scene_message.LENGTHS.pack(2, 50) + b"{}" + bytes(10),
    ],
)
def test_nonsense_from_the_child_is_one_line(tmp_path, monkeypatch, message):
    died(tmp_path, monkeypatch, f"import os; os.write(1, {message!r})")


def test_messages_that_lie_about_arrays_are_refused():
    """Every number of a message is changed in turn: what comes is a scene or a refusal."""
    scene = voxelize.Scene(
        "a",
        [
            voxelize.SceneObject(
                "o",
                voxelize.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [1]),
                colliders=(voxelize.SphereCollider([0, 0, 0], 1.0), voxelize.BoxCollider([0, 0, 0], [1, 1, 1])),
            )
        ],
        [voxelize.EMPTY, voxelize.Material("m", (1, 2, 3))],
    )
    parts = scene_message.scene_bytes(scene)
    text, arrays = bytes(parts[1]), np.frombuffer(b"".join(parts[2:]), np.uint8)
    back = scene_message.read_message(text, arrays)
    assert back.objects[0].mesh.triangles.tolist() == [[0, 1, 2]]
    assert len(back.objects[0].colliders) == 2
    for place in range(len(text)):
        if chr(text[place]).isdigit():
            for other in (b"9", b"0", b"-1", b"99999999999"):
                changed = text[:place] + other + text[place + 1 :]
                try:
                    scene_message.read_message(changed, arrays)
                except scene_message.BadMessageError:
                    continue


def test_meshes_and_textures_stay_shared(tmp_path):
    body = "".join(f'def Cube "c{i}" {{\n double3 xformOp:translate = ({i}, 0, 0)\n}}\n' for i in range(3))
    scene = voxelize.load(written(tmp_path, "#usda 1.0\n" + body))
    assert len({id(one.mesh) for one in scene.objects}) == 1


def test_damaged_binary_stages_never_end_this_process(tmp_path):
    source = written(tmp_path, CUBE)
    code = "import sys; from pxr import Sdf, Usd; Sdf.Layer.FindOrOpen(sys.argv[1]).Export(sys.argv[2])"
    crate = tmp_path / "stage.usdc"
    subprocess.run([sys.executable, "-c", code, source, crate], check=True)
    data = crate.read_bytes()
    random = np.random.default_rng(1)
    for _ in range(6):
        damaged = bytearray(data)
        for place in random.integers(0, len(data), 2):
            damaged[place] = random.integers(0, 256)
        crate.write_bytes(damaged)
        try:
            read_isolated(crate, limits=SMALL)
        except AssetError as error:
            assert "\n" not in str(error)  # noqa: PT017


def test_a_child_of_a_child_reads(tmp_path):
    path = written(tmp_path, CUBE)
    code = f"""
import multiprocessing
from voxrt import voxelize
def read(): assert len(voxelize.load({str(path)!r}).objects) == 1
if __name__ == "__main__":
    inner = multiprocessing.get_context("spawn").Process(target=read)
    inner.start(); inner.join(); raise SystemExit(inner.exitcode)
"""
    script = tmp_path / "outer.py"
    script.write_text(code)
    subprocess.run([sys.executable, script], check=True)


def test_a_thread_reads(tmp_path):
    path = written(tmp_path, CUBE)
    found = []
    reader = threading.Thread(target=lambda: found.append(voxelize.load(path)))
    reader.start()
    reader.join()
    assert len(found[0].objects) == 1


@pytest.mark.skipif(sys.platform != "linux", reason="looks for processes in /proc")
def test_ctrl_c_ends_the_child_and_leaves_nothing(tmp_path):
    """The command is interrupted while its child reads a file that takes long; both are gone, and so is the folder."""
    path = written(tmp_path, LAUGHS)
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    command = subprocess.Popen(
        [sys.executable, "-m", "voxrt", "build", path, "-o", tmp_path / "out"],
        env=os.environ | {"TMPDIR": str(temporary)},
        stderr=subprocess.PIPE,
        start_new_session=True,
    )

    def children():
        tasks = Path(f"/proc/{command.pid}/task").glob("*/children")
        return [pid for task in tasks for pid in task.read_text(encoding="ascii").split()]

    end = time.monotonic() + 60
    while not (found := children()) and time.monotonic() < end:
        time.sleep(0.02)
    os.kill(command.pid, signal.SIGINT)
    command.communicate(timeout=60)
    assert command.returncode == 130
    assert found
    # Interrupted while it starts, the child sees for itself that its parent is gone.
    end = time.monotonic() + 60
    while (left := [pid for pid in found if Path("/proc", pid).exists()]) and time.monotonic() < end:
        time.sleep(0.02)
    assert not left
    assert not list(temporary.iterdir())


def test_a_value_without_a_type_in_python_is_one_line(tmp_path):
    pytest.importorskip("pxr.Usd")
    from voxrt.voxelize.formats.usd.diagnostics import caught

    unknown = "No to_python (by-value) converter found for C++ type: std::vector<SdfLayerOffset>"
    belongs = "a value of a type that does not belong there"
    with pytest.raises(AssetError, match=belongs), caught(tmp_path / "a.usdc", WarningLog()):
        raise TypeError(unknown)
    with pytest.raises(TypeError, match="ours"), caught(tmp_path / "a.usdc", WarningLog()):
        raise TypeError("ours")
