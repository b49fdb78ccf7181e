"""COLLADA: materials with their names and opacity, polygons, nodes, and what is left out, on files written here."""

import re
from fractions import Fraction

import numpy as np
import pytest
from oracles.sound_scenes import kinds
from PIL import Image

import voxrt
from voxrt.voxelize import AssetError, load

SPACE = 'xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"'
BOX = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SIDES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
RED = "<diffuse><color>1 0 0 1</color></diffuse>"


def source(name, rows, axes):
    params = "".join(f'<param name="{axis}" type="float"/>' for axis in axes)
    values = " ".join(str(value) for row in rows for value in row)
    return (
        f'<source id="{name}"><float_array id="{name}-a" count="{len(rows) * len(axes)}">{values}</float_array>'
        f'<technique_common><accessor source="#{name}-a" count="{len(rows)}" stride="{len(axes)}">{params}</accessor>'
        "</technique_common></source>"
    )


def polygons(faces, symbol, extra="", corner=lambda vertex: (vertex,)):
    """Return a polylist of faces; `extra` has more inputs, `corner` the indices of a vertex."""
    rows = " ".join(str(index) for face in faces for vertex in face for index in corner(vertex))
    return (
        f'<polylist count="{len(faces)}" material="{symbol}"><input semantic="VERTEX" source="#v" offset="0"/>{extra}'
        f"<vcount>{' '.join(str(len(face)) for face in faces)}</vcount><p>{rows}</p></polylist>"
    )


def effect(name, shading):
    technique = f'<technique sid="t"><lambert>{shading}</lambert></technique>'
    return f'<effect id="{name}-fx"><profile_COMMON>{technique}</profile_COMMON></effect>'


def bind(symbols):
    bound = "".join(f'<instance_material symbol="{one}" target="#{one}"/>' for one in symbols)
    return f"<bind_material><technique_common>{bound}</technique_common></bind_material>"


def document(primitives, shadings, *, positions=BOX, nodes=None, sources="", libraries=""):
    """A file with one geometry, `g`; `shadings`: the elements of each material's shader, by its symbol."""
    effects = "".join(effect(name, shading) for name, shading in shadings.items())
    materials = "".join(
        f'<material id="{name}" name="{name} paint"><instance_effect url="#{name}-fx"/></material>' for name in shadings
    )
    shown = nodes or f'<node id="n"><instance_geometry url="#g">{bind(shadings)}</instance_geometry></node>'
    return (
        f"<COLLADA {SPACE}><asset><up_axis>Y_UP</up_axis></asset>{libraries}"
        f"<library_effects>{effects}</library_effects><library_materials>{materials}</library_materials>"
        f'<library_geometries><geometry id="g" name="G"><mesh>{source("p", positions, "XYZ")}{sources}'
        f'<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>{primitives}</mesh></geometry>'
        f'</library_geometries><library_visual_scenes><visual_scene id="s">{shown}</visual_scene>'
        '</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>'
    )


def read(tmp_path, text, **options):
    (tmp_path / "a.dae").write_text(text)
    return load(tmp_path / "a.dae", **options)


LIGHT = [Fraction("0.212671"), Fraction("0.715160"), Fraction("0.072169")]
COLOUR = [Fraction(1, 2), Fraction(1, 4), Fraction(1), Fraction(3, 4)]


@pytest.mark.parametrize("mode", ["A_ONE", "A_ZERO", "RGB_ONE", "RGB_ZERO", None])
@pytest.mark.parametrize("amount", [Fraction(1, 2), Fraction(9, 10), None])
@pytest.mark.parametrize("stated", [True, False])
def test_opacity_is_as_the_standard_says(mode, amount, stated, tmp_path):
    """COLLADA 1.5.0, "Determining Transparency": missing parts are 1, and A_ONE."""
    colour = COLOUR if stated else [Fraction(1)] * 4
    share = amount if amount is not None else Fraction(1)
    named = (mode or "A_ONE") if stated else "A_ONE"
    luminance = sum(one * part for one, part in zip(colour, LIGHT, strict=False))
    share *= luminance if named.startswith("RGB") else colour[3]
    right = 1 - share if named.endswith("ZERO") else share
    if not stated and amount is None:
        right = Fraction(1)
    shading = RED
    if stated:
        attribute = f' opaque="{mode}"' if mode else ""
        shading += f"<transparent{attribute}><color>{' '.join(str(float(one)) for one in colour)}</color></transparent>"
    if amount is not None:
        shading += f"<transparency><float>{float(amount)}</float></transparency>"
    text = document(polygons(SIDES[:1], "glass") + polygons(SIDES[1:], "body"), {"glass": shading, "body": RED})
    for opaque_from, left_out in ((max(float(right) - 1e-6, 0), 0), (min(float(right) + 1e-6, 1), 2 * (right < 1))):
        scene = read(tmp_path, text, opaque_from=opaque_from)
        assert kinds(scene).get("transparent", 0) == left_out, (right, opaque_from)


