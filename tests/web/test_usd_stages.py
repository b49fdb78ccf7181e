"""USD stages on the page: the words, materials and objects of ``voxrt build``, for text and for binary files."""

from __future__ import annotations

import hashlib
import zipfile
from pathlib import Path

import numpy as np
import pytest
from assets import asset
from fakes.site import node, site
from PIL import Image

import voxrt

SCRIPT = Path(__file__).with_name("build_and_render.mjs")
DEPTH = 5

CUBE = """
    uniform token subdivisionScheme = "none"
    int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]
    int[] faceVertexIndices = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1.3, 1.1)]
"""
BINDS = '(\n    prepend apiSchemas = ["MaterialBindingAPI"]\n)'


def at(x: float, y: float = 0, z: float = 0) -> str:
    return f"""
    double3 xformOp:translate = ({x}, {y}, {z})
    uniform token[] xformOpOrder = ["xformOp:translate"]
"""


def material(name: str, inputs: str) -> str:
    return f"""
def Material "{name}"
{{
    token outputs:surface.connect = </looks/{name}/surface.outputs:surface>
    def Shader "surface"
    {{
        uniform token info:id = "UsdPreviewSurface"
        {inputs}
        token outputs:surface
    }}
}}
"""


def plain(name: str, colour: str) -> str:
    return material(name, f"color3f inputs:diffuseColor = ({colour})")


LOOKS = f"""
def Scope "looks"
{{
{plain("stone", "0.2, 0.3, 0.5")}{plain("clay", "0.8, 0.1, 0.2")}{plain("slate", "0.1, 0.6, 0.3")}
}}
"""


def stage(body: str, header: str = 'metersPerUnit = 1\n    upAxis = "Y"', looks: str = LOOKS) -> str:
    return f"#usda 1.0\n(\n    {header}\n)\n{looks}{body}"


def subset(name: str, faces: str, look: str, family: str = "materialBind") -> str:
    return f"""
    def GeomSubset "{name}" {BINDS}
    {{
        uniform token familyName = "{family}"
        int[] indices = [{faces}]
        rel material:binding = </looks/{look}>
    }}
"""


def shown(name: str, colours: str, interpolation: str, more: str = "") -> str:
    return f"""
def Mesh "{name}"
{{{CUBE}{more}
    color3f[] primvars:displayColor = [{colours}] (
        interpolation = "{interpolation}"
    )
}}
"""


CORNERS = ", ".join(f"({one / 24}, {1 - one / 24}, 0.5)" for one in range(24))
FACES = "(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (0.5, 0.5, 0.5)"
POINTS = "(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 1, 1), (1, 0, 1), (0.2, 0.2, 0.2), (0.9, 0.9, 0.9)"
TEXTURED = """
def Material "paper"
{
    token outputs:surface.connect = </looks/paper/surface.outputs:surface>
    def Shader "surface"
    {
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </looks/paper/image.outputs:rgb>
        token outputs:surface
    }
    def Shader "image"
    {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @paper.png@
        float2 inputs:st.connect = </looks/paper/moved.outputs:result>
        token inputs:wrapS = "mirror"
        token inputs:wrapT = "repeat"
        float4 inputs:scale = (0.8, 1, 0.5, 1)
        float3 outputs:rgb
    }
    def Shader "moved"
    {
        uniform token info:id = "UsdTransform2d"
        float2 inputs:in.connect = </looks/paper/reader.outputs:result>
        float inputs:rotation = 30
        float2 inputs:scale = (2, 1.5)
        float2 inputs:translation = (0.1, 0.2)
        float2 outputs:result
    }
    def Shader "reader"
    {
        uniform token info:id = "UsdPrimvarReader_float2"
        string inputs:varname = "map"
        float2 outputs:result
    }
}
"""
COORDINATES = ", ".join(["(0, 0)", "(1, 0)", "(1, 1)", "(0, 1)"] * 6)

OUTLINE = ((0, 0), (4, 0), (4, 3), (3, 3), (3, 1), (1, 1), (1, 3), (0, 3))
SIDES = [corner for i in range(8) for corner in (i, (i + 1) % 8, 8 + (i + 1) % 8, 8 + i)]

