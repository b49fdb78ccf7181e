"""scene.toml: what it says, and how it is refused."""

import json
import tomllib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles.sound_scenes import read_or_refused
from oracles.surfaces import bounds, scene_triangles, volume

from voxrt.voxelize import AssetError, BoxCollider
from voxrt.voxelize.assets import load
from voxrt.voxelize.authoring.scene_toml.positions import key_lines

YARD = """\
background = "#9fc5e8"

[materials.stone]
colour = "#9a9aa0"
[materials."deep water"]
colour = [40, 90, 120]
mirror = true
id = 7

[[objects]]
name = "tent"
asset = { file = "tent.obj", unit = 0.01, materials = { cloth = "stone" } }
translate = [2, 0, 0]

[[objects]]
name = "well"
material = "stone"
difference = [
    { cylinder = { radius = 1, height = 1.5 } },   # outer
    { cylinder = { radius = 0.8, height = 2 }, material = "deep water" },
]

[[objects]]
box = { size = [1, 0.25, 0.5], corner = [0, 0, 2] }
material = "stone"
collider = "box"

[[objects]]
name = "pair"
material = "stone"
rotate = [0, 90, 0]
group = [
    { sphere = { radius = 1, centre = [3, 0, 0] } },
    { name = "prism", extrude = { outline = [[0, 0], [1, 0], [0, 1]], height = 2 }, material = "deep water" },
]

[camera]
eye = [6, 4, 9]
target = [0, 1, 0]

[light]
position = [3, 8, 4]
"""

TENT = "usemtl cloth\nv 0 0 0\nv 100 0 0\nv 0 100 0\nv 0 0 100\nf 1 3 2\nf 1 4 3\nf 1 2 4\nf 2 3 4\n"


@pytest.fixture
def toml(tmp_path):
    def write(text):
        (tmp_path / "tent.obj").write_text(TENT)
        path = tmp_path / "yard.toml"
        path.write_text(text)
        return load(path)

    return write


def test_a_yard(toml):
    scene = toml(YARD)
    assert scene.name == "yard"
    assert [one.name for one in scene.objects] == ["tent/tent", "well", "box 3", "pair/sphere 1", "pair/prism"]
    assert [one.name for one in scene.materials if one.authored] == ["empty", "stone", "deep water"]
    assert scene.materials[7].mirror
    assert scene.materials[0].colour == (159, 197, 232)
    assert [sorted(set(one.mesh.materials.tolist())) for one in scene.objects] == [[1], [1, 7], [1], [1], [7]]
    (collider,) = scene.objects[2].colliders
    assert isinstance(collider, BoxCollider)
    assert (collider.minimum.tolist(), collider.maximum.tolist()) == ([0, 0, 2], [1, 0.25, 2.5])
    assert scene.viewpoint.eye == (6, 4, 9)
    assert scene.light.position == (3, 8, 4)


def only(scene, name):
    (one,) = [one for one in scene.objects if one.name == name]
    return scene_triangles(type(scene)("one", (one,), scene.materials))


def test_places_and_shapes(toml):
    scene = toml(YARD)
    assert bounds(only(scene, "tent/tent")).tolist() == [[2, 0, 0], [3, 1, 1]]
    assert volume(only(scene, "tent/tent")) == pytest.approx(1 / 6)
    assert volume(only(scene, "well")) == pytest.approx(np.pi * 1.5 * 0.36, rel=1e-2)
    # A quarter turn about y takes x to -z.
    assert np.allclose(bounds(only(scene, "pair/sphere 1")), [[-1, -1, -4], [1, 1, -2]])
    assert volume(only(scene, "pair/prism")) == pytest.approx(1.0)


