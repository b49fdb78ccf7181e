"""Honest files that were read wrongly or without a word, and files that are empty where it matters."""

from __future__ import annotations

import base64
import json
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import voxrt
from voxrt import voxelize
from voxrt.voxelize import AssetError, DoesNotFitError
from voxrt.voxelize.colour.appearance import sample
from voxrt.voxelize.formats.gltf.meshopt import CompressedView, decode

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def written(tmp_path, text, name):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def ply(properties="", vertices=("0 0 0", "1 0 0", "0 1 0"), face="3 0 1 2", comments="", of_face=""):
    return (
        f"ply\nformat ascii 1.0\n{comments}element vertex {len(vertices)}\nproperty float x\nproperty float y\n"
        f"property float z\n{properties}element face 1\nproperty list uchar int vertex_indices\n{of_face}end_header\n"
        + "".join(f"{one}\n" for one in vertices)
        + f"{face}\n"
    )


@pytest.fixture
def picture(tmp_path):
    """Red above, green below."""
    Image.fromarray(np.array([[[255, 0, 0]], [[0, 255, 0]]], np.uint8)).save(tmp_path / "paint.png")
    return "comment TextureFile paint.png\n"


@pytest.mark.parametrize("names", [("s", "t"), ("u", "v"), ("texture_u", "texture_v")])
def test_ply_texture_of_vertices(tmp_path, picture, names):
    text = ply(
        "".join(f"property float {name}\n" for name in names),
        ("0 0 0 0.5 0.75", "1 0 0 0.5 0.75", "0 1 0 0.5 0.75"),
        comments=picture,
    )
    scene = voxelize.load(written(tmp_path, text, "a.ply"))
    surface = scene.objects[0].mesh.appearance
    assert sample(surface, np.array([0]), np.full((1, 3), 1 / 3))[0].tolist() == [1, 0, 0, 1]
    assert not scene.warnings


def test_ply_texture_of_corners(tmp_path, picture):
    text = ply(
        comments=picture, of_face="property list uchar float texcoord\n", face="3 0 1 2 6 0.5 0.25 0.5 0.25 0.5 0.25"
    )
    surface = voxelize.load(written(tmp_path, text, "a.ply")).objects[0].mesh.appearance
    assert sample(surface, np.array([0]), np.full((1, 3), 1 / 3))[0].tolist() == [0, 1, 0, 1]


def test_ply_texture_without_coordinates_or_file_is_counted(tmp_path, picture):
    scene = voxelize.load(written(tmp_path, ply(comments=picture), "a.ply"))
    assert any("no texture coordinates" in one.message for one in scene.warnings)
    scene = voxelize.load(written(tmp_path, ply(comments="comment TextureFile none.png\n"), "b.ply"))
    assert any("'none.png' was not found" in one.message for one in scene.warnings)


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_ply_line_ends(tmp_path, newline):
    path = tmp_path / "a.ply"
    path.write_bytes(ply().replace("\n", newline).encode())
    assert len(voxelize.load(path).objects[0].mesh.triangles) == 1


def test_binary_ply_with_cr_header(tmp_path):
    header = ply().partition("end_header\n")[0].replace("ascii", "binary_little_endian") + "end_header\n"
    body = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<B3i", 3, 0, 1, 2)
    path = written(tmp_path, header.replace("\n", "\r").encode() + body, "a.ply")
    assert voxelize.load(path).objects[0].mesh.positions.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def test_stl_header_colour_with_attributes_of_0(tmp_path):
    data = b"COLOR=\x10\x80\xf0\xff".ljust(80) + struct.pack("<I12fH", 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    scene = voxelize.load(written(tmp_path, data, "a.stl"))
    built = voxrt.build(scene, depth=2)
    assert built.rom.materials[1].colour == (16, 128, 240)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.obj", "v 0 0 0\nv 1e308 0 0\nv 0 1e308 0\nv 1e308 1e308 0\nf 1 2 4 3\n"),
        ("a.ply", ply(vertices=("0 0 0", "1e308 0 0", "0 -1e308 0")).replace("float", "double")),
        ("a.stl", "solid a\nfacet\nvertex 0 0 0\nvertex 1e308 0 0\nvertex 0 1e308 0\nendfacet\nendsolid a\n"),
    ],
)
@pytest.mark.filterwarnings("error")
def test_coordinates_that_overflow_are_refused_with_the_files_name(tmp_path, name, text):
    path = written(tmp_path, text, name)
    with pytest.raises(AssetError, match=r"number") as caught:
        voxelize.load(path)
    assert str(caught.value).startswith(str(path))


