"""Real meshes whose faces were turned at random are as solid as the winding number of the file's own faces says."""

import zlib

import numpy as np
import pytest
from assets import asset, over_assets
from oracles.meshes import MATERIALS
from oracles.voxels import dense, snap, winding_at

from voxrt.voxelize import Mesh, Scene, SceneObject, fit_grid, load, voxelize

NAMES = (
    "gltf/Vulkan-Assets/retroufo.glb",
    "gltf/bevy/AlienCake/alien.glb",
    "gltf/bevy/CornellBox/CornellBox.glb",
    "gltf/bevy/PalmTree/PalmTree.gltf",
    "gltf/bevy/animated/Fox.glb",
    "gltf/bevy/animated/MorphStressTest.gltf",
    "gltf/draco/Box/glTF_Binary/Box_Draco.glb",
    "gltf/glTF-Transform/functions/test/in/DenseSphere.glb",
    "gltf/glTF-Transform/functions/test/in/ShapeCollection.glb",
    "gltf/gltf-pipeline/meshopt-fallback/meshopt-fallback.gltf",
    "gltf/gltf-pipeline/meshopt-no-fallback/meshopt-no-fallback.gltf",
    "gltf/manifold/mengerSponge3.glb",
    "gltf/trimesh/BoxInterleaved.glb",
    "gltf/trimesh/CesiumMilkTruck.glb",
    "gltf/trimesh/nested.glb",
    "obj/assimp/box_without_lineending.obj",
    "obj/assimp/cube_with_vertexcolors.obj",
    "obj/assimp/regr01.obj",
    "obj/assimp/spider.obj",
    "obj/kaolin/amsterdam.obj",
    "obj/kaolin/pizza.obj",
    "obj/odedstein-meshes/spot/spot_control_mesh.obj",
    "obj/trimesh/negative_indices.obj",
    "obj/trimesh/quadknot.obj",
    "obj/trimesh/rabbit.obj",
    "ply/USD-Fileformat-plugins/colors.ply",
    "ply/assimp/cube_binary_header_with_RN_newline.ply",
    "ply/assimp/cube_uv.ply",
    "ply/trimesh/cube_blender_uv.ply",
    "stl/USD-Fileformat-plugins/ascii.stl",
    "stl/trimesh/two_objects_mixed_case_names.stl",
    "trouble/manifold/Cray_left.obj",
    "trouble/manifold/Cray_right.obj",
    "trouble/manifold/Havocglass8_left.obj",
    "trouble/manifold/Offset2.obj",
    "trouble/manifold/self_intersectA.obj",
    "trouble/trimesh/two_objects.obj",
    "usd/tinyusdz/blendshape.usdc",
    "usd/tinyusdz/texturedcube.usdc",
    "usd/usd-wg-assets/full_assets/Vehicles/USD_Mini_Car_Kit/assets/wheels/wheelNormal/geo/wheelNormalGeo.usda",
    "usd/usd-wg-assets/test_assets/_common/axis.usda",
    "usd/usd-wg-assets/test_assets/foundation/stage_composition/purpose.usda",
)
CELLS = 300


def closed_objects(scene):
    """The objects of a scene whose edges have two faces each, wound against one another."""
    for item in scene.objects:
        if item.hidden or item.colliders or len(item.mesh.triangles) < 4:
            continue
        _, welded = np.unique(item.mesh.positions + 0.0, axis=0, return_inverse=True)
        corners = welded.reshape(-1)[item.mesh.triangles]
        ways = np.stack([corners, np.roll(corners, -1, axis=1)], axis=-1).reshape(-1, 2)
        one_way = len(np.unique(ways, axis=0)) == len(ways) and (ways[:, 0] != ways[:, 1]).all()
        if one_way and np.array_equal(np.unique(ways, axis=0), np.unique(ways[:, ::-1], axis=0)):
            yield item


@over_assets("name", NAMES)
@pytest.mark.parametrize("share", [0.1, 0.3])
def test_turned_faces_of_real_meshes(name, share):
    rng = np.random.default_rng(zlib.crc32(name.encode()))
    for item in list(closed_objects(load(asset(name))))[:3]:
        triangles = item.mesh.triangles
        turned = np.where(rng.random((len(triangles), 1)) < share, triangles[:, ::-1], triangles)
        mesh = Mesh(item.mesh.positions, turned.astype(np.int32), np.ones(len(turned), np.uint8))
        scene = Scene("turned", [SceneObject("it", mesh, item.transform)], MATERIALS)
        grid = fit_grid(scene, depth=5)
        filled, covered = (dense(voxelize(scene, grid, fill=fill).voxels) != 0 for fill in ("solid", "surface"))
        cells = np.argwhere(~covered)
        cells = cells[rng.permutation(len(cells))[:CELLS]]
        vertices = snap(mesh.positions, item.transform, grid.origin, grid.voxel_size)
        number = winding_at(cells * 4096.0 + 2048.5, vertices, triangles)
        np.testing.assert_array_equal(filled[tuple(cells.T)], np.abs(number) > 0.5, err_msg=item.name)
