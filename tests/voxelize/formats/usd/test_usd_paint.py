"""displayColor in all interpolations, textures, and what feeds a shader."""

import numpy as np
import pytest
from oracles.sound_scenes import kinds
from oracles.usd_in_process import load_usd
from PIL import Image

from voxrt.voxelize.colour.appearance import sample
from voxrt.voxelize.colour.srgb import srgb_from_linear

RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)

# Two quads side by side, the second with its corners in another order.
QUADS = """
    point3f[] points = [(0,0,0),(1,0,0),(2,0,0),(0,1,0),(1,1,0),(2,1,0)]
    int[] faceVertexCounts = [4, 4]
    int[] faceVertexIndices = [0,1,4,3, 5,4,1,2]
    uniform token subdivisionScheme = "none"
"""


@pytest.fixture
def usd(tmp_path):
    def write(body, pixels=None):
        if pixels is not None:
            Image.fromarray(np.array(pixels, dtype=np.uint8)).save(tmp_path / "map.png")
        path = tmp_path / "stage.usda"
        path.write_text(f'#usda 1.0\n(\nupAxis = "Y"\nmetersPerUnit = 1\n)\n{body}\n')
        return load_usd(path)

    return write


def mesh(extra):
    return f'def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {{{QUADS}{extra}\n}}\n'


def colours_at(one, weights):
    rows = np.arange(len(one.mesh.triangles))
    found = sample(one.mesh.appearance, rows, np.tile(weights, (len(rows), 1)))
    return srgb_from_linear(found[:, :3])


def corner_colours(scene):
    """What each corner of each face shows: {(face's plane side, position): colour}."""
    (one,) = scene.objects
    found = {}
    for corner in range(3):
        weights = np.zeros(3)
        weights[corner] = 1.0
        for triangle, colour in enumerate(colours_at(one, weights).tolist()):
            place = one.mesh.positions[one.mesh.triangles[triangle, corner]]
            side = "left" if one.mesh.positions[one.mesh.triangles[triangle]].mean(axis=0)[0] < 1 else "right"
            found[side, int(place[0]), int(place[1])] = tuple(colour)
    return found


def test_uniform_colours(usd):
    found = corner_colours(
        usd(mesh('color3f[] primvars:displayColor = [(1,0,0), (0,0,1)] (\ninterpolation = "uniform"\n)'))
    )
    assert {colour for (side, *_), colour in found.items() if side == "left"} == {RED}
    assert {colour for (side, *_), colour in found.items() if side == "right"} == {BLUE}


@pytest.mark.parametrize("interpolation", ["vertex", "varying"])
def test_colours_of_points(usd, interpolation):
    values = "(1,0,0), (0,1,0), (0,0,1), (1,1,1), (1,1,1), (1,1,1)"
    found = corner_colours(
        usd(mesh(f'color3f[] primvars:displayColor = [{values}] (\ninterpolation = "{interpolation}"\n)'))
    )
    for side, x, y in found:
        assert found[side, x, y] == (WHITE if y else (RED, GREEN, BLUE)[x])


@pytest.mark.parametrize("orientation", ["rightHanded", "leftHanded"])
def test_indexed_colours_of_corners(usd, orientation):
    extra = 'color3f[] primvars:displayColor = [(1,0,0), (0,1,0)] (\ninterpolation = "faceVarying"\n)\n'
    extra += f'int[] primvars:displayColor:indices = [0,1,1,0, 1,0,0,1]\nuniform token orientation = "{orientation}"'
    found = corner_colours(usd(mesh(extra)))
    for side, x, y in found:
        expected = (RED, GREEN)[x] if side == "left" else (None, RED, GREEN)[x]
        assert found[side, x, y] == expected, (side, x, y)


def test_one_colour_written_many_times_is_a_material(usd):
    values = ", ".join(["(1, 0, 0)"] * 6)
    scene = usd(mesh(f'color3f[] primvars:displayColor = [{values}] (\ninterpolation = "vertex"\n)'))
    assert [(one.name, one.colour) for one in scene.materials[1:]] == [("#ff0000", RED)]
    assert scene.objects[0].mesh.appearance is None


def test_colours_that_do_not_fit_are_counted(usd):
    scene = usd(mesh('color3f[] primvars:displayColor = [(1,0,0), (0,1,0), (0,0,1)] (\ninterpolation = "vertex"\n)'))
    assert {one.kind for one in scene.warnings} == {"primvar"}


def material(inputs, nodes=""):
    return f"""def Material "look" {{
        token outputs:surface.connect = </look/s.outputs:surface>
        color3f inputs:appearance = (0, 0, 1)
        def Shader "s" {{
            uniform token info:id = "UsdPreviewSurface"
            {inputs}
            token outputs:surface
        }}
        {nodes}
    }}\n"""


def texture(extra="", st="", file="map.png"):
    return f"""def Shader "t" {{
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @./{file}@
            {extra}
            float2 inputs:st.connect = {st or "</look/r.outputs:result>"}
            float3 outputs:rgb
            float outputs:a
        }}
        def Shader "r" {{
            uniform token info:id = "UsdPrimvarReader_float2"
            string inputs:varname = "st"
            float2 outputs:result
        }}"""


DIFFUSE = "color3f inputs:diffuseColor.connect = </look/t.outputs:rgb>"
ST = """rel material:binding = </look>
    texCoord2f[] primvars:st = [(0,0),(0.5,0),(1,0),(0,1),(0.5,1),(1,1)] (
        interpolation = "vertex"
    )"""
