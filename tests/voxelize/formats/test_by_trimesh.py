"""OFF, 3MF, COLLADA and STEP: units, axes, colours and components as the file says."""

import re
import zipfile

import numpy as np
import pytest
import trimesh
from oracles.sound_scenes import kinds
from oracles.step_writer import step_of_a_box
from PIL import Image

import voxrt
from voxrt.voxelize import AssetError, load

BOX = trimesh.creation.box((10, 20, 40))
MODEL = """\
<model {unit} xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
 xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">
<resources>
<basematerials id="5"><base name="red" displaycolor="#FF0000"/>
<base name="blue" displaycolor="#0000FFFF"/></basematerials>
<m:colorgroup id="6"><m:color color="#00FF00"/></m:colorgroup>
<object id="1" name="part" pid="5" pindex="0"><mesh><vertices>{vertices}</vertices>
<triangles>{triangles}</triangles></mesh></object>
<object id="2"><components><component objectid="1"/>
<component objectid="1" transform="1 0 0 0 1 0 0 0 1 50 0 0"/></components></object>
</resources><build><item objectid="2"/></build></model>"""


def bounds(scene):
    points = [one.mesh.positions @ one.transform[:3, :3].T + one.transform[:3, 3] for one in scene.objects]
    return np.concatenate(points).min(axis=0), np.concatenate(points).max(axis=0)


def write_3mf(path, model):
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("3D/3dmodel.model", model)
    return path


def model_of_a_box(unit):
    vertices = "".join('<vertex x="{}" y="{}" z="{}"/>'.format(*corner) for corner in BOX.vertices)
    colours = ['pid="6" p1="0"'] * 2 + ['pid="5" p1="1"'] * 4 + [""] * 6
    triangles = "".join(
        '<triangle v1="{}" v2="{}" v3="{}" {}/>'.format(*face, colour)
        for face, colour in zip(BOX.faces, colours, strict=True)
    )
    return MODEL.format(unit=unit, vertices=vertices, triangles=triangles)


@pytest.mark.parametrize(("unit", "metres"), [("", 1e-3), ('unit="inch"', 0.0254)])
def test_3mf_has_units_components_and_colours(unit, metres, tmp_path):
    scene = load(write_3mf(tmp_path / "a.3mf", model_of_a_box(unit)))
    low, high = bounds(scene)
    np.testing.assert_allclose(low, np.array([-5, -20, -10]) * metres)
    np.testing.assert_allclose(high, np.array([55, 20, 10]) * metres)
    assert len(scene.objects) == 2
    assert scene.objects[0].mesh is scene.objects[1].mesh
    mesh = scene.objects[0].mesh
    shown = [scene.materials[number].colour for number in mesh.materials]
    assert shown == [(0, 255, 0)] * 2 + [(0, 0, 255)] * 4 + [(255, 0, 0)] * 6
    assert [one.name for one in scene.materials[1:3]] == ["red", "blue"]


def test_a_3mf_of_another_program(tmp_path):
    path = tmp_path / "b.3mf"
    path.write_bytes(trimesh.Scene(BOX).export(file_type="3mf"))
    built = voxrt.build(path, depth=5)
    assert built.solid_voxels == 8 * 16 * 32


def test_collada_has_a_unit_an_up_axis_and_colours(tmp_path):
    box = BOX.copy()
    box.visual.face_colors = (200, 30, 30, 255)
    text = box.export(file_type="dae").decode()
    assert "<up_axis>Y_UP</up_axis>" in text
    for axis, unit, low in (("Y", 1, (-5, -10, -20)), ("Z", 0.01, (-0.05, -0.2, -0.1))):
        path = tmp_path / f"{axis}.dae"
        path.write_text(
            text.replace("<up_axis>Y_UP</up_axis>", f'<unit name="u" meter="{unit}"/><up_axis>{axis}_UP</up_axis>')
        )
        scene = load(path)
        np.testing.assert_allclose(bounds(scene)[0], low)
        assert [one.colour for one in scene.materials[1:]] == [(200, 30, 30)]


def test_textures_of_collada_are_opened_as_those_of_other_formats(tmp_path):
    inner = tmp_path / "inner"
    inner.mkdir()
    image = Image.new("RGB", (2, 2), (0, 0, 255))
    image.save(tmp_path / "outside.png")
    image.save(inner / "map.png")
    (inner / "broken.png").write_bytes(b"none")
    box = BOX.copy()
    box.visual = trimesh.visual.TextureVisuals(uv=np.zeros((8, 2)), image=image)
    text = box.export(file_type="dae").decode()
    path = inner / "a.dae"
    for name, allowed, warned in (
        ("map.png", False, {}),
        ("../outside.png", False, {"outside": 1}),
        ("../outside.png", True, {}),
        ("broken.png", False, {"texture": 1}),
        ("gone.png", False, {"missing-texture": 1}),
    ):
        path.write_text(with_texture(text, name))
        scene = load(path, allow_outside=allowed)
        assert kinds(scene) == warned, name
        assert (scene.materials[1].colour == (0, 0, 255)) == (not warned), name


def with_texture(text, name):
    """Return a COLLADA file whose only effect has an image."""
    image = f'<library_images><image id="i" name="i"><init_from>{name}</init_from></image></library_images>'
    surface = '<newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>'
    sampler = '<newparam sid="t"><sampler2D><source>s</source></sampler2D></newparam>'
    text = re.sub(
        r"<diffuse>.*?</diffuse>", '<diffuse><texture texture="t" texcoord="UV"/></diffuse>', text, flags=re.DOTALL
    )
    text = text.replace("<library_effects>", image + "<library_effects>", 1)
    return re.sub(r"<profile_COMMON>", f"<profile_COMMON>{surface}{sampler}", text, count=1)


