"""Point instancers, skeletons, variants and time, against USD's own answers."""

import numpy as np
import pytest
from assets import asset, over_assets
from oracles.surfaces import bounds, scene_triangles, volume
from oracles.usd_in_process import load_usd
from pxr import Sdf, Usd, UsdGeom, UsdSkel, UsdUtils

from voxrt.voxelize import AssetError, DoesNotFitError

HEAD = '#usda 1.0\n(\nupAxis = "Y"\nmetersPerUnit = 1\n)\n'


@pytest.fixture
def usd(tmp_path):
    def write(body, **options):
        path = tmp_path / "stage.usda"
        path.write_text(HEAD + body)
        return load_usd(path, **options)

    return write


def instancer(extra="", indices="[0, 1, 0]", holder="over"):
    return f"""
def PointInstancer "many" {{
    rel prototypes = [</many/protos/a>, </many/protos/b>]
    int[] protoIndices = {indices}
    point3f[] positions = [(0,0,0), (10,0,0), (20,0,0)]
    {extra}
    {holder} "protos" {{
        def Cube "a" {{
            double size = 1
        }}
        def Xform "b" {{
            double3 xformOp:translate = (0, 5, 0)
            uniform token[] xformOpOrder = ["xformOp:translate"]
            def Cube "in" {{
                double size = 2
            }}
        }}
    }}
}}
"""


@pytest.mark.parametrize("holder", ["over", "class", "def Scope"])
def test_copies_stand_where_the_points_are(usd, holder):
    scene = usd(instancer(holder=holder))
    assert [one.name for one in scene.objects] == ["/many[0]", "/many[1]/in", "/many[2]"]
    assert volume(scene_triangles(scene)) == pytest.approx(1 + 8 + 1)
    assert bounds(scene_triangles(scene)).tolist() == [[-0.5, -0.5, -1], [20.5, 6, 1]]
    assert scene.objects[0].mesh is scene.objects[2].mesh


def test_scales_orientations_and_masks(usd):
    scene = usd(
        instancer(
            "float3[] scales = [(1,1,1), (1,1,1), (1,2,3)]\n"
            "quath[] orientations = [(1,0,0,0), (1,0,0,0), (0.70710678,0,0,0.70710678)]\n"
            "int64[] invisibleIds = [1]"
        )
    )
    assert [one.name for one in scene.objects] == ["/many[0]", "/many[2]"]
    box = bounds(scene_triangles(scene)[12:])
    # Scaled first, then turned a quarter about z: y lies along -x.
    assert np.allclose(np.ptp(box, axis=0), [2, 1, 3], atol=1e-3)
    assert [(one.kind, one.count) for one in scene.warnings if one.kind == "invisible"] == [("invisible", 1)]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("[0, 1, 0]", "[0, 1, 2]"), "/many: protoIndices go from 0 to 2 and there are 2 prototypes"),
        (("[0, 1, 0]", "[0, 1]"), "/many: protoIndices has 2 entries"),
        (("</many/protos/b>]", "</many/protos/c>]"), "/many: prototype /many/protos/c does not exist"),
        (("</many/protos/b>]", "</many>]"), "/many: the point instancer copies itself"),
    ],
)
def test_instancers_that_contradict_themselves(usd, capfd, change, message):
    with pytest.raises(AssetError) as caught:
        usd(instancer().replace(*change))
    assert message in str(caught.value)
    assert capfd.readouterr() == ("", "")


def test_instancers_of_instancers_are_bounded(usd, monkeypatch):
    monkeypatch.setattr("voxrt.voxelize.formats.usd.traversal.MOST_OBJECTS", 10_000)
    body = 'def Cube "p0" {}\n'
    for level in range(1, 8):
        points = ", ".join(f"({i * 10**level}, 0, 0)" for i in range(10))
        body += f"""def PointInstancer "p{level}" {{
            rel prototypes = </p{level - 1}>
            int[] protoIndices = [{", ".join("0" * 10)}]
            point3f[] positions = [{points}]
        }}\n"""
    with pytest.raises(DoesNotFitError, match="10,000 objects"):
        usd(body)


@over_assets(
    ("name", "copies", "triangles"),
    [
        ("maya-usd/PointInstancer_Grid_70k.usda", 70_000, 840_000),
        ("usd-wg-assets/full_assets/OpenChessSet/chess_set.usda", 49, 1_430_784),
        ("usd-wg-assets/intent-vfx/scenes/teapotScene.usd", 1000, 2_472_000),
    ],
)
def test_real_instancers(name, copies, triangles):
    path = asset(f"usd/{name}")
    scene = load_usd(path, allow_outside=True)
    assert len(scene.objects) == copies
    assert sum(len(one.mesh.triangles) for one in scene.objects) == triangles
    assert len({id(one.mesh) for one in scene.objects}) < 300
    if "chess" not in name:
        return
    delegate = UsdUtils.CoalescingDiagnosticDelegate()  # keeps USD from printing
    stage = Usd.Stage.Open(str(path))
    cache = UsdGeom.BBoxCache(Usd.TimeCode(stage.GetStartTimeCode()), [UsdGeom.Tokens.default_, UsdGeom.Tokens.render])
    box = cache.ComputeWorldBound(stage.GetPseudoRoot()).ComputeAlignedRange()
    del delegate
    corners = np.concatenate(
        [
            one.mesh.positions[np.unique(one.mesh.triangles)] @ one.transform[:3, :3].T + one.transform[:3, 3]
            for one in scene.objects
        ]
    )
    assert (corners.min(axis=0) >= np.array(box.GetMin()) - 1e-4).all()
    assert (corners.max(axis=0) <= np.array(box.GetMax()) + 1e-4).all()