STAGES = {
    "bindings": stage(f"""
def Xform "a" {BINDS}
{{
    rel material:binding = </looks/clay>
    def Mesh "inherits"
    {{{CUBE}
    }}
    def Mesh "nearest" {BINDS}
    {{{CUBE}{at(2)}
        rel material:binding = </looks/stone>
    }}
    def Xform "strong" {BINDS}
    {{
        rel material:binding = </looks/slate> (
            bindMaterialAs = "strongerThanDescendants"
        )
        def Mesh "weaker" {BINDS}
        {{{CUBE}{at(4)}
            rel material:binding = </looks/stone>
        }}
    }}
    def Mesh "previewed" {BINDS}
    {{{CUBE}{at(6)}
        rel material:binding:preview = </looks/slate>
        rel material:binding = </looks/stone>
    }}
}}
def Mesh "bare"
{{{CUBE}{at(0, 2)}
}}
def Mesh "broken" {BINDS}
{{{CUBE}{at(2, 2)}
    rel material:binding = </looks/none>
}}
"""),
    "subsets": stage(f"""
def Mesh "a" {BINDS}
{{{CUBE}
    rel material:binding = </looks/stone>{subset("one", "0, 2", "clay")}{subset("two", "1, 2", "slate")}
    {subset("three", "4", "clay", "other")}
}}
def Mesh "b"
{{{CUBE}{at(2)}{subset("one", "3", "slate")}
}}
"""),
    "display colours": stage(
        shown("a", "(0.2, 0.4, 0.6)", "constant")
        + shown("b", "(0.2, 0.4, 0.6), (0.2, 0.4, 0.6)", "vertex", at(2))
        + shown("c", POINTS, "vertex", at(4))
        + shown("d", CORNERS, "faceVarying", at(6))
        + shown("e", FACES, "uniform", at(0, 2))
        + shown("f", POINTS, "faceVarying", at(2, 2))
        + shown(
            "g",
            "(1, 0, 0), (0, 0, 1)",
            "uniform",
            at(4, 2) + "int[] primvars:displayColor:indices = [0, 1, 0, 1, 1, 0]",
        )
        + f'def Xform "h"\n{{\n    color3f[] primvars:displayColor = [(0.7, 0, 0.7)]\n    def Mesh "i"\n    {{{CUBE}{at(6, 2)}\n    }}\n}}\n'
    ),
    "many meshes": stage(
        "".join(
            f'def Mesh "m{one}" {BINDS}\n{{{CUBE}{at(2 * (one % 18), 2 * (one // 18))}\n'
            f"    rel material:binding = </looks/{('stone', 'clay')[one % 2]}>\n}}\n"
            for one in range(300)
        )
    ),
    "hidden": stage(f"""
def Mesh "seen"
{{{CUBE}
}}
def Xform "gone"
{{
    token visibility = "invisible"
    def Mesh "below"
    {{{CUBE}{at(2)}
    }}
}}
def Mesh "guide"
{{{CUBE}{at(4)}
    uniform token purpose = "guide"
}}
def Mesh "inactive" (
    active = false
)
{{{CUBE}{at(6)}
}}
over "over"
{{
    def Mesh "below"
    {{{CUBE}{at(8)}
    }}
}}
class "class"
{{
    def Mesh "below"
    {{{CUBE}{at(10)}
    }}
}}
def Mesh "rendered"
{{{CUBE}{at(0, 0, 3)}
    uniform token purpose = "render"
}}
"""),
    "x up, no unit": stage(f'def Mesh "a"\n{{{CUBE}\n}}\ndef Mesh "b"\n{{{CUBE}{at(3, 1)}\n}}', 'upAxis = "X"'),
    "z up, inches": stage(
        f'def Mesh "a"\n{{{CUBE}\n}}\ndef Mesh "b"\n{{{CUBE}{at(3, 1)}\n}}',
        'metersPerUnit = 0.0254\n    upAxis = "Z"',
    ),
    "topology": stage(f"""
def Mesh "turned"
{{{CUBE}
    uniform token orientation = "leftHanded"
}}
def Mesh "holed"
{{{CUBE}{at(3)}
    int[] holeIndices = [2, 5]
}}
def Mesh "concave"
{{{at(0, 3)}
    int[] faceVertexCounts = [8, 8, 4, 4, 4, 4, 4, 4, 4, 4, 2]
    int[] faceVertexIndices = [{", ".join(map(str, [*range(7, -1, -1), *range(8, 16), *SIDES, 0, 1]))}]
    point3f[] points = [{", ".join(f"({x}, {y}, {z})" for z in (0, 2) for x, y in OUTLINE)}]
}}
"""),
    "solids": stage(
        "".join(
            f'def {kind} "s{i}"\n{{\n    {given}{at(4 * (i % 4), 4 * (i // 4))}\n}}\n'
            for i, (kind, given) in enumerate(
                [
                    ("Cube", "double size = 1.5"),
                    ("Cube", ""),
                    ("Sphere", "double radius = 1.2"),
                    ("Sphere", ""),
                    ("Cylinder", 'uniform token axis = "X"'),
                    ("Cylinder", "double height = 3\n    double radius = 0.5"),
                    ("Cone", 'uniform token axis = "Y"'),
                    ("Capsule", "double height = 2"),
                    ("Plane", 'uniform token axis = "Y"\n    double width = 3'),
                    ("Capsule", 'uniform token axis = "X"'),
                ]
            )
        )
    ),  # fmt: skip
    "frames": stage(f"""
def Xform "a"
{{
    float3 xformOp:rotateXYZ = (30, 40, 50)
    float3 xformOp:scale = (1, 2, 0.5)
    double3 xformOp:translate:where = (1.5, 0, 0)
    float3 xformOp:translate:pivot = (0.1, 0.2, 0.3)
    uniform token[] xformOpOrder = ["xformOp:translate:where", "xformOp:translate:pivot", "xformOp:rotateXYZ", "xformOp:scale", "!invert!xformOp:translate:pivot"]
    def Mesh "b"
    {{{CUBE}
        float xformOp:rotateZ = 20
        quatf xformOp:orient = (0.8, 0.1, 0.5, 0.3)
        uniform token[] xformOpOrder = ["xformOp:rotateZ", "xformOp:orient"]
    }}
    def Mesh "c"
    {{{CUBE}
        matrix4d xformOp:transform = ( (1, 0.3, 0, 0), (0, 1, 0.2, 0), (0, 0, 1, 0), (4, 1, 0, 1) )
        uniform token[] xformOpOrder = ["xformOp:transform"]
    }}
    def Mesh "d"
    {{{CUBE}
        double3 xformOp:translate = (9, 9, 9)
    }}
    def Mesh "e"
    {{{CUBE}
        float3 xformOp:rotateZXY = (10, 20, 30)
        double3 xformOp:translate = (-4, 0, 0)
        uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateZXY"]
    }}
}}
"""),
    "references": stage(f"""
class Xform "model" {BINDS}
{{
    rel material:binding = </model/looks/own>
    def Scope "looks"
    {{
        def Material "own"
        {{
            token outputs:surface.connect = </model/looks/own/surface.outputs:surface>
            def Shader "surface"
            {{
                uniform token info:id = "UsdPreviewSurface"
                color3f inputs:diffuseColor = (0.3, 0.9, 0.1)
                token outputs:surface
            }}
        }}
    }}
    def Mesh "cube"
    {{{CUBE}
    }}
}}
def Xform "one" (
    references = </model>
)
{{{at(2)}
}}
def Xform "two" (
    inherits = </model>
)
{{{at(4)}
    over "cube" {BINDS}
    {{
        rel material:binding = </looks/clay>
    }}
}}
def Xform "three" (
    references = </two>
)
{{{at(6)}
}}
"""),
    "variants": stage(f"""
def Xform "a" (
    variants = {{
        string shape = "two"
    }}
    prepend variantSets = ["shape", "unset"]
)
{{
    def Mesh "cube"
    {{{CUBE}
    }}
    variantSet "shape" = {{
        "one" {{
            def Mesh "first"
            {{{CUBE}{at(2)}
            }}
        }}
        "two" {{
            def Mesh "second"
            {{{CUBE}{at(0, 3)}
            }}
            over "cube" {BINDS}
            {{
                rel material:binding = </looks/slate>
            }}
        }}
    }}
    variantSet "unset" = {{
        "any" {{
            def Mesh "third"
            {{{CUBE}{at(0, 0, 9)}
            }}
        }}
    }}
}}
"""),
    "opacity": stage(
        "".join(
            f'def Mesh "{name}" {BINDS}\n{{{CUBE}{at(2 * i)}\n    rel material:binding = </looks/{name}>\n}}\n'
            for i, name in enumerate(["thin", "thick", "kept", "cut"])
        )
        + shown("veil", "(1, 0, 0)", "constant", at(0, 2) + "float[] primvars:displayOpacity = [0.2]"),
        looks='def Scope "looks"\n{'
        + material("thin", "float inputs:opacity = 0.2")
        + material("thick", "float inputs:opacity = 0.7\n        color3f inputs:diffuseColor = (0.9, 0.5, 0.1)")
        + material("kept", "float inputs:opacity = 0.2\n        float inputs:opacityThreshold = 0.1")
        + material("cut", "float inputs:opacity = 0.7\n        float inputs:opacityThreshold = 0.8")
        + "\n}\n",
    ),
    "moments": stage(
        f"""
def Mesh "a"
{{{CUBE}
    double3 xformOp:translate = (9, 9, 9)
    double3 xformOp:translate.timeSamples = {{
        0: (0, 0, 0),
        10: (4, 2, 0),
    }}
    uniform token[] xformOpOrder = ["xformOp:translate"]
}}
def Mesh "b"
{{{CUBE}{at(0, 5)}
    token visibility.timeSamples = {{
        0: "inherited",
        7: "invisible",
    }}
}}
""",
        "startTimeCode = 5\n    endTimeCode = 9\n    metersPerUnit = 1",
    ),
    "textures": stage(
        f"""
def Mesh "a" {BINDS}
{{{CUBE}
    rel material:binding = </looks/paper>
    texCoord2f[] primvars:map = [{COORDINATES}] (
        interpolation = "faceVarying"
    )
}}
def Mesh "without" {BINDS}
{{{CUBE}{at(2)}
    rel material:binding = </looks/paper>
}}
""",
        looks=f'def Scope "looks"\n{{\n{TEXTURED}\n}}\n',
    ),
    "skeletons": stage(
        f"""
def SkelRoot "man" {BINDS}
{{{at(1)}
    rel material:binding = </looks/clay>
    def Skeleton "bones" (
        prepend apiSchemas = ["SkelBindingAPI"]
    )
    {{{at(0, 0.5)}
        uniform token[] joints = ["hip", "hip/knee"]
        uniform matrix4d[] bindTransforms = [( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1) ), ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0.5, 0, 1) )]
        uniform matrix4d[] restTransforms = [( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1) ), ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0.5, 0, 1) )]
        rel skel:animationSource = </man/bones/bend>
        def SkelAnimation "bend"
        {{
            uniform token[] joints = ["hip/knee"]
            float3[] translations = [(0.3, 0.5, 0)]
            quatf[] rotations = [(0.9238795, 0, 0, 0.3826834)]
            half3[] scales = [(1, 1.5, 1)]
            uniform token[] blendShapes = ["wide"]
            float[] blendShapeWeights = [0.5]
        }}
    }}
    def Xform "group"
    {{{at(0, 0, 2)}
        def Mesh "skin" (
            prepend apiSchemas = ["SkelBindingAPI"]
        )
        {{{CUBE}
            rel skel:skeleton = </man/bones>
            int[] primvars:skel:jointIndices = [0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1] (
                elementSize = 2
                interpolation = "vertex"
            )
            float[] primvars:skel:jointWeights = [1, 0, 1, 0, 0.2, 0.8, 0.2, 0.8, 1, 0, 1, 0, 0, 1, 0, 1] (
                elementSize = 2
                interpolation = "vertex"
            )
            matrix4d primvars:skel:geomBindTransform = ( (1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0.1, 0, 0, 1) )
        }}
        def Mesh "blended" (
            prepend apiSchemas = ["SkelBindingAPI"]
        )
        {{{CUBE}{at(3)}
            rel skel:skeleton = </man/bones>
            uniform token[] skel:blendShapes = ["wide"]
            rel skel:blendShapeTargets = </man/group/blended/wide>
            def BlendShape "wide"
            {{
                uniform vector3f[] offsets = [(1, 0, 0), (0.6, 0.5, 0)]
                uniform int[] pointIndices = [7, 3]
            }}
        }}
        def Mesh "rest"
        {{{CUBE}{at(6)}
        }}
    }}
}}
"""
    ),
    "prototypes elsewhere": stage(f"""
over "models"
{{
    def Xform "pair" {BINDS}
    {{{at(0.5)}
        rel material:binding = </looks/slate>
        def Mesh "a"
        {{{CUBE}
        }}
        def Mesh "b"
        {{{CUBE}{at(0, 2)}
        }}
    }}
}}
def Mesh "shown" {BINDS}
{{{CUBE}{at(0, 0, 3)}
    rel material:binding = </looks/clay>
}}
def PointInstancer "many"
{{
    rel prototypes = [</models/pair>, </shown>]
    int[] protoIndices = [0, 1, 0]
    point3f[] positions = [(0, 0, 0), (3, 0, 0), (6, 0, 0)]
}}
"""),
}


