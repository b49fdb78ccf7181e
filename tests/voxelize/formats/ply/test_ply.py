"""PLY in its three encodings, against trimesh and by hand."""

import struct

import numpy as np
import pytest
import trimesh
from assets import asset, over_assets
from hypothesis import given
from hypothesis import strategies as st
from oracles.sound_scenes import kinds
from oracles.surfaces import area, bounds, scene_triangles, volume

from voxrt.voxelize import AssetError
from voxrt.voxelize.assets import load
from voxrt.voxelize.colour.appearance import sample
from voxrt.voxelize.formats.ply import load_ply

VERTICES = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (1, 1, 3)]
FACES = [(3, 2, 1, 0), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)]


def header(encoding, vertices=5, faces=5, colour=False):
    colours = "property uchar red\nproperty uchar green\nproperty uchar blue\n" if colour else ""
    return (
        f"ply\nformat {encoding} 1.0\ncomment a pyramid\nelement vertex {vertices}\nproperty float x\n"
        f"property double y\nproperty float z\n{colours}element face {faces}\n"
        "property list uchar int vertex_indices\nproperty short flags\nend_header\n"
    ).encode()


def pyramid(encoding):
    if encoding == "ascii":
        rows = [" ".join(map(str, row)) for row in VERTICES]
        rows += [f"{len(face)} {' '.join(map(str, face))} 7" for face in FACES]
        return header(encoding) + "\n".join(rows).encode()
    order = "<" if "little" in encoding else ">"
    data = header(encoding)
    for x, y, z in VERTICES:
        data += struct.pack(f"{order}fdf", x, y, z)
    for face in FACES:
        data += struct.pack(f"{order}B{len(face)}ih", len(face), *face, 7)
    return data


@pytest.fixture
def ply(tmp_path):
    def write(data, **options):
        path = tmp_path / "part.ply"
        path.write_bytes(data)
        return load_ply(path, **options)

    return write


@pytest.mark.parametrize("encoding", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_a_pyramid_of_a_quad_and_triangles(ply, encoding):
    triangles = scene_triangles(ply(pyramid(encoding)))
    assert len(triangles) == 6
    assert volume(triangles) == pytest.approx(4.0)


def test_vertex_colours(ply):
    data = header("ascii", 3, 1, colour=True) + b"0 0 0 10 20 255\n1 0 0 10 20 255\n0 1 0 10 20 255\n3 0 1 2 0\n"
    scene = ply(data)
    assert [one.colour for one in scene.materials[1:]] == [(10, 20, 255)]
    assert not scene.warnings


@pytest.mark.parametrize(
    ("kind", "values", "colour", "clamped"),
    [
        ("uchar", "1 128 0", (1, 128, 0), 0),
        ("ushort", "65535 32896 257", (255, 128, 1), 0),
        ("ushort", "200 257 0", (1, 1, 0), 0),
        ("uchar", "300 128 0", (255, 128, 0), 3),
        ("float", "1.5 0.502 0.2", (255, 128, 51), 3),
    ],
)
def test_the_declared_type_decides_the_range_of_colours(ply, kind, values, colour, clamped):
    for names in (("red", "green", "blue"), ("diffuse_red", "diffuse_green", "diffuse_blue"), ("r", "g", "b")):
        properties = "".join(f"property {kind} {name}\n" for name in names).encode()
        text = header("ascii", 3, 1).replace(b"element face", properties + b"element face")
        rows = "".join(f"{corner} {values}\n" for corner in ("0 0 0", "1 0 0", "0 1 0"))
        scene = ply(text + rows.encode() + b"3 0 1 2 0\n")
        assert [one.colour for one in scene.materials[1:]] == [colour]
        assert kinds(scene) == ({"colour-range": clamped} if clamped else {})


def test_colours_of_faces_come_before_those_of_vertices(ply):
    text = header("ascii", 3, 2, colour=True).replace(
        b"property short", b"property float red\nproperty float green\nproperty float blue\nproperty short"
    )
    vertices = b"0 0 0 10 20 255\n1 0 0 10 20 255\n0 1 0 10 20 255\n"
    scene = ply(text + vertices + b"3 0 1 2 1 0 0 0\n3 2 1 0 0 1 0 0\n")
    colours = sample(scene.objects[0].mesh.appearance, np.array([0, 1]), np.full((2, 3), 1 / 3))
    assert colours.tolist() == [[1, 0, 0, 1], [0, 1, 0, 1]]


def test_faces_that_are_transparent_are_air(ply):
    text = header("ascii", 6, 2, colour=True).replace(b"blue\n", b"blue\nproperty uchar alpha\n")
    rows = b"".join(b"%d %d 0 9 9 9 %d\n" % (x, y, alpha) for alpha in (255, 0) for x, y in ((0, 0), (1, 0), (0, 1)))
    scene = ply(text + rows + b"3 0 1 2 0\n3 3 4 5 0\n")
    assert len(scene.objects[0].mesh.triangles) == 1
    for alpha, opaque_from, count in ((127, 0.5, 1), (127, 0.49, 2), (0, 0, 2)):
        rows = b"".join(b"%d %d 0 9 9 9 %d\n" % (x, y, a) for a in (255, alpha) for x, y in ((0, 0), (1, 0), (0, 1)))
        scene = ply(text + rows + b"3 0 1 2 0\n3 3 4 5 0\n", opaque_from=opaque_from)
        assert len(scene.objects[0].mesh.triangles) == count


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is empty"),
        (b"plyless", "no PLY header"),
        (b"ply\nend_header\n", "has 0 format lines"),
        (b"ply\nformat ascii 1.0\nend_header\n", "has neither faces nor points"),
        (b"ply\nformat ascii 1.0\nelement vertex -4\nend_header\n", "line 3: cannot understand 'element vertex -4'"),
        (b"ply\nformat ascii 1.0\nproperty float x\nend_header\n", "line 3: cannot understand"),
        (b"ply\nformat ascii 1.0\nelement v 1\nproperty list float int i\nend_header\n", "line 4: cannot understand"),
        (header("ascii") + b"0 0 0", "ends before its 5 vertex rows do"),
        (header("ascii", 1, 1) + b"0 0 0 3 0 0 1 0", "vertex 1.0 does not exist: the file has 1"),
        (header("ascii", 1, 1) + b"0 0 0 3 0 0 nan 0", "vertex nan does not exist: the file has 1"),
        (header("ascii", 1, 1) + b"0 0 nan 3 0 0 0 0", "not numbers"),
        (header("ascii", 1, 1) + b"0 0 zero 3 0 0 0 0", "vertex: 'zero' is not a number"),
        (header("ascii", 1, 1) + b"0 0 0 -3 0 0 0 0", "ends before its 1 face rows do"),
        (header("ascii", 1, 1) + b"0 0 " + b"0" * 9999 + b" 3 0 0 0 0", "is not a number"),
        (header("ascii", 1, 1) + b"0 0 0 2 0 0 0", "no faces of three corners"),
        (header("binary_little_endian", 10**12, 1) + b"0" * 99, "ends before its 1000000000000 vertex rows do"),
        (header("binary_big_endian", 0, 10**9) + b"\xff" * 200, "ends before its 1000000000 face rows do"),
        (pyramid("binary_little_endian")[:-1], "ends before its 5 face rows do"),
    ],
)
def test_refused(ply, data, message):
    with pytest.raises(AssetError) as caught:
        ply(data)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@given(st.data())