@over_assets("seconds", [None, 0.0, 0.5, 1.25])
def test_skinned_points_are_those_that_usd_bakes(seconds):
    path = asset("usd/usd-wg-assets/test_assets/USDZ/CesiumMan/CesiumMan.usdz")
    (ours,) = load_usd(path, time=seconds).objects
    stage = Usd.Stage.Open(str(path))
    code = stage.GetStartTimeCode() + (seconds or 0) * stage.GetTimeCodesPerSecond()
    flat = Usd.Stage.Open(stage.Flatten())
    for prim in flat.Traverse():
        if prim.IsA(UsdSkel.Root):
            assert UsdSkel.BakeSkinning(UsdSkel.Root(prim))
    (mesh,) = [prim for prim in flat.Traverse() if prim.IsA(UsdGeom.Mesh)]
    points = np.array(UsdGeom.Mesh(mesh).GetPointsAttr().Get(code), dtype=float)
    place = np.array(UsdGeom.XformCache(code).GetLocalToWorldTransform(mesh)).T
    baked = points @ place[:3, :3].T + place[:3, 3]
    posed = ours.mesh.positions @ ours.transform[:3, :3].T + ours.transform[:3, 3]
    assert np.allclose(posed, baked, atol=1e-5)


def test_blend_shapes(usd):
    scene = usd(
        """
def SkelRoot "root" {
    def Skeleton "skeleton" (prepend apiSchemas = ["SkelBindingAPI"]) {
        uniform token[] joints = []
        uniform matrix4d[] bindTransforms = []
        uniform matrix4d[] restTransforms = []
        rel skel:animationSource = </root/animation>
    }
    def SkelAnimation "animation" {
        uniform token[] blendShapes = ["other", "up"]
        float[] blendShapeWeights.timeSamples = { 0: [0, 0], 24: [0, 1] }
    }
    def Mesh "mesh" (prepend apiSchemas = ["SkelBindingAPI"]) {
        point3f[] points = [(0,0,0),(1,0,0),(0,0,1)]
        int[] faceVertexCounts = [3]
        int[] faceVertexIndices = [0,2,1]
        uniform token subdivisionScheme = "none"
        uniform token[] skel:blendShapes = ["up"]
        rel skel:blendShapeTargets = </root/mesh/up>
        rel skel:skeleton = </root/skeleton>
        def BlendShape "up" {
            uniform vector3f[] offsets = [(0, 4, 0)]
            uniform int[] pointIndices = [1]
        }
    }
}
""",
        time=0.5,
    )
    assert scene.objects[0].mesh.positions.tolist() == [[0, 0, 0], [1, 2, 0], [0, 0, 1]]


VARIANTS = """
def Xform "model" (
    variants = {
        string size = "small"
    }
    prepend variantSets = "size"
) {
    variantSet "size" = {
        "small" {
            def Cube "body" {
                double size = 1
            }
        }
        "large" {
            def Cube "body" {
                double size = 3
            }
        }
    }
}
"""


@pytest.mark.parametrize(("variants", "expected"), [((), 1), (("/model:size=large",), 27), (("model:size=small",), 1)])
def test_variants(usd, variants, expected):
    assert volume(scene_triangles(usd(VARIANTS, variants=variants))) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("variants", "message"),
    [
        (("/nothing:size=large",), "variant '/nothing:size=large': no such prim; write it as /prim/path:set=name"),
        (("size=large",), "variant 'size=large': no such prim"),
        (("/model:colour=red",), "/model: no variant set 'colour'; it has size"),
        (("/model:size=huge",), "/model: no variant 'huge' of 'size'; it has "),
    ],
)
def test_variants_that_are_not_there(usd, variants, message):
    with pytest.raises(AssetError) as caught:
        usd(VARIANTS, variants=variants)
    assert message in str(caught.value)


def test_real_variants():
    path = asset("usd/usd-wg-assets/full_assets/Teapot/Teapot.usd")
    counts = {
        name: sum(len(one.mesh.triangles) for one in load_usd(path, variants=[f"/Teapot:modelVariant={name}"]).objects)
        for name in ("Utah", "Fancy")
    }
    assert counts == {"Utah": 2472, "Fancy": 12144}


def test_time_in_seconds_after_the_start(tmp_path):
    path = tmp_path / "moving.usda"
    path.write_text(
        "#usda 1.0\n(\nstartTimeCode = 10\nendTimeCode = 58\ntimeCodesPerSecond = 48\n)\n"
        'def Cube "c" {\ndouble3 xformOp:translate.timeSamples = { 10: (0,0,0), 58: (48,0,0) }\n'
        'uniform token[] xformOpOrder = ["xformOp:translate"]\n}\n'
    )
    unit = 0.01  # USD's fallback
    for seconds, place in ((None, 0), (0, 0), (0.25, 12), (1, 48), (9, 48)):
        scene = load_usd(path, time=seconds)
        (one,) = scene.objects
        assert one.transform[0, 3] == pytest.approx(place * unit)
        assert [w.kind for w in scene.warnings if w.kind == "animation"] == ["animation"] * (seconds is None)


def test_the_file_is_not_written_to(tmp_path):
    path = tmp_path / "stage.usda"
    path.write_text(HEAD + VARIANTS)
    before = path.read_bytes()
    load_usd(path, variants=["/model:size=large"])
    assert path.read_bytes() == before
    assert not Sdf.Layer.FindOrOpen(str(path)).dirty
