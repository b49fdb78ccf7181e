"""Authored normals: the same surface with the same normals in every format that has them."""

import struct

import numpy as np
import pytest
from oracles.gltf_writer import GltfWriter
from oracles.usd_in_process import load_usd

from voxrt.voxelize import CornerNormals, Mesh, Scene, load
from voxrt.voxelize.authoring import Author
from voxrt.voxelize.formats.scene_message import LENGTHS, read_message, scene_bytes

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)]
NORMALS = [(0, 2, 0), (0, 3, 4), (0, 0, -0.5), (6, 8, 0)]
UNIT = {0: (0, 1, 0), 1: (0, 0.6, 0.8), 2: (0, 0, -1), 3: (0.6, 0.8, 0)}
FACES = [(0, 2, 1), (0, 3, 2)]


def rows(keyword, values):
    return "".join(f"{keyword} {' '.join(map(str, row))}\n" for row in values)


def write_obj(path):
    faces = "".join("f " + " ".join(f"{v + 1}//{4 - v}" for v in face) + "\n" for face in FACES)
    path.write_text(rows("v", CORNERS) + rows("vn", NORMALS[::-1]) + faces)


def write_ply(path):
    header = "ply\nformat binary_little_endian 1.0\nelement vertex 4\n"
    header += "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz"))
    header += "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
    data = b"".join(struct.pack("<6f", *place, *normal) for place, normal in zip(CORNERS, NORMALS, strict=True))
    path.write_bytes(header.encode() + data + b"".join(struct.pack("<B3i", 3, *face) for face in FACES))


def write_gltf(path, extra=None, **node):
    writer = GltfWriter()
    mesh = writer.mesh(CORNERS, [v for face in FACES for v in face], NORMAL=writer.accessor(NORMALS))
    if extra is not None:
        extra(writer, writer.json["meshes"][mesh]["primitives"])
    writer.show(mesh=mesh, **node)
    writer.save(path)


def write_usd(path, normals='normal3f[] normals = {} (interpolation = "vertex")'):
    path.write_text(
        '#usda 1.0\n(\n upAxis = "Y"\n metersPerUnit = 1\n)\ndef Mesh "sheet"\n{\n'
        f"point3f[] points = {CORNERS}\nint[] faceVertexCounts = [3, 3]\n"
        f"int[] faceVertexIndices = {[v for face in FACES for v in face]}\n"
        f'uniform token subdivisionScheme = "none"\n{normals.format(NORMALS)}\n}}\n'
    )


WRITERS = {"obj": write_obj, "ply": write_ply, "glb": write_gltf, "usda": write_usd}


def of_corners(scene):
    (thing,) = scene.objects
    return thing.mesh.normals.of_corners()


@pytest.mark.parametrize("suffix", WRITERS)
def test_every_format_gives_its_normals(tmp_path, suffix):
    path = tmp_path / f"sheet.{suffix}"
    WRITERS[suffix](path)
    expected = [[UNIT[vertex] for vertex in face] for face in FACES]
    np.testing.assert_allclose(of_corners(load(path)), expected, atol=1e-6)


@pytest.mark.parametrize(
    ("normals", "expected_normals"),
    [
        ('uniform token orientation = "rightHanded"', None),
        ('normal3f[] normals = [(0, 2, 0), (0, 3, 4)] (interpolation = "uniform")', [[UNIT[0]] * 3, [UNIT[1]] * 3]),
        (
            f'normal3f[] normals = {[NORMALS[0]] * 5 + [NORMALS[3]]} (interpolation = "faceVarying")',
            [[UNIT[0]] * 3, [UNIT[0], UNIT[0], UNIT[3]]],
        ),
        (
            (
                'normal3f[] normals = [(0, 0, 1)] (interpolation = "constant")\n'
                'normal3f[] primvars:normals = [(0, 2, 0)] (interpolation = "constant")'
            ),
            [[UNIT[0]] * 3] * 2,
        ),
        ('normal3f[] normals = [(0, 1, 0), (0, 1, 0)] (interpolation = "vertex")', None),  # too few
    ],
)
def test_normals_of_usd_by_their_interpolation(tmp_path, normals, expected_normals):
    write_usd(tmp_path / "sheet.usda", normals)
    (thing,) = load_usd(tmp_path / "sheet.usda").objects
    if expected_normals is None:
        assert thing.mesh.normals is None
    else:
        np.testing.assert_allclose(thing.mesh.normals.of_corners(), expected_normals, atol=1e-6)