def jobs(paths: list[Path]) -> list[dict]:
    given = [
        {"files": [str(path), *map(str, path.parent.glob("*.png"))], "depth": DEPTH, "fill": "auto", "frames": []}
        for path in paths
    ]
    return node(SCRIPT, {"site": str(site()), "jobs": given})


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with each stage as text and as a binary file."""
    sdf = pytest.importorskip("pxr.Sdf")
    folder = tmp_path_factory.mktemp("stages")
    pixels = np.random.default_rng(7).integers(0, 255, (8, 8, 3)).astype(np.uint8)
    Image.fromarray(pixels).save(folder / "paper.png")
    for name, text in STAGES.items():
        (folder / f"{name}.usda").write_text(text)
        assert sdf.Layer.FindOrOpen(str(folder / f"{name}.usda")).Export(str(folder / f"{name}.usdc"))
    return folder


@pytest.fixture(scope="module")
def pages(written: Path) -> dict[str, dict]:
    """What the page makes of each file."""
    paths = [written / f"{name}.{kind}" for name in STAGES for kind in ("usda", "usdc")]
    return {path.name: one for path, one in zip(paths, jobs(paths), strict=True)}


def assert_same(native: voxrt.BuildResult, found: dict) -> None:
    assert "problem" not in found, found
    assert [(one["name"], one["colour"], one["authored"]) for one in found["materials"]] == [
        (one.name, list(one.colour), one.authored) for one in native.rom.materials
    ]
    assert [(one["name"], one["mode"], one["voxels"]) for one in found["objects"]] == [
        (one.name, str(one.mode), one.voxels) for one in native.objects
    ]
    assert found["words"] == hashlib.sha256(native.octree.words.tobytes()).hexdigest()


@pytest.mark.parametrize("name", STAGES)
def test_stages_have_the_words_of_voxrt_build(written: Path, pages: dict[str, dict], name: str) -> None:
    native = voxrt.build(written / f"{name}.usda", depth=DEPTH, geometry="render")
    for kind in ("usda", "usdc"):
        found = pages[f"{name}.{kind}"]
        assert_same(native, found)
        assert {one["message"] for one in found["warnings"]} == {one.message for one in native.warnings}


def comb(corners: int) -> str:
    """A concave polygon with very many corners."""
    points = [(i, 1 if i % 2 else 5, 0) for i in range(corners - 2)] + [(corners, 0, 0), (0, 0, 0)]
    return f"""
