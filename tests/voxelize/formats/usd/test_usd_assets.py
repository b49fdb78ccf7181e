"""Real stages against UsdGeom's own bounding boxes and against their twins."""

import numpy as np
import pytest
from assets import asset, need_assets
from oracles.surfaces import area, bounds, scene_triangles
from pxr import Usd, UsdGeom, UsdUtils

from voxrt.voxelize import AssetError, BoxCollider, HullCollider, MeshCollider, SphereCollider
from voxrt.voxelize.assets import load

need_assets()

WG = "usd/usd-wg-assets"


@pytest.mark.parametrize(
    ("name", "triangles", "tight"),
    [
        (f"{WG}/test_assets/RelationshipEncapsulationTests/InternalReferenceTest.usda", 1298, False),
        (
            f"{WG}/test_assets/RelationshipEncapsulationTests/ReferencedAssembliesWithInternalReferencesTest.usda",
            2594,
            False,
        ),
        (f"{WG}/test_assets/RoughnessTest/RoughnessTest.usdz", None, False),
        (f"{WG}/test_assets/schemaTests/usdGeom/transforms/complex_transform.usda", 48, False),
        (f"{WG}/test_assets/schemaTests/usdGeom/transforms/weird_matrix_transform.usda", 48, False),
        (f"{WG}/test_assets/schemaTests/usdGeom/meshes/5_face/5_face.usda", 13, False),
        (f"{WG}/test_assets/schemaTests/usdGeom/primitives/all_primitives.usda", None, False),
        (f"{WG}/test_assets/foundation/stage_configuration/upAxis/upAxis_X.usda", 36, True),
        (f"{WG}/test_assets/foundation/stage_configuration/upAxis/upAxis_Z.usda", 36, True),
        (f"{WG}/test_assets/foundation/stage_configuration/metersPerUnit/metersPerUnit_mix.usda", 72, True),
        (f"{WG}/test_assets/foundation/stage_composition/purpose.usda", 12, True),
        (f"{WG}/full_assets/Teapot/DrawModes.usd", 134_880, False),
        ("usd/newton/examples/assets/crazyflie.usd", 6726, True),
        ("usd/newton/examples/assets/bear.usd", 3968, True),
        ("usd/newton/examples/assets/humanoid.usda", None, False),
        ("usd/kaolin/tests/samples/io/amsterdam.usdz", 3864, True),
        ("usd/tinyusdz/texturedcube.usdc", 12, False),
    ],
)
def test_bounds_are_usds_own(name, triangles, tight, capfd):
    path = asset(name)
    ours = scene_triangles(load(path, allow_outside=True))
    assert capfd.readouterr() == ("", "")
    if triangles:
        assert len(ours) == triangles
    delegate = UsdUtils.CoalescingDiagnosticDelegate()  # keeps USD from printing
    stage = Usd.Stage.Open(str(path))
    purposes = [UsdGeom.Tokens.default_, UsdGeom.Tokens.render]
    cache = UsdGeom.BBoxCache(Usd.TimeCode(stage.GetStartTimeCode()), purposes)
    box = cache.ComputeWorldBound(stage.GetPseudoRoot()).ComputeAlignedRange()
    box = np.array([box.GetMin(), box.GetMax()]) * UsdGeom.GetStageMetersPerUnit(stage)
    del delegate
    up = UsdGeom.GetStageUpAxis(stage)
    corners = np.array([[x, y, z] for x in box[:, 0] for y in box[:, 1] for z in box[:, 2]])
    x, y, z = corners.T
    turned = np.stack({"X": (-y, x, z), "Y": (x, y, z), "Z": (x, z, -y)}[up], axis=1)
    theirs = np.stack([turned.min(axis=0), turned.max(axis=0)])
    # USD bounds the turned boxes of prims, so its box may be the larger one; extents are single precision.
    slack = 1e-5 * np.ptp(theirs, axis=0).max()
    assert (bounds(ours)[0] >= theirs[0] - slack).all()
    assert (bounds(ours)[1] <= theirs[1] + slack).all()
    if tight:
        assert np.allclose(bounds(ours), theirs, atol=10 * slack)


def test_the_scene_and_its_obj_twin_are_one_model():
    for usd, obj in (
        ("sample_data/meshes/amsterdam.usda", "amsterdam.obj"),
        ("sample_data/meshes/pizza.usda", "pizza.obj"),
    ):
        # The stage says z up of the coordinates that the OBJ file holds, too.
        ours = scene_triangles(load(asset(f"usd/kaolin/{usd}")))
        twin = scene_triangles(load(asset(f"obj/kaolin/{obj}"), up="z"))
        assert len(ours) == len(twin)
        assert np.allclose(bounds(ours), bounds(twin), atol=1e-5)
        assert area(ours) == pytest.approx(area(twin), rel=1e-5)


def test_usda_and_usdz_are_one_scene():
    one = load(asset("usd/kaolin/sample_data/meshes/pizza.usda"))
    other = load(asset("usd/kaolin/tests/samples/io/pizza.usdz"))
    assert one.materials == other.materials
    assert np.array_equal(scene_triangles(one), scene_triangles(other))


def test_native_instances_share_meshes():
    scene = load(asset(f"{WG}/intent-vfx/scenes/teapotScene.usd"), allow_outside=True)
    assert len(scene.objects) > 400
    assert len({id(one.mesh) for one in scene.objects}) < len(scene.objects) / 4
    missing = "asset ../assets/teapot/teapot_animCycle.usd could not be opened"
    assert any(one.message.startswith(missing) for one in scene.warnings)


@pytest.mark.parametrize(
    ("name", "colliders"),
    [
        ("newton/tests/assets/cube_cylinder.usda", [HullCollider, MeshCollider]),
        ("newton/tests/assets/negative_scale_mesh_pair.usda", [MeshCollider, MeshCollider]),
        ("newton/tests/assets/simple_articulation_with_mesh.usda", [HullCollider, HullCollider]),
        ("OpenUSD/usd/usdPhysics/examples/usdPhysicsBoxOnQuad.usda", [BoxCollider, HullCollider]),
        (
            "OpenUSD/usd/usdPhysics/examples/usdPhysicsSpheresWithMaterial.usda",
            [SphereCollider, SphereCollider, MeshCollider],
        ),
        ("PhysX/boxes_falling_on_groundplane.usda", None),
    ],
)
def test_physics(name, colliders):
    scene = load(asset(f"usd/{name}"))
    kinds = [type(collider) for one in scene.objects for collider in one.colliders]
    assert kinds == colliders if colliders else len(kinds) == 12


def test_a_unit_stored_as_float_is_read():
    assert len(load(asset("malformed/tinyusdz/models/suzanne.usdc")).objects) == 1


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("invalid-magic", "line 1"),
        ("references-002", "line 16"),
        ("no-primname", "line 3"),
        ("none-002", "line 5"),
        ("undefined-000", "line 4"),
        ("relative-path-001", "line 5"),
        ("string-with-newline", "line 11"),
        ("sublayers-001", "line 4"),
        ("2d-array-type", "line 5"),
        ("variantSet-in-meta-001", "line 2"),
    ],
)
def test_malformed(name, place, capfd):
    with pytest.raises(AssetError, match=place) as caught:
        load(asset(f"malformed/tinyusdz/tests/usda/fail-case/{name}.usda"))
    assert "\n" not in str(caught.value)
    assert "pegtl" not in str(caught.value)
    assert capfd.readouterr() == ("", "")