def test_materials_have_their_names_and_objects_those_of_nodes(tmp_path):
    text = document(
        polygons(SIDES[:2], "top") + polygons(SIDES[2:], "side"), {"top": RED, "side": RED.replace("1 0", "0 1")}
    )
    scene = read(tmp_path, text)
    assert [(one.name, one.colour) for one in scene.materials[1:]] == [
        ("top paint", (255, 0, 0)),
        ("side paint", (0, 255, 0)),
    ]
    assert [one.name for one in scene.objects] == ["n"]  # and closed, though it has two materials
    assert kinds(scene) == {}
    assert voxrt.build(scene, depth=3).solid_voxels == 8**3


def test_nodes_share_a_mesh_unless_they_bind_other_materials(tmp_path):
    node = '<node id="{0}" name="box"><translate>{0} 0 0</translate>'
    node += '<instance_geometry url="#g">{1}</instance_geometry></node>'
    other = bind(["a"]).replace('target="#a"', 'target="#b"')
    nodes = node.format(0, bind(["a"])) + node.format(3, bind(["a"])) + node.format(6, other)
    shadings = {"a": RED, "b": RED.replace("1 0 0", "0 0 1")}
    scene = read(tmp_path, document(polygons(SIDES, "a"), shadings, nodes=nodes))
    assert [one.name for one in scene.objects] == ["box [0]", "box [1]", "box [2]"]
    assert [one.transform[0, 3] for one in scene.objects] == [0, 3, 6]
    first, second, third = (one.mesh for one in scene.objects)
    assert first is second
    assert first is not third
    assert scene.materials[third.materials[0]].colour == (0, 0, 255)


def test_concave_polygons_keep_their_area(tmp_path):
    outline = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [3, 4, 0], [3, 1, 0], [0, 1, 0]]
    scene = read(tmp_path, document(polygons([[5, 4, 3, 2, 1, 0]], "a"), {"a": RED}, positions=outline))
    a, b, c = (scene.objects[0].mesh.positions[scene.objects[0].mesh.triangles[:, i]] for i in range(3))
    assert np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2 == 7


@pytest.mark.parametrize("with_material", [True, False])
def test_vertex_colours(with_material, tmp_path):
    colours = source("c", [[0, 1, 0]] * 8, "RGB")
    faces = polygons(SIDES, "a", '<input semantic="COLOR" source="#c" offset="1"/>', lambda vertex: (vertex, vertex))
    nodes = None if with_material else '<node id="n"><instance_geometry url="#g"/></node>'
    white = {"a": RED.replace("1 0 0", "1 1 1")}
    scene = read(tmp_path, document(faces, white, sources=colours, nodes=nodes))
    assert {scene.materials[one].colour for one in scene.objects[0].mesh.materials} == {(0, 255, 0)}
    assert kinds(scene) == {}


def test_the_alpha_of_a_texture_counts_where_the_material_says_so(tmp_path):
    pixels = np.full((2, 2, 4), (0, 0, 255, 60), np.uint8)
    Image.fromarray(pixels).save(tmp_path / "map.png")
    image = '<library_images><image id="i"><init_from>map.png</init_from></image></library_images>'
    coordinates = source("t", [[0.5, 0.5]], "ST")
    faces = polygons(SIDES, "a", '<input semantic="TEXCOORD" source="#t" offset="1"/>', lambda vertex: (vertex, 0))
    texture = '<texture texture="i" texcoord="UV"/>'
    plain = f"<diffuse>{texture}</diffuse>"
    scene = read(tmp_path, document(faces, {"a": plain}, sources=coordinates, libraries=image))
    assert scene.materials[1].colour == (0, 0, 255)
    assert kinds(scene) == {}
    glass = document(faces, {"a": f"{plain}<transparent>{texture}</transparent>"}, sources=coordinates, libraries=image)
    with pytest.raises(AssetError, match=r"shows nothing: faces less opaque than 0\.5"):
        read(tmp_path, glass)
    assert kinds(read(tmp_path, glass, opaque_from=0.2)) == {}
    other = RED + f"<transparent>{texture}</transparent>"
    assert kinds(read(tmp_path, document(faces, {"a": other}, sources=coordinates, libraries=image))) == {"texture": 1}


