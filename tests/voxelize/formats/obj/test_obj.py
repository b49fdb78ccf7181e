"""OBJ and MTL: what the statements say, and what is refused."""

import numpy as np
import pytest
from oracles.sound_scenes import kinds
from oracles.surfaces import scene_triangles, volume

from voxrt.voxelize import DEFAULT_COLOUR, AssetError, DoesNotFitError
from voxrt.voxelize.formats.obj import load_obj

CUBE = """v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n"""


@pytest.fixture
def obj(tmp_path):
    def write(text, mtl=None, **options):
        path = tmp_path / "model.obj"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        if mtl is not None:
            (tmp_path / "model.mtl").write_text(mtl)
        return load_obj(path, **options)

    return write


def test_a_cube(obj):
    scene = obj(CUBE)
    assert scene.name == "model"
    assert volume(scene_triangles(scene)) == pytest.approx(1.0)
    assert [material.name for material in scene.materials] == ["empty", "default"]
    assert not scene.materials[1].authored
    assert kinds(scene) == {"default-material": 6}


@pytest.mark.parametrize(
    "change",
    [
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.replace("\n", "\r"),
        lambda text: text.replace("v ", "   v\t "),
        lambda text: text.replace(" ", " \x01\x0b \x1c"),
        lambda text: text.replace("f ", " \tf  "),
        lambda text: text.replace("\n", " # a note, v 1 2 3\n"),
        lambda text: text.replace(" ", " \\\n "),
        lambda text: text.rstrip("\n"),
        lambda text: "\ufeff" + text,
        lambda text: text.encode("utf-16"),
        lambda text: text.encode("utf-16-be"),
        lambda text: text.encode("utf-16-le"),
        lambda text: text.encode("utf-32"),
        lambda text: "g Größe\n".encode("latin-1") + text.encode(),
        lambda text: text.replace("f 1 4 3 2", "f 1/9/9 4//8 3/7 2/"),
        lambda text: text.replace("f 1 4 3 2", "f -8 -5 -6 -7"),
    ],
)
def test_ways_to_write_the_same_cube(obj, change):
    scene = obj(change(CUBE))
    assert volume(scene_triangles(scene)) == pytest.approx(1.0)
    assert sum(len(one.mesh.triangles) for one in scene.objects) == 12


def test_negative_numbers_count_back_from_the_face(obj):
    lines = [line for line in CUBE.splitlines() if line.startswith("v")]
    faces = [line for line in CUBE.splitlines() if line.startswith("f")]
    relative = ["f " + " ".join(str(int(word) - 9) for word in face.split()[1:]) for face in faces]
    moved = [f"v {float(a) + 5} {b} {c}" for _, a, b, c in (line.split() for line in lines)]
    scene = obj("\n".join([*lines, *relative, *moved, *relative]))
    assert volume(scene_triangles(scene)) == pytest.approx(2.0)


def test_up_and_unit(obj):
    scene = obj("v 0 0 0\nv 1 0 0\nv 0 0 3\nf 1 2 3\n", up="z", unit=0.01)
    (one,) = scene.objects
    positions = one.mesh.positions @ one.transform[:3, :3].T
    assert np.allclose(positions[2], [0, 0.03, 0])
    assert np.allclose(positions[1], [0.01, 0, 0])
    assert np.linalg.det(one.transform[:3, :3]) > 0


def test_materials_in_order_of_first_use(obj):
    faces = CUBE.replace("f 5 6 7 8", "usemtl b\nf 5 6 7 8").replace("f 2 3", "usemtl a\nf 2 3")
    scene = obj(
        "mtllib model.mtl\nusemtl c\n" + faces,
        "newmtl a\nKd 1 0 0\nnewmtl unused\nKd 0 1 0\nnewmtl b\nKd 0 0.5 1\n\tnewmtl c\nKd 0.2\n",
    )
    assert [(one.name, one.colour) for one in scene.materials[1:]] == [
        ("c", (51, 51, 51)),
        ("b", (0, 128, 255)),
        ("a", (255, 0, 0)),
    ]
    (only,) = scene.objects
    assert only.mesh.materials.tolist() == [1, 1, 2, 2, 2, 2, 2, 2, 3, 3, 3, 3]
    assert scene.warnings == ()


def test_names_survive_a_missing_library(obj):
    scene = obj("mtllib nowhere.mtl\nusemtl steel\n" + CUBE)
    assert [(one.name, one.colour, one.authored) for one in scene.materials[1:]] == [("steel", DEFAULT_COLOUR, True)]
    assert kinds(scene) == {"missing-library": 1, "missing-material": 6}


def test_library_paths_of_other_machines(tmp_path):
    (tmp_path / "Sub").mkdir()
    (tmp_path / "Sub" / "My Colours.MTL").write_text("newmtl red\nKd 1 0 0\n")
    for name in (r"sub\my colours.mtl", r".\Sub\My Colours.MTL"):
        path = tmp_path / "model.obj"
        path.write_text(f"mtllib {name}\nusemtl red\n{CUBE}")
        assert load_obj(path).materials[1].colour == (255, 0, 0), name
    (tmp_path / "flat.mtl").write_text("newmtl red\nKd 0 1 0\n")
    path.write_text(f"mtllib C:\\Users\\me\\flat.mtl\nusemtl red\n{CUBE}")
    assert load_obj(path).materials[1].colour == (0, 255, 0)