def test_assets_take_part_in_booleans(toml):
    scene = toml('[[objects]]\nunion = [{ asset = { file = "tent.obj" } }, { box = { size = [1, 1, 1] } }]\n')
    assert volume(scene_triangles(scene)) > 100**3 / 6


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("corner", "corne", "line 24: unknown key 'corne'; did you mean 'corner'?"),
        ("background", "backgroud", "line 1: unknown key 'backgroud'; did you mean 'background'?"),
        ("mirror", "mirorr", "line 7: unknown key 'mirorr'; did you mean 'mirror'?"),
        ("height = 2 }", "hieght = 2 }", "line 20: unknown key 'hieght'; did you mean 'height'?"),
        ("outline", "out_line", "line 34: unknown key 'out_line'; did you mean 'outline'?"),
        ("[camera]", "[kamera]", "line 37: unknown key 'kamera'; did you mean 'camera'?"),
        ("size = [1,", "size = [-1,", "line 24: expected `float` > 0.0"),
        ("size = [1, 0.25, 0.5]", "size = [1, 0.25]", "line 24: size: expected `array` of length 3, got 2"),
        ("radius = 1,", "radius = 'a',", "line 19: radius: expected `float`, got `str`"),
        ("radius = 1,", "", "line 19: cylinder: object missing required field `radius`"),
        ("radius = 1,", "radius = nan,", "line 19: radius: expected `float` > 0.0"),
        ("eye = [6", "eye = [inf", "line 38: "),
        ('"#9a9aa0"', '"red"', "line 3: colour 'red' is not written as #rrggbb"),
        ("[40,", "[400,", "line 5: colour must be three integers 0 … 255, not [400, 90, 120]"),
        ("id = 7", "id = 0", "line 8: id: expected `int` >= 1"),
        ("id = 7", "id = 1", "line 5: material 'deep water' cannot have the id 1: it belongs to 'stone'"),
        ('material = "stone"\nc', 'material = "ston"\nc', "line 24: no material 'ston' is declared; there is 'stone'"),
        ('cloth = "stone"', 'colth = "stone"', "line 12: the asset of 'tent' has no material 'colth'; it has 'cloth'"),
        ("tent.obj", "tend.obj", "line 12: asset "),
        ("tent.obj", "yard.toml", "line 12: a scene file cannot be an asset of another"),
        (
            "corner = [0, 0, 2] }",
            "corner = [0, 0, 2], centre = [0, 0, 0] }",
            "line 24: a box cannot have both a centre and a corner",
        ),
        (
            "height = 2 }, material",
            "height = 2 }, box = { size = [1, 1, 1] }, material",
            "line 20: is both box and cyl",
        ),
        ("sphere = { radius = 1, centre = [3, 0, 0] }", "scale = 2", "line 33: has no shape; add one of box, sphere"),
        ("rotate = [0, 90, 0]", "scale = [1, 2]", "line 31: scale must have shape (3,), not (2,)"),
        ("rotate = [0, 90, 0]", 'collider = "box"', "line 31: a group cannot have a collider"),
        (" },   # outer", ', collider = "box" },', "line 19: a part of a difference cannot have a"),
        ("[light]", "[light", "line 41: "),
        ("[3, 8, 4]", "[3, 8, 4", "at its end: "),
        ("radius = 0.8", "radius = 9", "line 18: the solid is empty"),
    ],
)
def test_refused(toml, old, new, message):
    with pytest.raises(AssetError) as caught:
        toml(YARD.replace(old, new, 1))
    assert f"yard.toml: {message}" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_names_of_a_groups_objects_begin_with_the_groups(toml):
    toml(YARD.replace('name = "pair"', 'name = "well"\n'))


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"\xff\xfe", "is not UTF-8 text"),
        (b"", "object missing required field `objects`"),
        (b"objects = []", "line 1: objects: expected `array` of length >= 1"),
        (b"objects = " + b"[" * 5000, "nested too deeply"),
        (b"a = " + b"9" * 9000, "exceeds the limit"),
        (b"[[objects]]\n" + b"union = [{ " * 60 + b"sphere = { radius = 1 } " + b"}]" * 60, "levels deep"),
    ],
)
def test_files_that_are_none(tmp_path, data, message):
    path = tmp_path / "yard.toml"
    path.write_bytes(data)
    with pytest.raises(AssetError) as caught:
        load(path)
    assert message.lower() in str(caught.value).lower()
    assert "\n" not in str(caught.value)


def test_camera_and_light_must_be_finite_and_apart(toml):
    with pytest.raises(AssetError, match="line 37: the camera's eye and target must differ"):
        toml(YARD.replace("eye = [6, 4, 9]", "eye = [0, 1, 0]"))


# --- positions ------------------------------------------------------------------------------------------------------

scalars = st.one_of(
    st.integers(-9, 9).map(str),
    st.sampled_from(["true", "1.5", "inf", "1979-05-27 07:32:00", "'a#b'", "'''x\n'y''\n'''", '"""\na\\"b"""']),
    st.text(st.characters(exclude_categories=("C",)), max_size=5).map(json.dumps),
)
blanks = st.sampled_from(["", " ", "\n", "\n  # note, ] }\n"])


@st.composite
def values(draw, depth=3):
    kind = draw(st.sampled_from(["scalar", "array", "table"])) if depth else "scalar"
    if kind == "scalar":
        return draw(scalars)
    if kind == "array":
        items = draw(st.lists(values(depth - 1), max_size=3))
        return "[" + ",".join(draw(blanks) + item + draw(blanks) for item in items) + draw(blanks) + "]"
    keys = draw(st.lists(st.sampled_from(["a", "b-c", '"d.e"', "'f'"]), unique=True, max_size=3))
    # A comment may stand in a table's array, but a table stands in one line.
    return "{" + ", ".join(f"{key} = {draw(values(depth - 1))}" for key in keys) + "}"


