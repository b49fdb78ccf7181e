"""One model in two formats gives the same voxels."""

import numpy as np
import pytest
from assets import asset, need_assets

from voxrt.voxelize import fit_grid, voxelize
from voxrt.voxelize.assets import load

need_assets()

ARRAYS = ("brick_codes", "brick_masks", "octant_codes", "octant_levels")


FOUNDATION = "usd/usd-wg-assets/test_assets/foundation/stage_configuration"
MODES = "gltf/assimp/Mesh_PrimitiveMode/Mesh_PrimitiveMode_{:02}.gltf"


@pytest.mark.parametrize(
    ("one", "other", "up"),
    [
        # The stages say z up of the coordinates that their OBJ twins hold, too.
        ("obj/kaolin/amsterdam.obj", "usd/kaolin/sample_data/meshes/amsterdam.usda", "z"),
        ("obj/kaolin/pizza.obj", "usd/kaolin/sample_data/meshes/pizza.usda", "z"),
        ("usd/kaolin/tests/samples/io/amsterdam.usdz", "usd/kaolin/sample_data/meshes/amsterdam.usda", None),
        ("usd/kaolin/tests/samples/io/pizza.usdz", "usd/kaolin/sample_data/meshes/pizza.usda", None),
    ],
)
@pytest.mark.parametrize("fill", ["solid", "surface"])
def test_the_same_voxels(one, other, up, fill):
    first, second = load(asset(one), up=up), load(asset(other))
    grid = fit_grid(first, depth=6)
    ours, twins = (voxelize(scene, grid, fill=fill).voxels for scene in (first, second))
    for name in ARRAYS:
        assert np.array_equal(getattr(ours, name), getattr(twins, name)), name


@pytest.mark.parametrize(
    ("one", "other", "up"),
    [
        ("gltf/gltf-pipeline/meshopt-no-fallback/meshopt-no-fallback.gltf",
         "gltf/gltf-pipeline/meshopt-fallback/meshopt-fallback.gltf", None),
        ("gltf/draco/Box/glTF_Binary/Box_Draco.glb", "gltf/trimesh/BoxInterleaved.glb", None),
        *((MODES.format(4), MODES.format(mode), None) for mode in (5, 6, 11, 12, 13, 14, 15)),
        ("obj/tinyobjloader/cornell_box.obj", "obj/tinyobjloader/missing_material_file.obj", None),
        ("stl/USD-Fileformat-plugins/suzanne.stl", "malformed/tinyusdz/models/suzanne.usdc", "z"),
        ("ply/trimesh/cube_blender_uv.ply", "ply/assimp/cube_uv.ply", None),
        (f"{FOUNDATION}/upAxis/upAxis_Y.usda", f"{FOUNDATION}/upAxis/upAxis_invalid.usda", None),
        (f"{FOUNDATION}/metersPerUnit/metersPerUnit_1.usda", f"{FOUNDATION}/metersPerUnit/metersPerUnit_10.usda", None),
    ],
)  # fmt: skip
def test_the_same_model_in_another_unit_or_encoding(one, other, up):
    """Each in its own grid: twins may differ in their unit, and stand elsewhere."""
    scenes = load(asset(one), up=up, allow_outside=True), load(asset(other), allow_outside=True)
    ours, twins = (voxelize(scene, fit_grid(scene, depth=6)).voxels for scene in scenes)
    for name in ARRAYS:
        assert np.array_equal(getattr(ours, name), getattr(twins, name)), name