def test_a_skin_is_shown_as_it_was_bound(tmp_path):
    joints = (
        '<source id="j"><Name_array id="ja" count="1">J</Name_array><technique_common><accessor source="#ja" count="1" '
        'stride="1"><param name="JOINT" type="name"/></accessor></technique_common></source>'
        '<source id="m"><float_array id="ma" count="16">1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</float_array><technique_common>'
        '<accessor source="#ma" count="1" stride="16"><param name="T" type="float4x4"/></accessor></technique_common>'
        "</source>" + source("w", [[1]], ["WEIGHT"])
    )
    weights = (
        '<joints><input semantic="JOINT" source="#j"/><input semantic="INV_BIND_MATRIX" source="#m"/></joints>'
        '<vertex_weights count="8"><input semantic="JOINT" source="#j" offset="0"/>'
        '<input semantic="WEIGHT" source="#w" offset="1"/><vcount>1 1 1 1 1 1 1 1</vcount>'
        "<v>0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0</v></vertex_weights>"
    )
    matrix = "<bind_shape_matrix>1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>"
    library = f'<library_controllers><controller id="k"><skin source="#g">{matrix}{joints}{weights}</skin></controller>'
    nodes = f'<node id="body"><translate>9 9 9</translate><instance_controller url="#k">{bind(["a"])}'
    nodes += "</instance_controller></node>"
    text = document(polygons(SIDES, "a"), {"a": RED}, nodes=nodes)
    text = text.replace("<library_visual_scenes>", library + "</library_controllers><library_visual_scenes>")
    scene = read(tmp_path, text)
    assert [one.name for one in scene.objects] == ["body"]
    assert scene.objects[0].transform[:3, 3].tolist() == [5, 0, 0]
    assert kinds(scene) == {"skin": 1}


def test_what_is_left_out_is_counted(tmp_path):
    lines = '<lines count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1</p></lines>'
    text = document(polygons(SIDES, "a") + lines, {"a": RED})
    assert kinds(read(tmp_path, text)) == {"no-triangles": 1}
    broken = text.replace(
        "<library_visual_scenes>", '<library_lights><light id="l"/></library_lights><library_visual_scenes>'
    )
    assert kinds(read(tmp_path, broken)) == {"no-triangles": 1, "not-read": 1}


@pytest.mark.parametrize(
    ("pattern", "text", "message"),
    [
        (r"<p>0 1 3 2", "<p>0 1 3 9", "shows nothing that can be read: "),
        (r"0 0 0 0 0 1", "0 0 0 0 0,5 1", "is not as COLLADA|can be read: "),
        (r"<p>0 1 3 2", "<p>0 1 3 -1", "is not as COLLADA has it"),
        (r"<vcount>4", "<vcount>5", "is not as COLLADA has it"),
        (r"<vcount>4", "<vcount>-4", "is not as COLLADA has it"),
        (r"1 1 1</float_array>", "1 1 nan</float_array>", "a coordinate is not a number"),
        (r'<node id="n">', '<node id="n"><translate>1e39 0 0</translate>', "a transform is not finite"),
        (r"</node>", '<instance_node url="#n"/></node>', "shows nothing that can be read: "),
    ],
)
def test_what_is_not_as_it_should_be_is_refused_in_one_line(pattern, text, message, tmp_path):
    whole = document(polygons(SIDES, "a"), {"a": RED})
    assert re.search(pattern, whole)
    with pytest.raises(AssetError, match=message) as caught:
        read(tmp_path, re.sub(pattern, text, whole, count=1))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("meter", ["0", "0,0254", "1e300"])
def test_a_unit_that_is_no_length_is_refused(meter, tmp_path):
    whole = document(polygons(SIDES, "a"), {"a": RED})
    asset = f'<asset><unit meter="{meter}"/></asset>'
    with pytest.raises(AssetError, match=f"has a unit of '{meter}' metres"):
        read(tmp_path, re.sub("(<COLLADA[^>]*>)(<asset>.*</asset>|<asset/>)?", rf"\1{asset}", whole, count=1))