@st.composite
def documents(draw):
    lines = [f"top{number} = {draw(values())}" for number in range(draw(st.integers(0, 3)))]
    for number in range(draw(st.integers(0, 4))):
        header = draw(st.sampled_from(["[[list]]", f"[table{number}]", f"[ deep.'x y'.t{number} ]", "[[deep.list]]"]))
        lines.append(header)
        lines.extend(f"k{key} = {draw(values())}" for key in range(draw(st.integers(0, 2))))
        if draw(st.booleans()):
            lines.append(f"dotted.key{number} = 1 # note")
    return draw(st.sampled_from(["\n", "\n\n", "\r\n"])).join(lines) + "\n"


def paths_of(value, path=()):
    yield path
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from paths_of(inner, (*path, key))


@given(documents())
def test_every_key_has_a_line_on_which_it_stands(text):
    try:
        parsed = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return
    lines = key_lines(text)
    assert set(lines) | {()} == set(paths_of(parsed))
    rows = text.replace("\r\n", "\n").split("\n")
    for path, line in lines.items():
        if isinstance(path[-1], str) and path[-1] not in ("f", "d.e"):
            assert path[-1] in rows[line - 1]


@given(st.text(max_size=60) | st.lists(st.sampled_from(YARD.split()), max_size=40).map(" ".join))
def test_any_text_is_read_or_refused(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("toml") / "yard.toml"
    path.write_text(text, encoding="utf-8", errors="replace")
    read_or_refused(load, path)


@given(st.integers(0, len(YARD) - 1), st.sampled_from(["", "[", "]", "{", "}", '"', "=", "0", "-1", "x", "\n", ","]))
def test_damaged_files_are_read_or_refused(tmp_path_factory, place, insert):
    folder = tmp_path_factory.mktemp("toml")
    (folder / "tent.obj").write_text(TENT)
    path = folder / "yard.toml"
    path.write_text(YARD[:place] + insert + YARD[place + 1 :])
    read_or_refused(load, path)


def test_assets_outside_the_folder_are_not_opened(tmp_path):
    (tmp_path / "cube.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "inner").mkdir()
    path = tmp_path / "inner" / "yard.toml"
    path.write_text('[[objects]]\nasset = { file = "../cube.obj" }\n')
    with pytest.raises(AssetError, match=r"line 2: asset '../cube.obj' is outside .*--allow-outside"):
        load(path)
    assert len(load(path, allow_outside=True).objects) == 1


@pytest.mark.parametrize("name", ["a\\u0000b.obj", "n" * 5000 + ".obj"])
def test_assets_of_names_that_no_file_can_have(tmp_path, name):
    path = tmp_path / "yard.toml"
    path.write_text(f'[[objects]]\nasset = {{ file = "{name}" }}\n')
    with pytest.raises(AssetError, match=r"line 2: asset .*no such file"):
        load(path)


PAINTED = """mtllib a.mtl
v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1
usemtl Appearance Red\nf 1 3 2\nusemtl Glass\nf 1 2 4\nusemtl Trim\nf 2 3 4\nf 1 4 3
"""


@pytest.fixture
def car(tmp_path):
    (tmp_path / "car.obj").write_text(PAINTED)
    (tmp_path / "a.mtl").write_text("newmtl Appearance Red\nKd 1 0 0\nnewmtl Glass\nKd 0 0 1\nnewmtl Trim\nKd 0 1 0\n")

    def read(materials, objects='[[objects]]\nasset = { file = "car.obj" }\n'):
        path = tmp_path / "scene.toml"
        path.write_text(materials + objects)
        return load(path)

    return read


def test_ids_colours_and_mirrors_of_an_assets_materials_by_name(car):
    scene = car(
        '[materials."Appearance Red"]\nid = 7\n[materials.Trim]\nmirror = true\n'
        '[materials.Glass]\ncolour = "#102030"\nid = 9\n'
    )
    by_name = {one.name: (number, one.colour, one.mirror) for number, one in enumerate(scene.materials)}
    assert by_name["Appearance Red"] == (7, (255, 0, 0), False)
    assert by_name["Trim"] == (1, (0, 255, 0), True)
    assert by_name["Glass"] == (9, (16, 32, 48), False)


def test_ids_stay_when_objects_come_and_go(car):
    declared = '[materials."Appearance Red"]\nid = 7\n[materials.Trim]\n[materials.stone]\ncolour = "#808080"\n'
    asset = '[[objects]]\nasset = { file = "car.obj" }\n'
    stone = '[[objects]]\nbox = { size = [1, 1, 1] }\nmaterial = "stone"\n'
    for objects in (asset, asset + stone, stone + asset):
        names = [one.name for one in car(declared, objects).materials]
        assert [names.index(name) for name in ("Trim", "stone", "Glass", "Appearance Red")] == [1, 2, 3, 7]


def test_a_material_without_a_colour_must_be_some_assets(car):
    with pytest.raises(
        AssetError, match=r"line 1: material 'Pant Red' has no colour, and no asset has a material of that"
    ):
        car('[materials."Pant Red"]\nid = 7\n')
