"""Which camera pictures are taken with: the author's first, a named one, or one that sees the whole scene."""

from __future__ import annotations

import numpy as np
import pytest
from oracles.gltf_writer import GltfWriter

import voxrt
from voxrt import octree
from voxrt.sim import render as render_frame
from voxrt.views.viewpoint import authored_camera, stands_inside
from voxrt.voxelize import EMPTY, Material, Scene, SceneObject, Viewpoint
from voxrt.voxelize.formats.gltf import load_gltf

SIZE = (64, 48)
CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
TRIANGLES = [face for a, b, c, d in QUADS for face in ((a, b, c), (a, c, d))]
LEFT = Viewpoint((-3, 2, 4), (0.5, 0.5, 0.5), 40, name="left")
RIGHT = Viewpoint((5, 1, 3), (0.5, 0.5, 0.5), 30, name="right")
INSIDE = Viewpoint((0.5, 0.5, 0.5), (0.5, 0.5, 9.0), name="inside")


def cube(*cameras):
    mesh = voxrt.mesh_scene(CORNERS, TRIANGLES).objects[0].mesh
    materials = (EMPTY, Material("stone", (150, 150, 160)))
    first = cameras[0] if cameras else None
    return Scene("cube", (SceneObject("cube", mesh),), materials, viewpoint=first, cameras=cameras)


def preview(*cameras, **options):
    return voxrt.build(cube(*cameras), depth=4, preview=True, size=SIZE, samples=1, background="dark", **options)


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(("camera", "expected"), [(None, LEFT), ("left", LEFT), ("right", RIGHT), ("1", RIGHT)])
def test_the_first_camera_or_the_named_one(camera, expected):
    built = preview(LEFT, RIGHT, camera=camera)
    assert built.preview.camera == authored_camera(expected, built.rom.grid, SIZE)
    assert built.view == authored_camera(expected, built.rom.grid, (640, 480))
    frame = render_frame(built.rom, built.preview.camera, SIZE, engine="model")
    np.testing.assert_array_equal(built.preview.frame.colour, frame.colour)


def test_without_cameras_the_whole_scene_is_shown():
    built = preview()
    assert built.view is None
    assert built.preview.camera == voxrt.aim_camera(built.rom, SIZE)


@pytest.mark.parametrize(
    ("cameras", "message"),
    [((LEFT, RIGHT), "there is no camera 'top': there are left, right; name one of these"), ((), "it has none")],
)
def test_a_camera_that_is_not_there_is_refused(cameras, message):
    with pytest.raises(voxrt.AssetError, match=message):
        preview(*cameras, camera="top")


def test_a_camera_in_a_solid_shows_the_whole_scene_and_says_so():
    built = preview(INSIDE)
    assert [(one.kind, "inside a solid" in one.message) for one in built.warnings] == [("camera", True)]
    assert built.view is None
    assert built.preview.camera == voxrt.aim_camera(built.rom, SIZE)
    assert stands_inside(built.rom, authored_camera(INSIDE, built.rom.grid, SIZE))
    assert 0.2 < np.mean(built.preview.frame.material > 0) < 0.8


X, Y, Z = np.indices((32, 32, 32))
SHAPES = {
    "one voxel": (X == 9) & (Y == 20) & (Z == 3),
    "the whole world": X >= 0,
    "a plate": Y == 4,
    "a tower": (X // 4 == 3) & (Z // 4 == 3),
    "a wall": Z == 17,
    "a ball": (X - 15.5) ** 2 + (Y - 15.5) ** 2 + (Z - 15.5) ** 2 < 200,
    "a staircase": (Y <= X) & (Z < 9),
    "two corners": (X + Y + Z == 0) | (X + Y + Z == 93),
}


@pytest.mark.parametrize("size", [(640, 480), (480, 640), (300, 300)])
@pytest.mark.parametrize("shape", SHAPES)
def test_the_default_camera_leaves_a_margin_and_stands_outside(shape, size):
    materials = (EMPTY, Material("stone", (150, 150, 160)))
    rom = octree.Rom("shape", octree.from_dense(SHAPES[shape].astype(np.uint8)), materials)
    camera = voxrt.aim_camera(rom, size)
    rows, columns = np.nonzero(render_frame(rom, camera, size, engine="model").material)
    free = [
        columns.min() / size[0],
        (size[0] - 1 - columns.max()) / size[0],
        rows.min() / size[1],
        (size[1] - 1 - rows.max()) / size[1],
    ]
    assert min(free) >= 0.08
    assert min(max(free[:2]), max(free[2:])) <= 0.2
    assert not stands_inside(rom, camera)


def test_a_file_names_its_cameras(tmp_path, voxrt):
    writer = GltfWriter()
    lens = {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}
    cameras = [writer.add("cameras", lens) for _ in range(2)]
    writer.show(mesh=writer.mesh(CORNERS, np.ravel(TRIANGLES)))
    for name, camera, z in zip(("front", "near"), cameras, (6, 3), strict=True):
        writer.show(name=name, camera=camera, translation=[0.5, 0.5, z])
    writer.save(tmp_path / "cube.gltf")
    assert [camera.name for camera in load_gltf(tmp_path / "cube.gltf").cameras] == ["front", "near"]
    command = ("build", "cube.gltf", "--depth", "4", "--preview", "--no-check", "--size", "64x48")
    pictures = set()
    for options in ((), ("--camera", "near"), ("--samples", "2"), ("--background", "dark")):
        voxrt.succeeds(*command, *options)
        pictures.add((tmp_path / "cube.preview.png").read_bytes())
    assert len(pictures) == 4
    voxrt.fails(3, "there is no camera 'far': there are front, near", *command, "--camera", "far")


@pytest.mark.parametrize("engine", ["model", "rtl"])
def test_a_preview_counts_its_rows(engine):
    counted = []
    preview(LEFT, engine=engine, rendered=lambda done, total: counted.append((done, total)))
    done, totals = zip(*counted, strict=True)
    assert sorted(done) == list(done)
    assert done[-1] == SIZE[1]
    assert set(totals) == {SIZE[1]}