def test_normals_of_gltf_that_do_not_fit_are_ignored_with_a_warning(tmp_path):
    def shorten(writer, primitives):
        primitives[0]["attributes"]["NORMAL"] = writer.accessor(NORMALS[:2])

    write_gltf(tmp_path / "a.glb", shorten)
    scene = load(tmp_path / "a.glb")
    assert scene.objects[0].mesh.normals is None
    assert "normals" in {warning.kind for warning in scene.warnings}


def test_a_primitive_without_normals_beside_one_with(tmp_path):
    def add_bare(writer, primitives):
        primitives.append({"attributes": {"POSITION": writer.accessor(CORNERS)}, "indices": primitives[0]["indices"]})

    write_gltf(tmp_path / "a.glb", add_bare)
    found = of_corners(load(tmp_path / "a.glb"))
    assert found[:2].any(axis=2).all()
    assert not found[2:].any()


def test_a_morphed_mesh_has_none(tmp_path):
    def morph(writer, primitives):
        primitives[0]["targets"] = [{"POSITION": writer.accessor([(0, 1, 0)] * 4)}]

    write_gltf(tmp_path / "rest.glb", morph)
    write_gltf(tmp_path / "moved.glb", morph, weights=[0.5])
    assert load(tmp_path / "rest.glb").objects[0].mesh.normals is not None
    assert load(tmp_path / "moved.glb").objects[0].mesh.normals is None


@pytest.mark.parametrize(
    ("faces", "vertices"),
    [
        ("f 1/1/-4 3/1/-2 2/1/-3", (0, 2, 1)),
        ("f 1//1 3 2//2", (0, None, 1)),
        ("f 1//1 3//9 2//2", (0, None, 1)),
        ("f 1/1/1 3//3 2/1/2", (0, 2, 1)),
    ],
)
def test_references_of_obj(tmp_path, faces, vertices):
    path = tmp_path / "a.obj"
    path.write_text(rows("v", CORNERS) + "vt 0 0\n" + rows("vn", NORMALS) + faces)
    scene = load(path)
    expected = [[(0, 0, 0) if vertex is None else UNIT[vertex] for vertex in vertices]]
    np.testing.assert_allclose(of_corners(scene), expected)
    assert ("normals" in {warning.kind for warning in scene.warnings}) == ("9" in faces)


@pytest.mark.parametrize("faces", ["f 1//a 3//b 2//c", "f 1/1/1/1/x 3//3 2//2"])
def test_references_of_obj_that_are_no_numbers(tmp_path, faces):
    path = tmp_path / "a.obj"
    path.write_text(rows("v", CORNERS) + "vn 0 1 0\n" + faces)
    scene = load(path)
    assert scene.objects[0].mesh.normals is None or not of_corners(scene)[0, 1:].any()


def test_vectors_of_any_length():
    huge, tiny = np.finfo(np.float64).max, np.finfo(np.float64).tiny
    normals = CornerNormals([[huge, 0, 0], [0, tiny, 0], [np.nan, 0, 1]], [[0, 1, 2]])
    np.testing.assert_allclose(normals.of_corners(), [[(1, 0, 0), (0, 1, 0), (0, 0, 0)]])
    with pytest.raises(ValueError, match=r"CornerNormals\.rows\[0, 2\]"):
        CornerNormals([[0, 0, 1]], [[0, 0, 1]])
    with pytest.raises(ValueError, match=r"Mesh\.normals is for 1 triangles"):
        Mesh(CORNERS, FACES, [1, 1], normals=normals)


def test_normals_survive_authoring_and_messages(tmp_path):
    write_gltf(tmp_path / "a.glb")
    scene = load(tmp_path / "a.glb")
    author = Author("yard")
    author.add_asset("sheet", scene, np.eye(4))
    assert len(of_corners(author.build())) == 2
    data = b"".join(bytes(part) for part in scene_bytes(scene))
    text, _ = LENGTHS.unpack_from(data)
    there = read_message(data[LENGTHS.size : LENGTHS.size + text], np.frombuffer(data, np.uint8)[LENGTHS.size + text :])
    assert isinstance(there, Scene)
    np.testing.assert_array_equal(of_corners(there), of_corners(scene))