def test_damaged_files_are_read_or_refused(tmp_path_factory, data):
    encoding = data.draw(st.sampled_from(["ascii", "binary_little_endian", "binary_big_endian"]))
    content = bytearray(pyramid(encoding))
    for place in data.draw(st.lists(st.integers(0, len(content) - 1), min_size=1, max_size=4)):
        content[place] = data.draw(st.integers(0, 255))
    path = tmp_path_factory.mktemp("ply") / "part.ply"
    path.write_bytes(bytes(content))
    try:
        scene = load_ply(path)
    except AssetError:
        return
    if scene.objects[0].points is not None:  # nothing of it says that there are faces
        return
    mesh = scene.objects[0].mesh
    assert mesh.triangles.min() >= 0
    assert mesh.triangles.max() < len(mesh.positions)
    assert np.isfinite(mesh.positions[mesh.triangles]).all()


@over_assets(
    "name",
    [
        "ply/USD-Fileformat-plugins/gargo.ply",
        "ply/trimesh/cycloidal.ply",
        "ply/trimesh/cube_blender_uv.ply",
        "ply/assimp/float-color.ply",
        "ply/assimp/cube_binary_header_with_RN_newline.ply",
        "ply/assimp/cube_uv.ply",
    ],
)
def test_same_surface_as_trimesh(name):
    path = asset(name)
    ours = scene_triangles(load(path))
    theirs = trimesh.load(path, process=False).triangles
    assert len(ours) == len(theirs)
    assert np.allclose(bounds(ours), bounds(theirs), rtol=1e-6)
    assert area(ours) == pytest.approx(area(theirs), rel=1e-6)
    assert volume(ours) == pytest.approx(volume(theirs), rel=1e-6, abs=1e-9)


def test_a_cube_of_triangles_quads_and_edges():
    triangles = scene_triangles(load(asset("ply/USD-Fileformat-plugins/colors.ply")))
    assert len(triangles) == 12
    assert abs(volume(triangles)) == pytest.approx(1.0)


@over_assets(
    "name",
    [
        "assimp/invalid/empty.ply",
        "assimp/invalid/crash-30d6d0f7c529b3b66b4131700b7a4580cd7082df.ply",
        "trimesh/empty.ply",
        "trimesh/emptyIO/ply_empty_header.ply",
    ],
)
def test_malformed(name):
    with pytest.raises(AssetError):
        load(asset(f"malformed/{name}"))


@pytest.mark.parametrize("kind", ["int", "float"])
def test_triangle_strips(tmp_path, kind):
    path = tmp_path / "strips.ply"
    head = f"""ply
format ascii 1.0
element vertex 5
property float x
property float y
property float z
element tristrips 2
property list int {kind} vertex_indices
end_header
"""
    corners = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n"
    path.write_text(head + corners + "10 0 1 2 3 -1 2 3 4 4 -1\n3 1 3 2\n")
    (one,) = load_ply(path).objects
    assert one.mesh.triangles.tolist() == [[0, 1, 2], [2, 1, 3], [2, 3, 4], [1, 3, 2]]
    path.write_text(head + corners + "2 0 1\n1 -1\n")
    with pytest.raises(AssetError, match="has no faces of three corners"):
        load_ply(path)