def test_an_address_is_no_path():
    with pytest.raises(AssetError, match=r"^http://example\.org/a\.glb: is an address"):
        voxelize.load(Path("http://example.org/a.glb"))


def test_meshopt_streams_of_version_1():
    """Streams and elements of meshoptimizer's own coder, with every mode of channels and the colour filter."""
    file = Path(__file__).parents[1] / "voxelize" / "formats" / "gltf" / "meshopt_version_1.json"
    for one in json.loads(file.read_text(encoding="ascii")):
        view = CompressedView(
            buffer=0,
            byte_length=1,
            byte_stride=one["stride"],
            count=one["count"],
            mode="ATTRIBUTES",
            filter=one["filter"],
        )
        assert decode(view, base64.b64decode(one["stream"])) == base64.b64decode(one["elements"])


def test_a_memory_without_voxels_is_an_error(tmp_path):
    path, beside = written(tmp_path, TRIANGLE, "a.obj"), (5, 5, 5, 6, 6, 6)
    with pytest.raises(DoesNotFitError, match="the memory is empty"):
        voxrt.build(path, depth=4, bounds=beside)
    assert voxrt.build(path, depth=4, bounds=beside, allow_empty=True).solid_voxels == 0
    bounds = "--bounds=" + ",".join(map(str, beside))
    command = [sys.executable, "-m", "voxrt", "build", path, "-o", tmp_path / "out", "--depth", "4", bounds]
    found = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (found.returncode, found.stderr.count("\n")) == (4, 1)
    assert not list((tmp_path / "out").glob("*.mem"))


def squares(*sides):
    """An object per side, each a square on the ground."""
    lines = []
    for number, side in enumerate(sides):
        lines += [f"o square{side}", f"v 0 {number} 0", f"v {side} {number} 0", f"v {side} {number} {side}"]
        lines.append("f -3 -2 -1")
    return "\n".join(lines) + "\n"


def test_an_object_that_takes_the_grid_is_named(tmp_path):
    path = written(tmp_path, squares(1, 2, 5000), "a.obj")
    built = voxrt.build(path, depth=7)
    (warning,) = (one for one in built.warnings if one.kind == "dominant-object")
    assert "square5000 spans 5000 m, all other objects 2 m" in warning.message
    assert "--ignore NAME" in warning.message
    alone = voxrt.build(path, depth=7, ignore=["square5000"])
    assert alone.rom.grid.voxel_size == 2 / 128
    assert not [one for one in alone.warnings if one.kind == "dominant-object"]
    inside = voxrt.build(path, depth=7, bounds=(0, 0, 0, 4, 4, 4))
    assert inside.rom.grid.voxel_size == 4 / 128
    with pytest.raises(AssetError, match=r"no object 'square9' to ignore; it has 'square1', 'square2', 'square5000'"):
        voxrt.build(path, ignore=["square9"])


@pytest.mark.parametrize(
    ("apart", "side", "named"),
    [(600, 1, None), (1, 1, "ground spans 5000 m"), (1, 400, "ground, wide span 5000 m, all other objects 1 m")],
)
def test_small_objects_far_apart_do_not_take_the_grid(apart, side, named, tmp_path):
    """Three squares above a ground of 5000 m: only what is large by itself is named."""
    lines = ["o ground", "v 0 0 0", "v 5000 0 0", "v 5000 0 5000", "f -3 -2 -1"]
    for number, (name, wide) in enumerate([("a", 1), ("b", 1), ("wide", side)]):
        at = 1 + apart * number
        lines += [f"o {name}", f"v 0 {at} 0", f"v {wide} {at} 0", f"v {wide} {at} {wide}", "f -3 -2 -1"]
    built = voxrt.build(written(tmp_path, "\n".join(lines) + "\n", "a.obj"), depth=7)
    found = [one.message for one in built.warnings if one.kind == "dominant-object"]
    assert [named in message for message in found] == ([True] if named else [])


def test_objects_without_voxels_are_named(tmp_path):
    path = written(tmp_path, "o big\n" + TRIANGLE + "o same\n" + TRIANGLE.replace("1 2 3", "-3 -2 -1"), "a.obj")
    (warning,) = (one for one in voxrt.build(path, depth=4).warnings if one.kind == "no-voxels")
    assert (warning.message, warning.count) == ("objects got no voxel: same", 1)