def Mesh "comb"
{{
    int[] faceVertexCounts = [{corners}]
    int[] faceVertexIndices = [{", ".join(map(str, reversed(range(corners))))}]
    point3f[] points = [{", ".join(map(str, points))}]
}}
"""


def doubled(levels: int) -> str:
    """Prims that hold two references to the one before."""
    text = f'class Xform "m0"\n{{\n    def Mesh "a"\n    {{{CUBE}\n    }}\n}}\n'
    for level in range(1, levels):
        pair = "".join(
            f'    def Xform "{name}" (\n        references = </m{level - 1}>\n    )\n    {{\n    }}\n' for name in "ab"
        )
        text += f'def Xform "m{level}"\n{{\n{pair}}}\n'
    return text


def packed(path: Path, levels: int) -> Path:
    """A package of layers that each hold two references to the next, which ends in a cube."""
    pair = '    def Xform "{0}" (\n        references = @{1}.usda@\n    )\n    {{\n    }}\n'
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as package:
        for level in range(levels):
            inside = pair.format("a", level + 1) + pair.format("b", level + 1)
            body = f'def Xform "root"\n{{\n{inside}}}\n' if level < levels - 1 else f'def Mesh "root"\n{{{CUBE}\n}}\n'
            package.writestr(f"{level}.usda", stage(body, 'defaultPrim = "root"', ""))
    return path


REFUSED = {
    "subset": (stage(f'def Mesh "a"\n{{{CUBE}{subset("one", "6", "clay")}\n}}'), "/a/one: a face subset refers to faces beyond the mesh's 6"),
    "corners": (stage(f'def Mesh "a"\n{{{CUBE.replace("[4, ", "[5, ")}\n}}'), "/a: faceVertexCounts ask for 25 corners and faceVertexIndices has 24"),
    "negative": (stage(f'def Mesh "a"\n{{{CUBE.replace("[4, 4", "[9, -1")}\n}}'), "/a: faceVertexCounts ask for 24 corners"),
    "points": (stage(f'def Mesh "a"\n{{{CUBE.replace("3, 7, 5]", "3, 7, 8]")}\n}}'), "/a: faceVertexIndices has 8 and points has 8"),
    "finite": (stage(f'def Mesh "a"\n{{{CUBE.replace("(0, 0, 0)", "(inf, 0, 0)")}\n}}'), "not a finite number"),
    "length": (stage('def Sphere "a"\n{\n    double radius = -1\n}\n'), "/a: radius -1 is not a length"),
    "unit": (stage(f'def Mesh "a"\n{{{CUBE}\n}}', "metersPerUnit = 0"), "metersPerUnit 0 is not a positive number"),
    "comb": (stage(comb(30_000)), "a concave polygon of 30000 corners is too large here"),
    "doubled": (stage(doubled(30)), "are too many here"),
    "cycle": (stage('def Xform "a" (\n    references = </b>\n)\n{\n}\ndef Xform "b" (\n    references = </a>\n)\n{\n}\n'), "refers to itself"),
    "inside": (stage('def Xform "a"\n{\n    def Xform "b" (\n        references = </a>\n    )\n    {\n    }\n}\n'), "/a/b: refers to itself"),
    "nothing": (stage(""), "has no triangles"),
}  # fmt: skip


def test_contradictions_and_what_would_not_end_are_refused(tmp_path: Path) -> None:
    for name, (text, _) in REFUSED.items():
        (tmp_path / f"{name}.usda").write_text(text)
    paths = [tmp_path / f"{name}.usda" for name in REFUSED]
    found = jobs([*paths, packed(tmp_path / "layers.usdz", 25), packed(tmp_path / "few.usdz", 3)])
    said = [*(problem for _, problem in REFUSED.values()), "layers put together are too many here"]
    for one, problem in zip(found, said, strict=False):
        assert problem in one["problem"]
        assert "\n" not in one["problem"]
    assert len(found[-1]["objects"]) == 4


def test_what_is_not_read_is_said(tmp_path: Path) -> None:
    body = f"""