WIDE = [[RED] * 8 + [BLUE] * 8] * 4


def middles(scene):
    return [tuple(colour) for colour in colours_at(scene.objects[0], (1 / 3, 1 / 3, 1 / 3)).tolist()]


def test_a_value_of_the_materials_interface(usd):
    scene = usd(material("color3f inputs:diffuseColor.connect = </look.inputs:appearance>") + mesh(ST))
    assert [(one.name, one.colour) for one in scene.materials[1:]] == [("look", BLUE)]


def test_a_texture(usd):
    scene = usd(material(DIFFUSE, texture()) + mesh(ST), WIDE)
    assert middles(scene) == [RED, RED, BLUE, BLUE]
    assert not scene.warnings
    assert [(one.name, one.colour) for one in scene.materials[1:]] == [("look", (188, 0, 188))]


def test_v_points_up_in_the_image(usd):
    scene = usd(material(DIFFUSE, texture()) + mesh(ST), [[RED]] * 8 + [[BLUE]] * 8)
    found = corner_colours(scene)
    assert len(found) == 8
    low = colours_at(scene.objects[0], (0.8, 0.1, 0.1))[0]
    assert tuple(low) == BLUE


@pytest.mark.parametrize(
    ("extra", "expected"),
    [
        ("float4 inputs:scale = (0.5, 1, 1, 1)", (188, 0, 0)),
        ("float4 inputs:bias = (0, 1, 0, 0)", (255, 255, 0)),
        ('token inputs:sourceColorSpace = "raw"', RED),
    ],
)
def test_scale_bias_and_colour_space(usd, extra, expected):
    assert middles(usd(material(DIFFUSE, texture(extra)) + mesh(ST), WIDE))[0] == expected


def test_raw_values_are_linear(usd):
    grey = [[(55, 55, 55)]]
    raw = usd(material(DIFFUSE, texture('token inputs:sourceColorSpace = "raw"')) + mesh(ST), grey)
    assert middles(raw)[0] == tuple([int(srgb_from_linear(55 / 255))] * 3)


def test_coordinates_are_scaled_turned_and_moved(usd):
    node = (
        texture(st="</look/x.outputs:result>")
        + """
        def Shader "x" {
            uniform token info:id = "UsdTransform2d"
            float2 inputs:in.connect = </look/r.outputs:result>
            float inputs:rotation = 180
            float2 inputs:scale = (1, 1)
            float2 inputs:translation = (1, 1)
            float2 outputs:result
        }"""
    )
    assert middles(usd(material(DIFFUSE, node) + mesh(ST), WIDE)) == [BLUE, BLUE, RED, RED]


def test_opacity_from_the_image_cuts(usd):
    opacity = "float inputs:opacity.connect = </look/t.outputs:a>\nfloat inputs:opacityThreshold = 0.3"
    pixels = [[(*RED, 0)] * 8 + [(*BLUE, 100)] * 8] * 4
    scene = usd(material(f"{DIFFUSE}\n{opacity}", texture()) + mesh(ST), pixels)
    assert len(scene.objects[0].mesh.triangles) == 2
    assert kinds(scene) == {"transparent": 2}


def test_a_primvar_feeds_the_shader(usd):
    inputs = "color3f inputs:diffuseColor.connect = </look/p.outputs:result>"
    node = """def Shader "p" {
            uniform token info:id = "UsdPrimvarReader_float3"
            string inputs:varname = "tint"
            float3 outputs:result
        }"""
    extra = (
        'rel material:binding = </look>\ncolor3f[] primvars:tint = [(1,0,0), (0,1,0)] (\ninterpolation = "uniform"\n)'
    )
    assert middles(usd(material(inputs, node) + mesh(extra))) == [RED, RED, GREEN, GREEN]


def test_missing_textures_take_their_fallback(usd):
    node = texture("float4 inputs:fallback = (0, 1, 0, 1)", file="nowhere.png")
    scene = usd(material(DIFFUSE, node) + mesh(ST))
    assert [(one.name, one.colour) for one in scene.materials[1:]] == [("look", GREEN)]
    assert {one.kind for one in scene.warnings} == {"missing-texture"}


def test_textures_without_coordinates_are_counted(usd):
    scene = usd(material(DIFFUSE, texture()) + mesh("rel material:binding = </look>"), WIDE)
    assert {one.kind for one in scene.warnings} == {"texture"}


@pytest.mark.parametrize(("written", "shown"), [("", BLUE), ("float2 inputs:st = (0.9, 0.9)", GREEN)])
def test_textures_to_which_no_coordinates_are_connected_show_one_point(usd, written, shown):
    # UsdPreviewSurface specification, UsdUVTexture: st falls back to (0, 0), the image's lower left corner.
    node = f"""def Shader "t" {{
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @./map.png@
            token inputs:wrapS = "clamp"
            token inputs:wrapT = "clamp"
            {written}
            float3 outputs:rgb
        }}"""
    scene = usd(material(DIFFUSE, node) + mesh("rel material:binding = </look>"), [[RED, GREEN], [BLUE, WHITE]])
    assert middles(scene) == [shown] * 4
    assert [(one.kind, one.count) for one in scene.warnings if one.kind == "texture"] == [("texture", 2)]


def test_a_broken_image(usd, tmp_path):
    (tmp_path / "map.png").write_bytes(b"none")
    scene = usd(material(DIFFUSE, texture()) + mesh(ST))
    assert "map.png: the image is broken or of an unknown kind" in scene.warnings[0].message