ROBOT = """#usda 1.0
(
 metersPerUnit = 1
 upAxis = "Y"
)
def Xform "link" (prepend apiSchemas = ["PhysicsRigidBodyAPI"]) {
 def Cube "visual" {
  double size = 4
  color3f[] primvars:displayColor = [(1, 0, 0)]
 }
 def Xform "collisions" {
  token purpose = "guide"
  def Cube "box" (prepend apiSchemas = ["PhysicsCollisionAPI"]) {
   double size = 2
  }
 }
 def Xform "off" {
  token visibility = "invisible"
  def Sphere "ball" (prepend apiSchemas = ["PhysicsCollisionAPI"]) {
   double radius = 1
   double3 xformOp:translate = (10, 0, 0)
   uniform token[] xformOpOrder = ["xformOp:translate"]
  }
 }
}
"""


def test_hidden_colliders_count_where_colliders_are_asked_for(tmp_path):
    path = written(tmp_path, ROBOT, "a.usda")
    shown = voxrt.build(path, depth=4)
    assert [one.name for one in shown.objects] == ["/link/visual"]
    solid = voxrt.build(path, voxel_size=1, geometry="collider", pow2="none")
    voxels = {one.name: one.voxels for one in solid.objects}
    assert voxels["/link/collisions/box"] == 8
    assert voxels["/link/off/ball"] == 8
    assert voxels["/link/visual"] == 0  # the body's colliders stand for it
    assert solid.rom.materials[1].colour == (255, 0, 0)


def test_the_manifest_is_the_same_wherever_the_asset_is(tmp_path):
    text = '#usda 1.0\ndef "a" (references = @./u.usda@</a>) {\n def Cube "c" {\n }\n}\n'
    manifests = []
    for folder in ("one", "two"):
        (tmp_path / folder).mkdir()
        path = written(tmp_path / folder, text, "u.usda")
        out = voxrt.build(path, tmp_path / folder / "out", depth=3).outputs["manifest"]
        document = json.loads(out.read_text())
        document.pop("seconds", None)
        manifests.append(document)
        assert str(tmp_path) not in out.read_text()
        assert "0x" not in out.read_text()
    assert manifests[0] == manifests[1]


def test_a_usd_camera(tmp_path):
    text = """#usda 1.0
(
 metersPerUnit = 0.01
 upAxis = "Z"
)
def Cube "cube" {
 double size = 100
}
def Camera "eye" {
 float focalLength = 50
 float verticalAperture = 50
 float2 clippingRange = (1, 100)
 double3 xformOp:translate = (0, 0, 500)
 uniform token[] xformOpOrder = ["xformOp:translate"]
}
def Camera "flat" {
 token projection = "orthographic"
}
"""
    scene = voxelize.load(written(tmp_path, text, "a.usda"))
    (camera,) = scene.cameras
    assert scene.viewpoint == camera
    assert camera.name == "eye"
    np.testing.assert_allclose(camera.eye, (0, 5, 0), atol=1e-12)
    sight = np.subtract(camera.target, camera.eye)
    np.testing.assert_allclose(sight / np.linalg.norm(sight), (0, -1, 0), atol=1e-12)
    np.testing.assert_allclose(camera.up, (0, 0, -1), atol=1e-12)
    assert camera.field_of_view == pytest.approx(2 * np.degrees(np.arctan(0.5)), rel=1e-6)
    assert [one.message for one in scene.warnings if one.kind == "camera"] == [
        "clipping ranges and planes of cameras were ignored",
        "cameras without perspective were left out",
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[objects]\nbox = { size = [1, 1, 1] }\n", r"line 1: .*write \[\[objects\]\]"),
        ('[[objects]]\nasset = "x.glb"\n', r'line 2: asset is a table; write asset = \{ file = "x.glb" \}'),
        ("[[objects]]\nbox = {\n size = [1, 1, 1]\n}\n", r"line 2: an inline table .* over the end of its line"),
        ("[[objects]]\nboxx = { size = [1, 1, 1] }\n", r"line 2: unknown key 'boxx'; did you mean 'box'\?"),
        ("[[objects]]\nbox = { size = [1, 1, 1] }\nposition = [1, 2, 3]\n", r"unknown key 'position'; use name, box, "),
    ],
)
def test_scene_toml_says_what_to_write(tmp_path, text, message):
    with pytest.raises(AssetError, match=message):
        voxelize.load(written(tmp_path, text, "a.toml"))


def test_scene_toml_with_a_mark_and_equal_names(tmp_path):
    one = '[[objects]]\nname = "a"\nbox = { size = [1, 1, 1] }\n'
    scene = voxelize.load(written(tmp_path, b"\xef\xbb\xbf" + (one * 3).encode(), "a.toml"))
    assert [one.name for one in scene.objects] == ["a", "a (2)", "a (3)"]
    assert [one.count for one in scene.warnings if one.kind == "duplicate-name"] == [2]