def Mesh "a" (
    prepend apiSchemas = ["PhysicsCollisionAPI"]
    prepend references = @other.usda@
)
{{{CUBE}
    rel material:binding:collection:all = [</a.collection:all>, </looks/clay>]
}}
def Xform "b"
{{{CUBE.replace("int", "custom int").replace("point3f", "custom point3f")}
    uniform token[] xformOpOrder = ["!resetXformStack!"]
}}
def BasisCurves "c"
{{
}}
"""
    (tmp_path / "said.usda").write_text(stage(body))
    (found,) = jobs([tmp_path / "said.usda"])
    assert {one["kind"] for one in found["warnings"]} == {"collider", "collection", "default-material", "reference", "transform", "unsupported-prim"}  # fmt: skip


ASSETS = [
    "OpenUSD/usd/usdPhysics/examples/usdPhysicsSpheresWithMaterial.usda",
    "OpenUSD/usdImaging/usdImagingGL/testenv/testUsdImagingGLGeomSubsets/testUsdImagingGLGeomSubsets.usda",
    "kaolin/tests/samples/io/pizza.usdz",
    "maya-usd/CubeModel.usda",
    "newton/examples/assets/crazyflie.usd",
    "newton/examples/assets/humanoid.usda",
    "newton/tests/assets/negative_scale_mesh_pair.usda",
    "tinyusdz/blendshape.usdc",
    "tinyusdz/texturedcube.usdc",
    "usd-wg-assets/full_assets/Teapot/geo/UtahTeapot.usd",
    "usd-wg-assets/full_assets/Vehicles/USD_Mini_Car_Kit/assets/vehicles/formula/geo/formulaGeo.usda",
    "usd-wg-assets/test_assets/RoughnessTest/RoughnessTest.usdz",
    "usd-wg-assets/test_assets/foundation/stage_composition/active.usda",
    "usd-wg-assets/test_assets/schemaTests/usdGeom/primitives/all_primitives.usda",
]


@pytest.mark.parametrize("name", ASSETS)
def test_assets_have_the_words_of_voxrt_build(name: str) -> None:
    path = asset(f"usd/{name}")
    (found,) = jobs([path])
    assert_same(voxrt.build(path, depth=DEPTH, geometry="render"), found)
