"""Point instancers of USD on the page: the words of ``voxrt build``, and errors where the arrays contradict."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from fakes.site import assert_same_memory, page_builds

import voxrt

if TYPE_CHECKING:
    from pathlib import Path

CUBE = """
        int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]
        int[] faceVertexIndices = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1, 1)]
"""
ROOF = """
        int[] faceVertexCounts = [3, 3, 3, 3]
        int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]
        point3f[] points = [(0, 0, 0), (2, 0, 0), (0, 0, 2), (0.3, 1.7, 0.4)]
"""
PLACES = "(0, 0, 0), (3.1, 0.2, 0), (0, 2.3, 5.7), (-4, 1, 2), (6, 6, 6)"
TURNS = "(1, 0, 0, 0), (0.9239, 0, 0.3827, 0), (0.5, 0.5, 0.5, 0.5), (0.8, 0.1, -0.2, 0.55), (1, 0, 0, 0)"
SIZES = "(1, 1, 1), (1, 2, 0.5), (0.7, 0.7, 0.7), (1.3, 1, 1), (1, 1, 1)"


COLOURS = {"stone": "0.2, 0.3, 0.5", "clay": "0.8, 0.1, 0.2", "slate": "0.1, 0.6, 0.3"}
MATERIALS = "".join(
    f"""
    def Material "{name}"
    {{
        token outputs:surface.connect = </looks/{name}/surface.outputs:surface>
        def Shader "surface"
        {{
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor = ({colour})
            token outputs:surface
        }}
    }}"""
    for name, colour in COLOURS.items()
)


def bound(name: str) -> str:
    return f"    rel material:binding = </looks/{name}>"


def stage(more: str = "", indices: str = "0, 1, 0, 1, 1", prototypes: str = "</many/cube>, </many/models/roof>") -> str:
    return f"""#usda 1.0
(
    metersPerUnit = 0.5
    upAxis = "Z"
)
def Scope "looks"
{{{MATERIALS}
}}
def Mesh "ground" (prepend apiSchemas = ["MaterialBindingAPI"])
{{{ROOF}{bound("stone")}
    double3 xformOp:translate = (-3.25, -3, -1)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}}
def Xform "place"
{{
    double3 xformOp:translate = (1.5, 2, 3)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def PointInstancer "many"
    {{
        rel prototypes = [{prototypes.replace("</many", "</place/many")}]
        int[] protoIndices = [{indices}]
        point3f[] positions = [{PLACES}]
        {more}
        float3 xformOp:scale = (1, 1.5, 1)
        uniform token[] xformOpOrder = ["xformOp:scale"]
        def Mesh "cube" (prepend apiSchemas = ["MaterialBindingAPI"])
        {{{CUBE}
        {bound("clay")}
            double3 xformOp:translate = (0.25, 0, 0.5)
            uniform token[] xformOpOrder = ["xformOp:translate"]
        }}
        def Scope "models"
        {{
            def Mesh "roof" (prepend apiSchemas = ["MaterialBindingAPI"])
            {{{ROOF}{bound("slate")}
            }}
        }}
    }}
}}
"""


TURNED = f"quath[] orientations = [{TURNS}]\n        float3[] scales = [{SIZES}]"
STAGES = {
    "places": stage(),
    "turns and scales": stage(TURNED),
    "one prototype": stage(TURNED, indices="0, 0, 0, 0, 0", prototypes="</many/cube>"),
    "single turns": stage(TURNED.replace("quath[] orientations", "quatf[] orientationsf")),
    "masked": stage(f"{TURNED}\n        int64[] invisibleIds = [1, 3]"),
    "prototypes elsewhere": stage(prototypes="</ground>, </many/cube>").replace("</place/ground>", "</ground>"),
    "masked by name": stage(
        f"{TURNED}\n        int64[] ids = [7, 9, 11, 13, 15]\n        int64[] invisibleIds = [9, 3]"
    ),
}


@pytest.mark.parametrize("kind", ["usda", "usdc"])
@pytest.mark.parametrize("name", STAGES)
def test_copies_have_the_words_of_voxrt_build(tmp_path: Path, name: str, kind: str) -> None:
    path = exported(STAGES[name], tmp_path / f"many.{kind}")
    native = voxrt.build(path, depth=7, geometry="render")
    (found,) = page_builds([path], depth=7)
    assert_same_memory(found, native.rom)
    assert [one["name"] for one in found["objects"]] == [one.name for one in native.objects]
    masked = [one for one in found["warnings"] if one["kind"] == "invisible"]
    assert sum(one["count"] for one in masked) == {"masked": 2, "masked by name": 1}.get(name, 0)


def nested(levels: int, copies: int) -> str:
    """Instancers of instancers of a roof."""
    text = f'def Mesh "p0"\n{{{ROOF}}}'
    for level in range(levels):
        path = "".join(f"/many{above}/p{above}" for above in range(levels - 1, level, -1))
        text = f"""
def Xform "p{level + 1}"
{{
def PointInstancer "many{level}"
{{
    rel prototypes = </root{path}/many{level}/p{level}>
    int[] protoIndices = [{", ".join(["0"] * copies)}]
    point3f[] positions = [{", ".join(f"({3 * one}, 0, 0)" for one in range(copies))}]
{text}
}}
}}"""
    return "#usda 1.0\n" + text.replace(f"p{levels}", "root")


def exported(text: str, path: Path) -> Path:
    """Write a stage as text the way USD does."""
    usd = pytest.importorskip("pxr.Usd")
    written = path.parent / "written.usda"
    written.write_text(text)
    assert usd.Stage.Open(str(written)).Export(str(path))
    return path


def test_contradictions_are_refused(tmp_path: Path) -> None:
    texts = {
        "short": (stage(indices="0, 1"), "protoIndices has 2 entries"),
        "beyond": (stage(indices="0, 1, 2, 0, 0"), "protoIndices[2] is 2 and there are 2 prototypes"),
        "below": (stage(indices="0, -1, 0, 0, 0"), "protoIndices[1] is -1"),
        "nested": (nested(levels=3, copies=60), "are too many here"),
        "itself": (stage(prototypes="</many/cube>, </many>", indices="0, 1, 1, 0, 1"), "copies itself"),
        "absent": (stage(prototypes="</many/cube>, </many/none>"), "/place/many/none does not exist"),
    }
    files = [[exported(text, tmp_path / f"{name}.usda")] for name, (text, _) in texts.items()]
    for (_, problem), found in zip(texts.values(), page_builds(*files, depth=5), strict=True):
        assert problem in found["problem"]
