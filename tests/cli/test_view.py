"""``voxrt view``: the octants of a memory or an asset."""

from __future__ import annotations

import sys

import pytest
from PIL import Image

from voxrt.octree import octants


@pytest.fixture
def pyvista():
    return pytest.importorskip("pyvista", reason="the extra voxrt[view] is not installed")


def test_pictures_and_files(voxrt, folder, pyvista):
    assert voxrt("build", "house.obj", "--depth", "5").code == 0
    for scene in (("house.mem",), ("house.obj", "--depth", "5")):
        finished = voxrt("view", *scene, "--screenshot", "o.png", "--export", "o.vtu", "--size", "96x72")
        assert finished.code == 0, finished.err
        assert "hidden" in finished.err
        with Image.open(folder / "o.png") as picture:
            assert picture.size == (96, 72)
        grid = pyvista.read(folder / "o.vtu")
        assert f"{grid.n_cells:,} octants" in finished.err
    for option in (("--clip", "z"), ("--level-limit", "2")):
        assert voxrt("view", "house.mem", *option, "--export", "less.vtu").code == 0
        assert 0 < pyvista.read(folder / "less.vtu").n_cells < grid.n_cells
    assert sorted(file.name for file in folder.glob("*.vtu")) == ["less.vtu", "o.vtu"]


def test_pyvista_reads_memories(voxrt, folder, pyvista):
    if not hasattr(pyvista, "register_reader"):
        pytest.skip("this PyVista has no plug-in readers")
    from voxrt import read_rom

    assert voxrt("build", "house.obj", "--depth", "5").code == 0
    grid = pyvista.read(folder / "house.mem")
    assert grid == octants(read_rom(folder / "house.mem")[0])


@pytest.mark.usefixtures("pyvista")
@pytest.mark.parametrize(
    ("arguments", "code", "problem"),
    [
        (("nothing.mem",), 3, "nothing.mem"),
        (("house.obj", "--screenshot", "o.jpg"), 2, "ends in .png"),
        (("house.obj", "--export", "o.stl"), 2, "ends in .vtu"),
        (("house.obj", "--export", "house.mtl/o.vtu"), 2, "is a file, not a folder"),
        (("house.obj", "--level-limit", "17"), 2, "17 is not 0 to 16"),
    ],
)
def test_errors(voxrt, arguments, code, problem):
    finished = voxrt("view", *arguments)
    assert finished.code == code
    assert problem in finished.error


def test_no_screen(voxrt, monkeypatch, pyvista):
    monkeypatch.setattr(pyvista, "system_supports_plotting", lambda: False)
    finished = voxrt("view", "house.obj", "--depth", "4")
    assert finished.code == 5
    assert "voxrt: error: there is no screen" in finished.err


def test_without_pyvista(voxrt, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    finished = voxrt("view", "house.obj", "--depth", "4", "--screenshot", "o.png")
    assert finished.code == 5
    assert "pip install 'voxrt[view]'" in finished.error
