"""3MF packages of several model parts, as slicers write them: which object is shown where, in whose colours."""

import zipfile

import numpy as np
import pytest
from oracles.meshes import box_mesh
from oracles.sound_scenes import kinds

from voxrt.voxelize import AssetError, load

CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
MATERIAL = "http://schemas.microsoft.com/3dmanufacturing/material/2015/02"
PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
TYPE = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"


def model(resources, build="", unit="millimeter"):
    return (
        f'<model unit="{unit}" xmlns="{CORE}" xmlns:m="{MATERIAL}" xmlns:p="{PRODUCTION}">'
        f"<resources>{resources}</resources><build>{build}</build></model>"
    )


def box(number, size, own="", faces=""):
    """An object: a box from the origin with sides of `size`."""
    mesh = box_mesh((0, 0, 0), size)
    vertices = "".join('<vertex x="{}" y="{}" z="{}"/>'.format(*corner) for corner in mesh.positions)
    triangles = "".join('<triangle v1="{}" v2="{}" v3="{}" {}/>'.format(*face, faces) for face in mesh.triangles)
    return (
        f'<object id="{number}" name="box {number}" {own}><mesh><vertices>{vertices}</vertices>'
        f"<triangles>{triangles}</triangles></mesh></object>"
    )


def materials(number, **colours):
    bases = "".join(f'<base name="{name}" displaycolor="{colour}"/>' for name, colour in colours.items())
    return f'<basematerials id="{number}">{bases}</basematerials>'


def component(number, part="", move=(0, 0, 0), tag="component"):
    path = f'p:path="{part}"' if part else ""
    return f'<{tag} objectid="{number}" {path} transform="1 0 0 0 1 0 0 0 1 {move[0]} {move[1]} {move[2]}"/>'


def item(number, part="", move=(0, 0, 0)):
    return component(number, part, move, "item")


def assembly(number, *components):
    return f'<object id="{number}" name="assembly"><components>{"".join(components)}</components></object>'


def write(path, parts):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in parts.items():
            archive.writestr(name, text)
    return path


def shown(scene):
    """Name, lowest and highest corner in the file's frame and millimetres, and the only material, of each object."""
    rows = []
    for one in scene.objects:
        x, y, z = (one.mesh.positions @ one.transform[:3, :3].T + one.transform[:3, 3]).T * 1000
        points = np.stack([x, -z, y], axis=1)
        (number,) = np.unique(one.mesh.materials)
        name = scene.materials[number].name
        rows.append((one.name, points.min(0).round(6).tolist(), points.max(0).round(6).tolist(), name))
    return rows


A, B = "/3D/Objects/a.model", "/3D/Objects/b.model"
PARTS = {
    # Numbers are those of their part: all parts have objects 1 and 2, and a group 5.
    "3D/Objects/a.model": model(
        materials(5, red="#FF0000", blue="#0000FF")
        + box(1, (1, 1, 1), 'pid="5" pindex="0"')
        + box(2, (2, 4, 6), 'pid="5" pindex="1"')
    ),
    "3D/Objects/b.model": model(
        materials(5, green="#00FF00")
        + box(1, (3, 3, 3), 'pid="5" pindex="0"')
        + assembly(2, component(1, "", (9, 0, 0)))
    ),
}


def test_components_show_objects_of_other_parts_in_the_colours_of_these(tmp_path):
    resources = (
        materials(5, grey="#808080")
        + box(1, (8, 8, 8), 'pid="5" pindex="0"')
        + assembly(
            2, component(2, A, (10, 0, 0)), component(2, A, (20, 0, 0)), component(1), component(2, B, (0, 50, 0))
        )
    )
    root = {"3D/3dmodel.model": model(resources, item(2, "", (0, 0, 7)) + item(1, B, (100, 0, 0)))}
    scene = load(write(tmp_path / "a.3mf", root | PARTS))
    assert shown(scene) == [
        ("box 2 [0]", [10, 0, 7], [12, 4, 13], "blue"),
        ("box 2 [1]", [20, 0, 7], [22, 4, 13], "blue"),
        ("box 1 [0]", [0, 0, 7], [8, 8, 15], "grey"),
        ("box 1 [1]", [9, 50, 7], [12, 53, 10], "green"),
        ("box 1 [2]", [100, 0, 0], [103, 3, 3], "green"),
    ]
    assert scene.objects[0].mesh is scene.objects[1].mesh
    assert scene.objects[3].mesh is scene.objects[4].mesh
    assert kinds(scene) == {}
    colours = {one.name: one.colour for one in scene.materials[1:]}
    assert colours == {"blue": (0, 0, 255), "grey": (128, 128, 128), "green": (0, 255, 0)}


