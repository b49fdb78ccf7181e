"""Real assets by every rule: no thin part is lost, and no voxel is beyond those of ``touch``."""

import numpy as np
import pytest
from assets import asset, over_assets
from oracles.rules import dilated
from oracles.voxels import dense

from voxrt.voxelize import assign_colours, fit_grid, load, voxelize

NAMES = (
    "gltf/bevy/CornellBox/CornellBox.glb",
    "gltf/bevy/PalmTree/PalmTree.gltf",
    "gltf/bevy/animated/Fox.glb",
    "gltf/manifold/mengerSponge3.glb",
    "gltf/trimesh/CesiumMilkTruck.glb",
    "gltf/trimesh/nested.glb",
    "obj/assimp/spider.obj",
    "obj/kaolin/amsterdam.obj",
    "obj/kaolin/pizza.obj",
    "obj/odedstein-meshes/plane/plane_holes.obj",
    "obj/trimesh/quadknot.obj",
    "obj/trimesh/rabbit.obj",
    "stl/USD-Fileformat-plugins/car.stl",
    "usd/usd-wg-assets/full_assets/Teapot/Teapot.usd",
    "usd/usd-wg-assets/test_assets/_common/axis.usda",
)


@pytest.mark.parametrize("rule", ["centre", "half"])
@over_assets("name", NAMES)
def test_each_touched_voxel_is_filled_or_has_a_filled_neighbour(name, rule):
    scene = load(asset(name), allow_outside=True)
    grid = fit_grid(scene, depth=5)
    scene = assign_colours(scene, grid, colours=32)
    touched = dense(voxelize(scene, grid, fill="auto").voxels) != 0
    kept = voxelize(scene, grid, fill="auto", rule=rule)
    filled = dense(kept.voxels) != 0
    bare = dense(voxelize(scene, grid, fill="auto", rule=rule, thin="drop").voxels) != 0
    assert not (filled & ~touched).any()
    assert not (bare & ~filled).any()
    assert not (np.pad(touched, 1) & ~dilated(np.pad(filled, 1))).any()
    assert sum(one.voxels for one in kept.objects) == filled.sum()