def test_off_is_read_as_the_user_says(tmp_path):
    path = tmp_path / "a.off"
    path.write_text(BOX.export(file_type="off"))
    scene = load(path, up="z", unit=0.1)
    np.testing.assert_allclose(bounds(scene)[1], (0.5, 2, 1))
    assert kinds(scene) == {}
    assert scene.objects[0].name == "a"


@pytest.mark.parametrize(
    ("header", "vertex", "face", "warned"),
    [
        ("OFF", "", "", {}),
        ("COFF", " 255 0 0 255", "", {"vertex-colour": 1}),
        ("OFF", "", " 9 9 9", {"vertex-colour": 1}),
    ],
)
def test_colours_of_off_are_named(header, vertex, face, warned, tmp_path):
    rows = "".join(f"{row}{vertex}\n" for row in ("0 0 0", "1 0 0", "0 1 0"))
    (tmp_path / "a.off").write_text(f"{header}\n3 1 0\n{rows}3 0 1 2{face}\n")
    assert kinds(load(tmp_path / "a.off")) == warned


@pytest.mark.parametrize(("unit", "metres"), [("SI_UNIT(.MILLI.,.METRE.)", 1e-3), ("SI_UNIT($,.METRE.)", 1)])
def test_step_is_read_in_metres_with_z_up(unit, metres, tmp_path):
    path = tmp_path / "a.step"
    path.write_text(step_of_a_box((1, 2, 4), unit))
    scene = load(path)
    np.testing.assert_allclose(bounds(scene), np.array([[0, 0, -2], [1, 4, 0]]) * metres, atol=1e-6)
    assert voxrt.build(path, depth=4).solid_voxels == 4 * 8 * 16


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("a.off", b"", "trimesh cannot read it"),
        ("a.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n", "trimesh cannot read it"),
        ("a.off", b"OFF\n3 1 0\n0,5 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "write 0.5"),
        ("a.3mf", b"PK\x03\x04", "is no 3MF package"),
        ("a.dae", b"<COLLADA>", "its XML is broken"),
        ("a.dae", b"<COLLADA/>", "has no triangles"),
        ("a.step", b"ISO-10303-21;", "OpenCASCADE cannot read it"),
        ("a.xyzzy", b"", "unknown kind of file '.xyzzy'; convert it"),
    ],
)
def test_what_cannot_be_read_is_refused(name, data, message, tmp_path):
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(AssetError, match=message):
        load(path)


def test_a_3mf_without_objects_or_with_another_unit_is_refused(tmp_path):
    with pytest.raises(AssetError, match="has the unit 'cubit'"):
        load(write_3mf(tmp_path / "a.3mf", model_of_a_box('unit="cubit"')))
    zipfile.ZipFile(tmp_path / "b.3mf", "w").close()
    with pytest.raises(AssetError, match="is no 3MF package"):
        load(tmp_path / "b.3mf")


def test_a_3mf_that_unpacks_to_far_more_than_its_size_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.3mf", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", " " * (80 << 20))
    with pytest.raises(AssetError, match="unpacks to more than 68 MiB"):
        load(tmp_path / "a.3mf")


def test_3mf_has_opacity(tmp_path):
    glass = model_of_a_box("").replace("#FF0000", "#FF000066")
    path = write_3mf(tmp_path / "a.3mf", glass)
    assert kinds(load(path))["transparent"] == 6
    assert "transparent" not in kinds(load(path, opaque_from=0.4))
    everything = glass.replace("#00FF00", "#00FF0011").replace("#0000FFFF", "#0000FF00")
    with pytest.raises(AssetError, match=r"shows nothing: (faces less opaque|fully transparent)"):
        load(write_3mf(tmp_path / "b.3mf", everything))


@pytest.mark.parametrize(
    ("of_file", "wrong"), [('p1="1"', 'p1="9"'), ('pid="5" p1="1"', 'pid="7" p1="1"'), ("#0000FFFF", "blue")]
)
def test_colours_that_a_3mf_lacks_are_counted(of_file, wrong, tmp_path):
    model = model_of_a_box("").replace(of_file, wrong)
    scene = load(write_3mf(tmp_path / "a.3mf", model))
    assert kinds(scene)["material-colour"] == 4


@pytest.mark.parametrize(
    ("emission", "diffuse", "right"),
    [("1 0 0.2 1", "0 0 0 1", (255, 0, 51)), ("1 0 0 1", "0 1 0 1", (0, 255, 0)), ("0 0 0 1", "0 0 0 1", (0, 0, 0))],
)
def test_a_collada_material_that_only_emits_shows_its_emission(emission, diffuse, right, tmp_path):
    box = BOX.copy()
    box.visual.face_colors = (200, 30, 30, 255)
    text = re.sub(
        r"<diffuse>.*?</diffuse>",
        f"<emission><color>{emission}</color></emission><diffuse><color>{diffuse}</color></diffuse>",
        re.sub(r"<emission>.*?</emission>", "", box.export(file_type="dae").decode(), flags=re.DOTALL),
        flags=re.DOTALL,
    )
    (tmp_path / "a.dae").write_text(text)
    assert load(tmp_path / "a.dae").materials[1].colour == right
