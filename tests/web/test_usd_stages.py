"""USD stages on the page: the words, materials and objects of ``voxrt build``, for text and for binary files.

The folder usd_stages holds a stage for each of USD's features; here are those that are made or refused.
"""

from __future__ import annotations

import zipfile
from pathlib import Path

import numpy as np
import pytest
from assets import ROOT as ASSETS
from fakes.site import assert_same_memory, objects_of, page_builds
from PIL import Image

import voxrt

STAGES = sorted(Path(__file__).with_name("usd_stages").glob("*.usda"))
DEPTH = 5

CUBE = """
    uniform token subdivisionScheme = "none"
    int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]
    int[] faceVertexIndices = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1), (1, 1.3, 1.1)]
"""
LOOKS = """
def Scope "looks"
{
    def Material "clay" {
        token outputs:surface.connect = </looks/clay/surface.outputs:surface>
        def Shader "surface" {
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor = (0.8, 0.1, 0.2)
            token outputs:surface
        }
    }
    def Material "stone" { }
}
"""


def stage(body: str, header: str = "metersPerUnit = 1") -> str:
    return f"#usda 1.0\n(\n    {header}\n)\n{LOOKS}{body}"


def mesh(name: str, more: str = "", shape: str = CUBE) -> str:
    return f'def Mesh "{name}" (prepend apiSchemas = ["MaterialBindingAPI"])\n{{{shape}{more}\n}}\n'


def moved(x: int, y: int) -> str:
    return f'    double3 xformOp:translate = ({x}, {y}, 0)\n    token[] xformOpOrder = ["xformOp:translate"]\n'


def bound(look: str) -> str:
    return f"    rel material:binding = </looks/{look}>\n"