def test_libraries_outside_the_folder_are_not_opened(tmp_path):
    (tmp_path / "secret.mtl").write_text("newmtl red\nKd 1 0 0\n")
    (tmp_path / "inner").mkdir()
    path = tmp_path / "inner" / "model.obj"
    path.write_text(f"mtllib ../secret.mtl\nusemtl red\n{CUBE}")
    scene = load_obj(path)
    assert kinds(scene)["outside"] == 1
    assert "--allow-outside" in next(one.message for one in scene.warnings if one.kind == "outside")
    assert load_obj(path, allow_outside=True).materials[1].colour == (255, 0, 0)


@pytest.mark.parametrize("name", ["a\0b", "n" * 5000])
def test_names_that_no_file_can_have(obj, name):
    scene = obj(f"mtllib model.mtl\nmtllib {name}.mtl\nusemtl a\n{CUBE}", f"newmtl a\nKd 1 0 0\nmap_Kd {name}\n")
    assert kinds(scene) == {"missing-library": 1, "missing-texture": 6}


def test_names_of_nothing_but_slashes_are_outside(obj):
    name = "/" * 5000
    scene = obj(f"mtllib model.mtl\nmtllib {name}.mtl\nusemtl a\n{CUBE}", f"newmtl a\nKd 1 0 0\nmap_Kd {name}\n")
    assert kinds(scene) == {"outside": 7}


@pytest.mark.parametrize("opacity", ["d 1\nTr 1", "Tr 1\nd 1"])
def test_d_counts_beside_tr_in_any_order(obj, opacity):
    scene = obj("mtllib model.mtl\nusemtl a\n" + CUBE, f"newmtl a\nKd 1 0 0\n{opacity}\n")
    assert len(scene.objects[0].mesh.triangles) == 12
    assert not scene.warnings


@pytest.mark.parametrize("opacity", ["d 0.2", "Tr 0.8", "d -halo 0.1"])
def test_what_lets_light_through_is_air(obj, opacity):
    faces = CUBE.replace("f 1 5 8 4", "usemtl glass\nf 1 5 8 4")
    scene = obj(
        "mtllib model.mtl\nusemtl wall\n" + faces, f"newmtl wall\nKd 1 1 1\nnewmtl glass\nKd 0 0 1\n{opacity}\n"
    )
    assert len(scene.objects[0].mesh.triangles) == 10
    assert [one.name for one in scene.materials] == ["empty", "wall"]
    assert kinds(scene) == {"transparent": 1}


def test_objects_by_o(obj):
    shifted = CUBE.replace("v 0", "v 3").replace("v 1", "v 4")
    again = "\n".join(
        "f " + " ".join(str(int(word) + 8) for word in line.split()[1:]) if line.startswith("f") else line
        for line in shifted.splitlines()
    )
    scene = obj(f"o first\ng x\n{CUBE}g y\no first\n{again}\n")
    assert [one.name for one in scene.objects] == ["first", "first (2)"]
    assert [len(one.mesh.positions) for one in scene.objects] == [8, 8]
    assert volume(scene_triangles(scene)) == pytest.approx(2.0)


def test_groups_that_share_vertices_are_one_object(obj):
    faces = CUBE.replace("f 5 6", "g top\nf 5 6").replace("f 2 3", "g side\nf 2 3")
    far = "g far\nv 9 9 9\nv 8 9 9\nv 9 8 9\nf 9 10 11\n"
    scene = obj("g bottom\n" + faces + far)
    assert [(one.name, len(one.mesh.triangles)) for one in scene.objects] == [("bottom", 12), ("far", 1)]


def test_groups_may_be_continued(obj):
    scene = obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 0 0\nv 6 0 0\nv 5 1 0\ng a\nf 1 2 3\ng b\nf 4 5 6\ng a\nf 3 2 1\n")
    assert [(one.name, len(one.mesh.triangles)) for one in scene.objects] == [("a", 2), ("b", 1)]


def test_a_concave_polygon_covers_its_own_area(obj):
    scene = obj("v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n")
    mesh = scene.objects[0].mesh
    a, b, c = (mesh.positions[mesh.triangles[:, i]] for i in range(3))
    assert np.cross(b - a, c - a)[:, 2].min() > 0
    assert np.cross(b - a, c - a)[:, 2].sum() / 2 == pytest.approx(10.0)


