"""Streams that are closed or full, names that are no text, a screen that is not there: no exit code 1, no traceback."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ODD = b"h\xff\xfeuse"


def shell(folder: Path, line: str, **variables: str) -> subprocess.CompletedProcess[bytes]:
    environment = {**os.environ, **variables, "PYTHON": sys.executable}
    line = line.replace("voxrt", '"$PYTHON" -m voxrt')
    return subprocess.run(["sh", "-c", line], cwd=folder, env=environment, capture_output=True, check=False)


@pytest.mark.parametrize(
    ("line", "code"),
    [
        ("voxrt build house.obj --depth 3 <&- >&- 2>&-", 0),
        ("voxrt build house.obj --depth 3 2>/dev/full", 0),
        ("voxrt info house.obj --depth 3 >&-", 2),
        ("voxrt info house.obj --depth 3 >&- 2>&-", 2),
        ("voxrt build house.obj --depth 3 --json >/dev/full", 2),
        ("voxrt --help >&-", 2),
        ("voxrt --version >/dev/full", 2),
        ("voxrt build nothing.obj 2>&-", 3),
    ],
)
def test_streams(folder, line, code):
    finished = shell(folder, line)
    assert finished.returncode == code, finished.stderr
    assert b"Traceback" not in finished.stderr
    assert b"Exception ignored" not in finished.stderr
    built = (folder / "house.mem").exists()
    assert built == ("build house.obj" in line)
    if built:  # nothing of a closed stream went into a file that took its number
        assert (folder / "house.mem").stat().st_size % 9 == 0


@pytest.mark.skipif(sys.platform == "darwin", reason="file names are UTF-8 there")
def test_names_that_are_no_text(voxrt):
    odd = os.fsdecode(ODD)
    shutil.copy("house.obj", f"{odd}.obj")
    lines = [
        ("build", f"{odd}.obj", "--depth", "3", "-o", f"{odd}-out", "--json"),
        ("build", f"{odd}.obj", "--depth", "3", "-o", f"{odd}.mem"),
        ("info", f"{odd}.mem", "--json"),
        ("info", f"{odd}.mem"),
        ("render", f"{odd}.mem", "--engine", "model", "--size", "32"),
        ("trace", f"{odd}.mem", "--pixel", "1,1"),
        ("diff", f"{odd}.mem", f"{odd}.obj"),
        *(
            ("convert", f"{odd}.mem", f"{odd}-2{suffix}")
            for suffix in (".coe", ".blob", ".glb", ".html", ".npz", ".vox")
        ),
        ("info", f"{odd}-2.vox", "--json"),
        ("view", f"{odd}.mem", "-o", f"{odd}.html"),
        ("upload", f"{odd}.mem", "--device", "model"),
    ]
    for line in lines:
        voxrt.succeeds(*line)
    Path(f"{odd}.json").unlink()
    assert voxrt("info", f"{odd}.mem", "--json").code == 0
    assert voxrt("build", f"{odd}-nothing.obj").code == 3
    assert {f"{odd}.mem", f"{odd}.png", f"{odd}-2.coe", f"{odd}-2.json"} <= {path.name for path in Path().iterdir()}


@pytest.mark.skipif(sys.platform == "darwin", reason="file names are UTF-8 there")
def test_a_locale_without_umlauts(folder):
    shutil.copy(folder / "house.obj", folder / "häuser.obj")
    line = "voxrt info h*user.obj --depth 3"
    finished = shell(folder, line, LC_ALL="POSIX", PYTHONUTF8="0", PYTHONCOERCECLOCALE="0", PYTHONIOENCODING="ascii")
    assert finished.returncode == 0, finished.stderr
    assert finished.stdout.isascii()


@pytest.mark.parametrize("display", ["", ":987"])
def test_a_window_without_a_screen(folder, display):
    pytest.importorskip("pyvista", reason="PyVista is not installed")
    finished = shell(folder, "voxrt view house.obj --depth 3", DISPLAY=display, WAYLAND_DISPLAY="")
    assert finished.returncode == 5
    assert finished.stderr.startswith(b"voxrt: error: there is no screen to open a window on")
    assert finished.stderr.count(b"\n") == 1