MADE = {
    "many meshes": stage(
        "".join(mesh(f"m{i}", moved(2 * (i % 18), 2 * (i // 18)) + bound(("clay", "stone")[i % 2])) for i in range(300))
    ),
    # What USD takes though it does not write it: metadata on one line, a comma after the last, braces on one line.
    "loose": stage(
        mesh("a", '    color3f[] primvars:displayColor = [(0, 1, 0)] (interpolation = "constant")\n')
        + 'def Scope "empty" { }\ndef Xform "b" {'
        + mesh("c", moved(3, 0) + "    custom float weight = 2", CUBE.replace("7, 5]", "7, 5,]"))
        + "}\n"
    ),
}


def with_images(paths: list[Path]) -> list[dict]:
    """What the page makes of each file, which is dropped with the images beside it."""
    return page_builds(*([path, *path.parent.glob("*.png")] for path in paths), depth=DEPTH)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with each stage as text and as a binary file."""
    sdf = pytest.importorskip("pxr.Sdf")
    folder = tmp_path_factory.mktemp("stages")
    pixels = np.random.default_rng(7).integers(0, 255, (8, 8, 3)).astype(np.uint8)
    Image.fromarray(pixels).save(folder / "paper.png")
    for name, text in {**{path.stem: path.read_text() for path in STAGES}, **MADE}.items():
        (folder / f"{name}.usda").write_text(text)
        assert sdf.Layer.FindOrOpen(str(folder / f"{name}.usda")).Export(str(folder / f"{name}.usdc"))
    return folder


@pytest.fixture(scope="module")
def pages(written: Path) -> dict[str, dict]:
    """What the page makes of each file."""
    paths = [path for path in written.iterdir() if path.suffix in (".usda", ".usdc")]
    return {path.name: one for path, one in zip(paths, with_images(paths), strict=True)}


def assert_same(native: voxrt.BuildResult, found: dict) -> None:
    assert_same_memory(found, native.rom)
    assert found["objects"] == objects_of(native)


@pytest.mark.parametrize("name", [*(path.stem for path in STAGES), *MADE])
def test_stages_have_the_words_of_voxrt_build(written: Path, pages: dict[str, dict], name: str) -> None:
    native = voxrt.build(written / f"{name}.usda", depth=DEPTH, geometry="render")
    for kind in ("usda", "usdc"):
        found = pages[f"{name}.{kind}"]
        assert_same(native, found)
        assert {one["message"] for one in found["warnings"]} == {one.message for one in native.warnings}


REAL = [
    "OpenUSD/usd/usdPhysics/examples/usdPhysicsSpheresWithMaterial.usda",
    "OpenUSD/usdImaging/usdImagingGL/testenv/testUsdImagingGLGeomSubsets/testUsdImagingGLGeomSubsets.usda",
    "kaolin/tests/samples/io/pizza.usdz",
    "maya-usd/CubeModel.usda",
    "newton/examples/assets/crazyflie.usd",
    "newton/tests/assets/negative_scale_mesh_pair.usda",
    "tinyusdz/texturedcube.usdc",
    "usd-wg-assets/full_assets/Vehicles/USD_Mini_Car_Kit/assets/vehicles/formula/geo/formulaGeo.usda",
    "usd-wg-assets/test_assets/RoughnessTest/RoughnessTest.usdz",
    "usd-wg-assets/test_assets/schemaTests/usdGeom/primitives/all_primitives.usda",
]


def test_assets_have_the_words_of_voxrt_build() -> None:
    paths = [path for name in REAL if (path := ASSETS / "usd" / name).exists()]
    if not paths:
        pytest.skip(f"no USD files below {ASSETS}; set VOXRT_ASSETS to the folder of assets")
    for path, found in zip(paths, with_images(paths), strict=True):
        assert_same(voxrt.build(path, depth=DEPTH, geometry="render"), found)


def comb(corners: int) -> str:
    """A concave polygon with very many corners."""
    points = [(i, 1 if i % 2 else 5, 0) for i in range(corners - 2)] + [(corners, 0, 0), (0, 0, 0)]
    return f"""
    int[] faceVertexCounts = [{corners}]
    int[] faceVertexIndices = [{", ".join(map(str, reversed(range(corners))))}]
    point3f[] points = [{", ".join(map(str, points))}]
"""


def refers(name: str, target: str, inside: str = "", kind: str = "Xform") -> str:
    return f'def {kind} "{name}" (\n    references = {target}\n)\n{{\n{inside}}}\n'


def doubled(levels: int) -> str:
    """Prims that hold two references to the one before."""
    text = f'class Xform "m0"\n{{\n{mesh("a")}}}\n'
    for level in range(1, levels):
        pair = "".join(refers(name, f"</m{level - 1}>") for name in "ab")
        text += f'def Xform "m{level}"\n{{\n{pair}}}\n'
    return text


def packed(path: Path, levels: int) -> Path:
    """A package of layers that each hold two references to the next; the last has a cube."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as package:
        for level in range(levels):
            pair = "".join(refers(name, f"@{level + 1}.usda@", kind="") for name in "ab")
            body = f'def "root"\n{{\n{pair}}}\n' if level < levels - 1 else mesh("root")
            package.writestr(f"{level}.usda", f'#usda 1.0\n(\n    defaultPrim = "root"\n)\n{body}')
    return path


SUBSET = f'def GeomSubset "one"\n{{\n    int[] indices = [6]\n    token familyName = "materialBind"\n{bound("clay")}}}'
REFUSED = {
    "subset": (mesh("a", SUBSET), "/a/one: a face subset refers to faces beyond the mesh's 6"),
    "corners": (mesh("a", shape=CUBE.replace("[4, ", "[5, ")), "/a: faceVertexCounts ask for 25 corners"),
    "negative": (mesh("a", shape=CUBE.replace("[4, 4", "[9, -1")), "/a: faceVertexCounts ask for 24 corners"),
    "points": (mesh("a", shape=CUBE.replace("7, 5]", "7, 8]")), "/a: faceVertexIndices has 8 and points has 8"),
    "finite": (mesh("a", shape=CUBE.replace("(0, 0, 0)", "(inf, 0, 0)")), "not a finite number"),
    "length": ('def Sphere "a"\n{\n    double radius = -1\n}\n', "/a: radius -1 is not a length"),
    "comb": (mesh("a", shape=comb(30_000)), "a concave polygon of 30000 corners is too large here"),
    "doubled": (doubled(30), "are too many here"),
    "cycle": (refers("a", "</b>") + refers("b", "</a>"), "refers to itself"),
    "inside": (f'def Xform "a"\n{{\n{refers("b", "</a>")}}}\n', "/a/b: refers to itself"),
    "deep": ('def Xform "a" {\n' * 30_000 + "}\n" * 30_000, ""),
    "nothing": ("", "has no triangles"),
}


def test_contradictions_and_what_would_not_end_are_refused(tmp_path: Path) -> None:
    for name, (body, _) in REFUSED.items():
        (tmp_path / f"{name}.usda").write_text(stage(body))
    (tmp_path / "unit.usda").write_text(stage(mesh("a"), "metersPerUnit = 0"))
    texts = [tmp_path / f"{name}.usda" for name in (*REFUSED, "unit")]
    found = with_images([*texts, packed(tmp_path / "layers.usdz", 25), packed(tmp_path / "few.usdz", 3)])
    parts = [*(problem for _, problem in REFUSED.values()), "metersPerUnit 0 is not a positive number", "are too many"]
    for one, problem in zip(found[:-1], parts, strict=True):
        assert problem in one["problem"]
        assert "\n" not in one["problem"]
    assert len(found[-1]["objects"]) == 4


def test_layers_are_dropped_together(tmp_path: Path) -> None:
    header = 'defaultPrim = "part"\n    metersPerUnit = 1'
    texts = {
        "a_part.usda": stage(f'def Xform "part"\n{{\n{mesh("cube", bound("clay"))}}}\n', header),
        "b_sub.usda": stage(mesh("below", moved(0, 2))),
        "scene.usda": stage(
            refers("one", "@./a_part.usda@", moved(2, 0)) + refers("two", "@a_part.usda@</part/cube>"),
            "metersPerUnit = 1\n    subLayers = [@b_sub.usda@]",
        ),
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
    files = [tmp_path / name for name in texts]
    (found,) = page_builds(files, depth=DEPTH)
    assert found["name"] == "scene"
    assert_same(voxrt.build(files[-1], depth=DEPTH, geometry="render"), found)


def test_what_is_not_read_is_said(tmp_path: Path) -> None:
    collection = "    rel material:binding:collection:all = [</a.collection:all>, </looks/clay>]\n"
    body = (
        refers("away", "@other.usda@", mesh("a", collection))
        + 'def Sphere "b" (prepend apiSchemas = ["PhysicsCollisionAPI"])\n{\n'
        + '    token[] xformOpOrder = ["!resetXformStack!"]\n}\ndef BasisCurves "c"\n{\n}\n'
    )
    (tmp_path / "said.usda").write_text(stage(body))
    (found,) = page_builds([tmp_path / "said.usda"], depth=DEPTH)
    kinds = {one["kind"] for one in found["warnings"]}
    assert kinds == {"collider", "collection", "default-material", "reference", "transform", "unsupported-prim"}