def test_what_is_not_honoured_is_counted(obj):
    scene = obj(
        "mtllib model.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nl 1 2\np 1\ncurv 0 1\nnonsense 1\n",
        "newmtl a\nKd 1 0 0\nmap_Kd a.png\nmap_d b.png\n",
    )
    assert kinds(scene) == {"no-area": 2, "free-form": 1, "unknown-statement": 1, "missing-texture": 2}
    assert scene.materials[1].colour == (255, 0, 0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "has no faces"),
        ("\\\n", "has no faces"),
        ("v 1 2 3\ng An f Three\n", "has no faces"),
        ("v 0 0 0\nv 1 0 0\nf 1 2\n", "has no faces of three corners"),
        ("v 0 0\nf 1 1 1\n", "line 1: a vertex needs three numbers"),
        ("v 0 0 0\n\n\nf 1 2 1\n", "line 4: vertex 2 of a face does not exist: the file has 1"),
        ("v 0 0 0\nf 0 1 1\n", "line 2: vertex 0 of a face does not exist"),
        ("v 0 0 0\nf -2 1 1\n", "line 2: vertex -2 of a face does not exist"),
        ("v 0 \\\n0 0\nf 1 1 x\n", "line 3: 'x' is not a corner"),
        ("v 0 0 0\nf 1 1 /2\n", "line 2: '/2' is not a corner"),
        ("v 0 0 0\nf 1 1 99999999999999999999999\n", "line 2: "),
        ("v 0 0\x01x\nf 1 1 1\n", r"line 1: '0\x01x' is not a number"),
        ("v 0 0 0\nf 1\x011 x\n", "line 2: 'x' is not a corner"),
        ("v 0 0 nan\nf 1 1 1\n", "line 2: vertex 1 of a face has a coordinate that is not a number"),
        ("v 0 0 1e999\nf 1 1 1\n", "line 2: vertex 1 of a face has a coordinate that is not a number"),
        ("v 0 0 1+e2\nf 1 1 1\n", "line 1: '1+e2' is not a number"),
        ("v 0 0 0,5\nf 1 1 1\n", "line 1: '0,5' is not a number; numbers have a decimal point, not a comma: write 0.5"),
        (b"\xff\xfev\x00\x00\xd8", "is not the UTF-16-LE text that it begins as"),
    ],
)
def test_refused(obj, text, message):
    with pytest.raises(AssetError) as caught:
        obj(text)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_too_many_materials(obj):
    faces = "".join(f"usemtl m{i}\nf 1 2 3\n" for i in range(256))
    with pytest.raises(DoesNotFitError, match="255 materials"):
        obj("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + faces)


@pytest.mark.parametrize("line", ["Kd 1 x 0", "Kd 1 0", "d", "d nan"])
def test_a_library_with_a_bad_number(obj, line):
    with pytest.raises(AssetError, match=r"model\.mtl: line 2: "):
        obj("mtllib model.mtl\nusemtl a\n" + CUBE, f"newmtl a\n{line}\n")


BASE = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 2 9\nf 4 3 2 1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n"


def test_a_flat_base_hints_at_the_axis_that_nobody_states(obj):
    """A pyramid that stands on z; one that stands on y; a box, which stands on either."""
    standing = "\n".join(
        "v {0} {2} {1}".format(*line.split()[1:]) if line.startswith("v") else line for line in BASE.splitlines()
    )
    assert kinds(obj(BASE, up="y")).get("up-axis") is None
    assert [kinds(obj(text)).get("up-axis") for text in (BASE, standing, CUBE)] == [1, None, None]


NAMED = """\
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0
mtllib my #2 library.mtl # from the archive
usemtl Plastic #1\nf 1 2 3
usemtl Plastic #2\nf 1 3 4
usemtl plain # of one word\nf 1 2 4
# usemtl red
o # nothing
"""


def test_a_hash_within_a_name_is_part_of_it(tmp_path):
    (tmp_path / "my #2 library.mtl").write_text(
        "# materials\nnewmtl Plastic #1\nKd 1 0 0 # red\nnewmtl Plastic #2\nKd 0 0 1\nnewmtl plain # all\nKd 0 1 0\n"
    )
    (tmp_path / "a.obj").write_text(NAMED)
    scene = load_obj(tmp_path / "a.obj")
    assert [(one.name, one.colour) for one in scene.materials[1:]] == [
        ("Plastic #1", (255, 0, 0)),
        ("Plastic #2", (0, 0, 255)),
        ("plain", (0, 255, 0)),
    ]
    assert kinds(scene) == {}


@pytest.mark.parametrize(
    ("statement", "opacity", "fix"),
    [("d 0.25", "0.25", "'d 1'"), ("Tr 1", "0", "'Tr 0'"), ("d 0.1\nTr 0", "0.1", "'d 1'")],
)
def test_a_refusal_for_transparency_names_the_statement_and_the_option(statement, opacity, fix, obj):
    text = "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl pane\nf 1 2 3\n"
    library = f"newmtl pane\n{statement}\n"
    with pytest.raises(AssetError) as refused:
        obj(text, library)
    expected = (
        f"material 'pane' has '{statement.splitlines()[0]}'; write {fix} in its place, or build with --opaque-from"
    )
    assert f"{expected} {opacity}" in str(refused.value)
    assert len(obj(text, library, opaque_from=float(opacity)).objects[0].mesh.triangles) == 1