def test_the_root_is_what_the_package_says(tmp_path):
    relations = f'<Relationships><Relationship Target="/Parts/Main.model" Id="r" Type="{TYPE}"/></Relationships>'
    parts = {"_rels/.rels": relations, "Parts/Main.model": model(box(1, (1, 2, 3)), item(1))}
    scene = load(write(tmp_path / "a.3mf", parts | {"3D/3dmodel.model": model(box(1, (9, 9, 9)), item(1))}))
    assert shown(scene) == [("box 1", [0, 0, 0], [1, 2, 3], "default")]


def test_colours_at_corners_and_those_that_are_missing(tmp_path):
    group = '<m:colorgroup id="6"><m:color color="#FF0000"/><m:color color="#00FF00"/></m:colorgroup>'
    textures = '<m:texture2dgroup id="7" texid="1"><m:tex2coord u="0" v="0"/></m:texture2dgroup>'
    resources = (
        group
        + textures
        + box(1, (1, 1, 1), faces='pid="6" p1="0" p2="1" p3="0"')
        + box(2, (1, 1, 1), faces='pid="7" p1="0"')
        + box(3, (1, 1, 1), faces='pid="6" p1="2"')
    )
    scene = load(write(tmp_path / "a.3mf", {"3D/3dmodel.model": model(resources, item(1) + item(2) + item(3))}))
    assert scene.objects[0].mesh.appearance.colours[:, :, :3].tolist() == [[[1, 0, 0], [0, 1, 0], [1, 0, 0]]] * 12
    assert [scene.materials[one.mesh.materials[0]].name for one in scene.objects[1:]] == ["default", "default"]
    assert kinds(scene) == {"material-colour": 24}


def test_parts_in_another_unit_are_told(tmp_path):
    parts = {"3D/3dmodel.model": model("", item(1, A)), "3D/Objects/a.model": model(box(1, (1, 2, 3)), unit="inch")}
    scene = load(write(tmp_path / "a.3mf", parts))
    assert shown(scene) == [("box 1", [0, 0, 0], [1, 2, 3], "default")]
    assert kinds(scene) == {"unit": 1}


@pytest.mark.parametrize(
    ("resources", "build", "message"),
    [
        ("", item(1, "/3D/Objects/none.model"), r"has no part '3d/objects/none\.model', which it shows"),
        ("", item(3, A), "3d/objects/a.model: shows the object '3', which is not in it"),
        (assembly(1, component(1)), item(1), "components more than 32 levels deep"),
        ("".join(assembly(i, component(i + 1), component(i + 1)) for i in range(25)) + box(25, (1, 1, 1)), item(0),
         "shows more than 100,000 objects"),
        (box(1, (1, 1, 1)).replace('y="1.0"', 'y="x"'), item(1), "an element <object> is not as 3MF has it"),
        (box(1, (1, 1, 1)).replace('v1="0"', 'v1="8"', 1), item(1), r"triangles\[\d+\] names vertex 8"),
        (box(1, (1, 1, 1)), item(1).replace("1 0 0 0", "1 0 0"), "an element <item> is not as 3MF has it"),
        (box(1, (1, 1, 1)), "", "has no triangles"),
    ],
)  # fmt: skip
def test_what_is_not_there_is_refused(resources, build, message, tmp_path):
    path = write(tmp_path / "a.3mf", {"3D/3dmodel.model": model(resources, build)} | PARTS)
    with pytest.raises(AssetError, match=message) as refused:
        load(path)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("space", "attribute"),
    [
        ("", 'paint_color="4"'),
        ('xmlns:slic3rpe="http://schemas.slic3r.org/3mf/2017/06"', 'slic3rpe:mmu_segmentation="8"'),
    ],
)
def test_what_slicers_paint_is_named(space, attribute, tmp_path):
    """The colours of filaments stand in the settings of the slicer, beside the model."""
    text = model(box(1, (1, 2, 3), faces=attribute), item(1)).replace("<model", f"<model {space}")
    settings = '<config><object id="1"><metadata key="extruder" value="2"/></object></config>'
    scene = load(write(tmp_path / "a.3mf", {"3D/3dmodel.model": text}))
    (warning,) = scene.warnings
    assert (warning.kind, warning.count) == ("material-colour", 12)
    assert "painted in a slicer" in warning.message
    for name, warned in (("Model_Settings", 2), ("Slic3r_PE_model", 2), ("other", 1)):
        parts = {"3D/3dmodel.model": text, f"Metadata/{name}.config": settings}
        assert len(load(write(tmp_path / "b.3mf", parts)).warnings) == warned
