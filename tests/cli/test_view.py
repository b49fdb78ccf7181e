"""``voxrt view``: the octants of a memory or an asset."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from PIL import Image

from voxrt import read_any, read_rom
from voxrt.octree import to_dense
from voxrt.view import ViewerError, octants
from voxrt.view.plotter import check_screen

SMALL = ("--size", "96x72")


@pytest.fixture
def pyvista():
    return pytest.importorskip("pyvista", reason="PyVista is not installed")


@pytest.fixture
def _canvas():
    pytest.importorskip("pyvista", reason="PyVista is not installed")
    try:
        check_screen(off_screen=True)
    except ViewerError as problem:
        pytest.skip(str(problem))


@pytest.mark.usefixtures("_canvas")
def test_pictures_and_files(voxrt, built, pyvista):
    for scene in (("house.mem",), ("house.obj", "--depth", "5")):
        finished = voxrt.succeeds("view", *scene, "--screenshot", "o.png", "-o", "o.vtu", *SMALL)
        assert "hidden" in finished.err
        with Image.open(built / "o.png") as picture:
            assert picture.size == (96, 72)
        grid = pyvista.read(built / "o.vtu")
        assert f"{grid.n_cells:,} octants" in finished.err
    for option in (("--clip", "z"), ("--level-limit", "2"), ("--slice", "x=9", "--slice", "z=20")):
        assert voxrt("view", "house.mem", *option, "-o", "less.vtu").code == 0
        less = pyvista.read(built / "less.vtu")
        assert 0 < less.n_cells < grid.n_cells
    assert (less.bounds[1], less.bounds[5]) == (9, 20)
    assert sorted(file.name for file in built.glob("*.vtu")) == ["less.vtu", "o.vtu"]


@pytest.mark.usefixtures("_canvas")
def test_pictures_of_everything(voxrt, built):
    pictures = {}
    for name, arguments in {
        "plain": ("house.obj", "--depth", "5"),
        "mesh": ("house.obj", "--depth", "5", "--overlay"),
        "owners": ("house.obj", "--depth", "5", "--by", "owner"),
        "ray": ("house.mem", "--ray", "320,240"),
        "pair": ("house.mem", "dog.usda"),
    }.items():
        voxrt.succeeds("view", *arguments, "--screenshot", f"{name}.png", *SMALL)
        with Image.open(built / f"{name}.png") as picture:
            pictures[name] = np.asarray(picture.convert("RGB"))
    for name, picture in pictures.items():
        assert name == "plain" or (picture != pictures["plain"]).any()


@pytest.mark.usefixtures("_canvas")
@pytest.mark.parametrize("suffix", ["gif", "mp4"])
def test_turntables(voxrt, built, suffix, monkeypatch):
    ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="it writes MP4") if suffix == "mp4" else None
    monkeypatch.setattr("voxrt.cli.commands.view._TURNS", 6)
    voxrt.succeeds("view", "house.mem", "--turntable", f"t.{suffix}", *SMALL)
    if ffmpeg is None:
        with Image.open(built / "t.gif") as animation:
            assert (animation.size, animation.n_frames, animation.info["loop"]) == ((96, 72), 6, 0)
    else:
        assert ffmpeg.count_frames_and_secs(str(built / "t.mp4"))[0] == 6


@pytest.mark.usefixtures("pyvista")
def test_other_programs_files(voxrt, built):
    for suffix in ("glb", "vox", "html"):
        voxrt.succeeds("view", "house.mem", "-o", f"new/o.{suffix}")
        assert (built / f"new/o.{suffix}").stat().st_size > 1000
    rom, again = read_rom(built / "house.mem")[0], read_any(built / "new/o.vox")[0].rom
    assert {m.colour for m in again.materials[1:]} <= {m.colour for m in rom.materials}
    assert np.count_nonzero(to_dense(again.octree)) == np.count_nonzero(to_dense(rom.octree))


def test_pyvista_reads_memories(built, pyvista):
    if not hasattr(pyvista, "register_reader"):
        pytest.skip("this PyVista has no plug-in readers")
    grid = pyvista.read(built / "house.mem")
    assert grid == octants(read_rom(built / "house.mem")[0])


@pytest.mark.usefixtures("pyvista")
@pytest.mark.parametrize(
    ("arguments", "code", "problem"),
    [
        (("nothing.mem",), 3, "nothing.mem"),
        (("house.obj", "--screenshot", "o.jpg"), 2, "ends in .png"),
        (("house.obj", "-o", "o.stl"), 2, "end in .vox, .npz, .ply, .glb, .vtu, .html"),
        (("house.obj", "-o", "house.mtl/o.vtu"), 2, "is a file, not a folder"),
        (("house.obj", "--turntable", "o.avi"), 2, "end in .gif or .webp or .mp4"),
        (("house.obj", "--level-limit", "17"), 2, "--level-limit must be an integer 0 … 16, not 17"),
        (("house.obj", "--slice", "x:3"), 2, "'x:3' is not AXIS=VOXEL"),
        (("house.obj", "--slice", "x=0"), 2, "'x=0' is not AXIS=VOXEL"),
        (("house.obj", "--slice", "x=3", "--clip", "x"), 2, "--clip and --slice exclude each other"),
        (("house.obj", "dog.usda", "--ray", "1,2"), 2, "--ray and a second scene exclude each other"),
        (("house.obj", "--ray", "1,2", "-o", "o.glb"), 2, "--output and --ray exclude each other"),
        (("house.obj", "--ray", "640,2"), 2, "pixel 640,2 lies outside the picture of 640x480"),
    ],
)
def test_errors(voxrt, arguments, code, problem):
    voxrt.fails(code, problem, "view", *arguments)


@pytest.mark.parametrize(("option", "missing"), [(("--by", "owner"), "owners"), (("--overlay",), "triangles")])
@pytest.mark.usefixtures("built")
def test_what_memories_do_not_know(voxrt, option, missing):
    voxrt.fails(
        2,
        f"house: a memory knows no {missing}; name the asset instead",
        "view",
        "house.mem",
        *option,
        "--screenshot",
        "o.png",
    )


def test_no_screen(voxrt, monkeypatch, pyvista):
    monkeypatch.setattr(pyvista, "system_supports_plotting", lambda: False)
    voxrt.fails(5, "voxrt: error: there is no screen", "view", "house.obj", "--depth", "4")


@pytest.mark.parametrize("suffix", ["vox", "npz", "ply", "glb", "html"])
def test_files_that_need_no_pyvista(voxrt, built, monkeypatch, suffix):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    voxrt.succeeds("view", "house.mem", "-o", f"o.{suffix}", "--slice", "x=8")
    assert (built / f"o.{suffix}").stat().st_size > 1000


@pytest.mark.parametrize("wanted", [("--screenshot", "o.png"), ("-o", "o.vtu"), ("--turntable", "o.gif")])
def test_without_pyvista(voxrt, monkeypatch, wanted):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    voxrt.fails(5, "pip install pyvista", "view", "house.obj", "--depth", "4", *wanted)
