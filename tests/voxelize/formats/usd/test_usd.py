"""USD stages written here: what is drawn, where, of what, and what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.sound_scenes import kinds, read_or_refused
from oracles.surfaces import bounds, scene_triangles, volume
from oracles.usd_in_process import load_usd

from voxrt.voxelize import AssetError, BoxCollider, DoesNotFitError, HullCollider, MeshCollider, SphereCollider

CUBE = """
    point3f[] points = [(0,0,0),(1,0,0),(1,1,0),(0,1,0),(0,0,1),(1,0,1),(1,1,1),(0,1,1)]
    int[] faceVertexCounts = [4,4,4,4,4,4]
    int[] faceVertexIndices = [0,3,2,1, 4,5,6,7, 0,1,5,4, 2,3,7,6, 1,2,6,5, 0,4,7,3]
    uniform token subdivisionScheme = "none"
"""


@pytest.fixture
def usd(tmp_path):
    def write(body, meta='upAxis = "Y"\n metersPerUnit = 1', name="stage.usda", **options):
        path = tmp_path / name
        lines = body.replace(" }", "\n}")  # an attribute ends with its line
        path.write_text(f"#usda 1.0\n(\n {meta}\n)\n{lines}\n")
        return load_usd(path, **options)

    return write


def mesh(extra="", name="cube", apis=""):
    return f'def Mesh "{name}" ({apis})\n{{{CUBE}{extra}\n}}\n'


def material(name, colour, extra=""):
    return f"""def Material "{name}" {{
        token outputs:surface.connect = </{name}/s.outputs:surface>
        def Shader "s" {{
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor = {colour}
            {extra}
            token outputs:surface
        }}
    }}\n"""


def test_a_cube(usd):
    scene = usd(mesh())
    assert [one.name for one in scene.objects] == ["/cube"]
    assert volume(scene_triangles(scene)) == pytest.approx(1.0)
    assert kinds(scene) == {"default-material": 6}


@pytest.mark.parametrize(
    ("up", "high"), [("X", [[-2, 0, 0], [0, 4, 6]]), ("Y", [[0, 0, 0], [4, 2, 6]]), ("Z", [[0, 0, -2], [4, 6, 0]])]
)
def test_up_and_unit_of_the_root_layer(usd, up, high):
    scene = usd(
        mesh('double3 xformOp:scale = (2, 1, 3)\nuniform token[] xformOpOrder = ["xformOp:scale"]'),
        f'upAxis = "{up}"\n metersPerUnit = 2',
    )
    assert np.allclose(bounds(scene_triangles(scene)), high)
    assert volume(scene_triangles(scene)) == pytest.approx(48.0)


def test_left_handed_faces_and_mirrors_enclose_a_positive_volume(usd):
    turned = 'uniform token orientation = "leftHanded"'
    assert volume(scene_triangles(usd(mesh(turned)))) == pytest.approx(-1.0)
    mirror = 'double3 xformOp:scale = (-1, 1, 1)\nuniform token[] xformOpOrder = ["xformOp:scale"]'
    assert volume(scene_triangles(usd(mesh(mirror)))) == pytest.approx(1.0)


def test_holes_and_short_faces_are_left_out(usd):
    scene = usd(mesh("int[] holeIndices = [1, 5]"))
    assert len(scene_triangles(scene)) == 8
    assert kinds(scene) == {"default-material": 4}


@pytest.mark.parametrize(
    ("kind", "attributes", "exact", "size"),
    [
        ("Cube", "double size = 3", 27.0, (3, 3, 3)),
        ("Sphere", "double radius = 2", 4 / 3 * np.pi * 8, (4, 4, 4)),
        ("Cylinder", 'double radius = 1\ndouble height = 5\nuniform token axis = "X"', 5 * np.pi, (5, 2, 2)),
        ("Cylinder", 'double radius = 1\ndouble height = 5\nuniform token axis = "Y"', 5 * np.pi, (2, 5, 2)),
        ("Cone", "double radius = 1\ndouble height = 3", np.pi, (2, 2, 3)),
        ("Capsule", "double radius = 1\ndouble height = 3", 13 / 3 * np.pi, (2, 2, 5)),
        ("Cylinder_1", "double radiusBottom = 2\ndouble radiusTop = 1\ndouble height = 3", 7 * np.pi, (4, 4, 3)),
        ("Capsule_1", "double radiusBottom = 1\ndouble radiusTop = 1\ndouble height = 3", 13 / 3 * np.pi, (2, 2, 5)),
    ],
)
def test_solids_against_closed_forms(usd, kind, attributes, exact, size):
    triangles = scene_triangles(usd(f'def {kind} "solid" {{\n{attributes}\n}}'))
    assert volume(triangles) == pytest.approx(exact, rel=2e-3)
    assert np.ptp(bounds(triangles), axis=0) == pytest.approx(size)
    # Closed: each edge is passed once each way.
    edges = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]).round(9).reshape(-1, 6)
    there = sorted(map(tuple, edges + 0.0))
    back = sorted(map(tuple, edges[:, [3, 4, 5, 0, 1, 2]] + 0.0))
    assert there == back


def test_a_cones_tip_is_on_its_axis_positive_side(usd):
    triangles = scene_triangles(usd('def Cone "c" { uniform token axis = "Y" }'))
    (tip,) = {tuple(corner) for corner in triangles.reshape(-1, 3) if corner[1] == 1}
    assert tip == (0, 1, 0)


@pytest.mark.parametrize(("axis", "size"), [("X", (0, 3, 2)), ("Y", (2, 0, 3)), ("Z", (2, 3, 0))])
def test_a_plane_faces_its_axis(usd, axis, size):
    plane = f'double width = 2\ndouble length = 3\nuniform token axis = "{axis}"'
    triangles = scene_triangles(usd(f'def Plane "p" {{\n{plane}\n}}'))
    assert np.ptp(bounds(triangles), axis=0) == pytest.approx(size)
    a, b, c = triangles[0]
    assert np.cross(b - a, c - a)["XYZ".index(axis)] > 0


def test_instances_share_a_mesh(usd):
    body = f'class "proto" {{ {mesh()} }}\n'
    for i in range(3):
        body += f"""def Xform "i{i}" (
                instanceable = true
                inherits = </proto>
            ) {{
            double3 xformOp:translate = ({2 * i}, 0, 0)
            uniform token[] xformOpOrder = ["xformOp:translate"]
        }}\n"""
    scene = usd(body)
    assert [one.name for one in scene.objects] == ["/i0/cube", "/i1/cube", "/i2/cube"]
    assert len({id(one.mesh) for one in scene.objects}) == 1
    assert volume(scene_triangles(scene)) == pytest.approx(3.0)
    assert bounds(scene_triangles(scene))[1, 0] == 5


def test_what_is_not_drawn_is_counted(usd):
    body = """def Xform "off" (active = false) {}
        def Xform "hidden" {
            token visibility = "invisible"
            def Cube "in" {}
        }
        def Cube "guide" (prepend apiSchemas = ["PhysicsCollisionAPI"]) { uniform token purpose = "guide" }
        def Cube "proxy" { uniform token purpose = "proxy" }
        def Cube "render" { uniform token purpose = "render" }
        def SphereLight "lamp" {}
        def Points "dots" {}
    """
    scene = usd(mesh() + body)
    assert [(one.name, one.hidden) for one in scene.objects] == [("/cube", False), ("/render", False), ("/guide", True)]
    assert [(one.kind, one.count) for one in scene.warnings] == [
        ("default-material", 7),
        ("invisible", 1),
        ("purpose", 1),
        ("collider", 1),
        ("purpose", 1),
        ("no-shape", 1),
        ("unsupported-prim", 1),
    ]


def test_materials_by_subset_and_prim(usd):
    subset = """def GeomSubset "front" (prepend apiSchemas = ["MaterialBindingAPI"]) {
        uniform token elementType = "face"
        uniform token familyName = "materialBind"
        int[] indices = [1, 2]
        rel material:binding = </red>
    }
    rel material:binding = </dim>"""
    scene = usd(
        material("red", "(1, 0, 0)")
        + material("dim", "(0.5, 0.2140411, 0.0)")
        + mesh(subset, apis='prepend apiSchemas = ["MaterialBindingAPI"]')
    )
    assert [(one.name, one.colour) for one in scene.materials[1:]] == [("red", (255, 0, 0)), ("dim", (188, 127, 0))]
    assert scene.objects[0].mesh.materials.tolist() == [2, 2, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2]
    assert scene.warnings == ()


def test_the_parents_binding_and_one_material_of_one_name_and_colour(usd):
    api = 'prepend apiSchemas = ["MaterialBindingAPI"]'
    body = material("red", "(1, 0, 0)")
    body += f'def Xform "a" ({api}) {{\nrel material:binding = </red>\n{mesh()}}}\n'
    body += 'def Scope "other" {\n' + material("red", "(1, 0, 0)").replace("</red", "</other/red") + "}\n"
    body += mesh("rel material:binding = </other/red>", "second", api)
    scene = usd(body)
    assert [one.name for one in scene.materials] == ["empty", "red"]


def test_display_colour(usd):
    scene = usd(mesh("color3f[] primvars:displayColor = [(1, 0.2140411, 0)]"))
    assert [(one.name, one.colour) for one in scene.materials[1:]] == [("#ff7f00", (255, 127, 0))]


def test_what_lets_light_through_is_air(usd):
    body = material("glass", "(1, 0, 0)", "float inputs:opacity = 0.1")
    body += mesh("rel material:binding = </glass>", apis='prepend apiSchemas = ["MaterialBindingAPI"]') + mesh(
        name="solid"
    )
    scene = usd(body)
    assert [one.name for one in scene.objects] == ["/solid"]
    assert kinds(scene)["transparent"] == 6
    assert [one.name for one in usd(body, opaque_from=0.1).objects] == ["/cube", "/solid"]


@pytest.mark.parametrize(("diffuse", "colour"), [("(0, 0, 0)", (255, 0, 0)), ("(0, 1, 0)", (0, 255, 0))])
def test_what_emits_alone_shows_its_emission(diffuse, colour, usd):
    body = material("lamp", diffuse, "color3f inputs:emissiveColor = (1, 0, 0)")
    body += mesh("rel material:binding = </lamp>", apis='prepend apiSchemas = ["MaterialBindingAPI"]')
    assert usd(body).materials[1].colour == colour


@pytest.mark.parametrize(
    ("approximation", "kind"),
    [
        ("none", MeshCollider),
        ("meshSimplification", MeshCollider),
        ("convexHull", HullCollider),
        ("convexDecomposition", HullCollider),
        ("boundingCube", BoxCollider),
        ("boundingSphere", SphereCollider),
    ],
)
def test_mesh_colliders(usd, approximation, kind):
    apis = 'prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"]'
    scene = usd(mesh(f'uniform token physics:approximation = "{approximation}"', apis=apis))
    (collider,) = scene.objects[0].colliders
    assert isinstance(collider, kind)
    if isinstance(collider, BoxCollider):
        assert collider.minimum.tolist() == [0, 0, 0]
        assert collider.maximum.tolist() == [1, 1, 1]
        assert collider.pow2
    if isinstance(collider, SphereCollider):
        assert collider.centre.tolist() == [0.5, 0.5, 0.5]
        assert collider.radius == pytest.approx(np.sqrt(0.75))


def test_a_convex_decomposition_has_a_hull_a_connected_part(usd):
    cube = CUBE.replace("(0,1,1)]", "(0,1,1),(5,0,0),(6,0,0),(5,1,0),(5,0,1)]")
    cube = cube.replace("[4,4,4,4,4,4]", "[4,4,4,4,4,4,3,3,3,3]")
    cube = cube.replace("0,4,7,3]", "0,4,7,3, 8,10,9, 8,11,10, 8,9,11, 9,10,11]")
    apis = 'prepend apiSchemas = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"]'
    scene = usd(f'def Mesh "m" ({apis}) {{{cube}\nuniform token physics:approximation = "convexDecomposition"\n}}')
    assert [len(collider.positions) for collider in scene.objects[0].colliders] == [8, 4]
    assert kinds(scene)["collider"] == 1


def test_solid_colliders_and_disabled_ones(usd):
    api = '(prepend apiSchemas = ["PhysicsCollisionAPI"])'
    scene = usd(
        f"""def Sphere "s" {api} {{ double radius = 3 }}
        def Cube "c" {api} {{}}
        def Capsule "p" {api} {{}}
        def Cube "d" {api} {{ bool physics:collisionEnabled = 0 }}
        def Plane "g" {api} {{}}"""
    )
    assert [tuple(type(one) for one in each.colliders) for each in scene.objects] == [
        (SphereCollider,),
        (BoxCollider,),
        (HullCollider,),
        (),
        (),
    ]
    assert scene.objects[0].colliders[0].radius == 3


def test_missing_references_are_reported_and_nothing_is_printed(usd, capfd):
    scene = usd(mesh() + 'def Xform "gone" (references = @nowhere.usda@) {}')
    (composition,) = [one for one in scene.warnings if one.kind == "composition"]
    assert composition.message.startswith("asset nowhere.usda could not be opened")
    assert capfd.readouterr() == ("", "")


def test_layers_of_another_unit(usd, tmp_path):
    (tmp_path / "inch.usda").write_text(
        '#usda 1.0\n(\ndefaultPrim = "cube"\nmetersPerUnit = 0.0254\nupAxis = "Z"\n)\n' + mesh()
    )
    scene = usd('def "a" (references = @./inch.usda@) {}')
    assert volume(scene_triangles(scene)) == pytest.approx(1.0)
    assert kinds(scene)["layers-disagree"] == 2


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("", "shows nothing"),
        (mesh().replace("[4,4,4,4,4,4]", "[4,4,4,4,4,5]"), "/cube: faceVertexCounts ask for 25 corners"),
        (mesh().replace("0,4,7,3", "0,4,7,8"), "/cube: faceVertexIndices go from 0 to 8 and points has 8"),
        (mesh().replace("0,4,7,3", "0,4,7,-1"), "/cube: faceVertexIndices go from -1 to 7 and points has 8"),
        (mesh().replace("(0,1,1)]", "(0,1,nan)]"), "/cube: points has a coordinate that is not a finite number"),
        (mesh().replace("[4,4,4,4,4,4]", "[]"), "shows nothing (meshes without faces were left out)"),
        ('def Sphere "s" { double radius = -1 }', "/s: radius -1.0 is not a length"),
        ('def Cone "s" { double height = inf }', "/s: height inf is not a length"),
        ('def Cone "s" { uniform token axis = "W" }', "/s: axis 'W' is not X, Y or Z"),
        (
            mesh('def GeomSubset "s" { int[] indices = [6]\nuniform token familyName = "materialBind" }'),
            "beyond the mesh's 6",
        ),
        ("def Mesh cube {", "line 6"),
        (
            mesh().replace("int[] faceVertexC", "nt[] faceVertexC"),
            "/cube: faceVertexCounts holds values that are not integers",
        ),
        (
            mesh().replace("int[] faceVertexI", "double[] faceVertexI"),
            "/cube: faceVertexIndices holds values that are not integers",
        ),
        (
            'def Mesh "m" { float[] points = [1, 2]\nint[] faceVertexCounts = [3] }',
            "/m: points holds values that are not points",
        ),
        (
            "def Mesh \"m\" { string[] points = ['a']\nint[] faceVertexCounts = [3] }",
            "/m: points holds values that are not points",
        ),
        ('def Sphere "s" { string radius = "one" }', "/s: radius one is not a length"),
    ],
)
def test_refused(usd, capfd, body, message):
    with pytest.raises(AssetError) as caught:
        usd(body)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("unit", ["0", "-1", "inf", "nan", "2.7e-314", "1e300"])
def test_a_unit_that_is_no_length(usd, unit):
    with pytest.raises(AssetError, match="metersPerUnit"):
        usd(mesh(), f"metersPerUnit = {unit}")


@pytest.mark.parametrize("name", ["a.usd", "a.usdc", "a.usdz", "a.usda"])
def test_files_of_another_kind(tmp_path, capfd, name):
    for content in (b"", b"\0" * 100, b"PXR-USDC" + b"\xff" * 200, b"PK\3\4" + b"\xff" * 200):
        path = tmp_path / name
        path.write_bytes(content)
        with pytest.raises(AssetError):
            load_usd(path)
    assert capfd.readouterr() == ("", "")


def test_too_many_materials(usd):
    body = "".join(
        mesh(f"color3f[] primvars:displayColor = [({i / 300}, {1 - i / 300}, {(i * 7 % 300) / 300})]", f"m{i}")
        for i in range(300)
    )
    with pytest.raises(DoesNotFitError, match="255 materials"):
        usd(body)


def test_text_that_is_no_utf8(tmp_path):
    path = tmp_path / "stage.usda"
    path.write_bytes(b"#usda 1.0\n(\n)\n" + mesh().encode().replace(b"point3f[]", b"point\x983f[]"))
    with pytest.raises(AssetError) as caught:
        load_usd(path)
    assert "\n" not in str(caught.value)


DAMAGED = f"""#usda 1.0
(
    metersPerUnit = 1
)
{mesh("color3f[] primvars:displayColor = [(1, 0, 0)]")}
def PointInstancer "many" {{
    rel prototypes = </many/ball>
    int[] protoIndices = [0, 0]
    point3f[] positions = [(0, 0, 0), (3, 0, 0)]
    def Sphere "ball" {{
        double radius = 0.5
    }}
}}
{material("red", "(1, 0, 0)")}
""".encode()


@settings(max_examples=60)
@given(st.lists(st.tuples(st.integers(0, len(DAMAGED) - 1), st.integers(0, 255)), min_size=1, max_size=3))
def test_damaged_stages_are_read_or_refused(tmp_path_factory, damage):
    data = bytearray(DAMAGED)
    for place, byte in damage:
        data[place] = byte
    path = tmp_path_factory.mktemp("usd") / "stage.usda"
    path.write_bytes(data)
    read_or_refused(load_usd, path)


def test_messages_that_differ_in_the_prim_alone_are_one_warning(usd):
    paint = 'def Material "paint" { }\n'
    binding = "\nrel material:binding = </paint>"
    scene = usd(paint + "".join(mesh(binding, name=f"part_{number}") for number in range(3)))
    (found,) = [one for one in scene.warnings if one.message.startswith("USD reports")]
    assert found.count == 3
    assert "/part_0" in found.message


def test_a_refusal_stays_short_however_long_a_path_is(usd):
    with pytest.raises(AssetError) as error:
        usd('def X "a" {\n' * 5000)
    assert len(str(error.value)) < 1500
