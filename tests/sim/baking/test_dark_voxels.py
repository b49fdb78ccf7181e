"""No voxel with a face that is open to the sky is nearly black: crowded surfaces, and real scenes."""

import numpy as np
from assets import asset, over_assets
from oracles.meshes import icosphere

import voxrt
from voxrt.octree import material_at
from voxrt.sim import _bake
from voxrt.sim.baking.bake import bake_light
from voxrt.sim.baking.daylight import Daylight
from voxrt.voxelize import EMPTY, Material, Scene, SceneObject

FACES = np.concatenate([np.eye(3, dtype=int), -np.eye(3, dtype=int)])


def darkest(built):
    """Light of each voxel as part of what the brightest of its exposed faces gets, both of the sun and the sky."""
    tree, light = built.rom.octree, bake_light(built.rom, built.scene)
    daylight = Daylight()

    def received(places, way, directions):
        normals = np.tile((16384 * way).astype(np.int16), (len(places), 1))
        return _bake.receive_light(
            tree.words, tree.depth, places, normals, directions.steps, directions.units, directions.weights, 0
        )

    brightest = np.zeros(len(light.voxels))
    for way in FACES:
        beyond = np.ascontiguousarray(light.voxels + way, np.int32)
        within = ((beyond >= 0) & (beyond < tree.size)).all(axis=1)
        is_open = ~within
        is_open[within] = material_at(tree, beyond[within]) == 0
        sky = received(beyond[is_open], way, _bake.sky_directions(daylight.samples))
        sun = received(beyond[is_open], way, _bake.sun_direction(daylight.sun))
        share = np.mean(daylight.sky) * sky.received / (65536 * np.maximum(sky.full, 1)) + 0.65 * sun.received / 2**44
        brightest[is_open] = np.maximum(brightest[is_open], share)
    own = light.sun + np.mean(daylight.sky) * light.sky
    return (own / np.maximum(brightest, 1e-12))[brightest > 0.02].min(initial=1.0)


def test_pebbles_that_crowd_are_not_black():
    rng = np.random.default_rng(4)
    materials = (EMPTY, Material("stone", (200, 200, 200)))
    pebbles = [icosphere(2, rng.uniform((2, 2, 2), (30, 5, 30)), rng.uniform(0.8, 2)) for _ in range(160)]
    scene = Scene("beach", tuple(SceneObject(f"pebble {i}", mesh) for i, mesh in enumerate(pebbles)), materials)
    assert darkest(voxrt.build(scene, depth=5)) >= 0.1


@over_assets(
    "name",
    [
        "gltf/3d-demo-data/scene.glb",
        "gltf/assimp/Mesh_PrimitiveMode/Mesh_PrimitiveMode_05.gltf",
        "gltf/assimp/Mesh_PrimitiveMode/Mesh_PrimitiveMode_11.gltf",
        "gltf/assimp/Mesh_PrimitiveMode/Mesh_PrimitiveMode_13.gltf",
        "gltf/assimp/Mesh_PrimitiveMode/Mesh_PrimitiveMode_15.gltf",
        "gltf/bevy/AlienCake/cakeBirthday.glb",
        "gltf/bevy/PalmTree/PalmTree.gltf",
        "gltf/bevy/animated/MorphStressTest.gltf",
        "gltf/cesium-native/0.gltf",
        "gltf/draco/VertexColorTest/glTF/VertexColorTest.gltf",
        "gltf/glTF-Transform/functions/test/in/DenseSphere.glb",
        "gltf/glTF-Transform/functions/test/in/ShapeCollection.glb",
        "gltf/gltf-pipeline/meshopt-no-fallback/meshopt-no-fallback.gltf",
        "gltf/trimesh/BoxInterleaved.glb",
        "gltf/trimesh/CesiumMilkTruck.glb",
        "gltf/trimesh/nested.glb",
        "obj/assimp/box_longline.obj",
        "obj/assimp/concave_polygon.obj",
        "obj/assimp/number_formats.obj",
        "obj/assimp/spider.obj",
        "obj/kaolin/pizza.obj",
        "obj/odedstein-meshes/skull/skull.obj",
        "obj/odedstein-meshes/spot/spot_control_mesh.obj",
        "obj/tinyobjloader/cornell_box_multimaterial.obj",
        "obj/trimesh/chair_model.obj",
        "obj/trimesh/negative_indices.obj",
        "ply/USD-Fileformat-plugins/gargo.ply",
        "ply/assimp/cube_uv.ply",
        "ply/assimp/float-color.ply",
        "ply/trimesh/cycloidal.ply",
        "trouble/assimp/OBJ/WusonOBJ.obj",
        "trouble/manifold/Cray_left.obj",
        "trouble/manifold/Offset2.obj",
        "trouble/manifold/openscad-nonmanifold-crash.obj",
        "trouble/trimesh/not_convex.obj",
        "trouble/trimesh/two_objects.obj",
        "usd/OpenUSD/usd/usdPhysics/examples/usdPhysicsBoxOnQuad.usda",
        "usd/OpenUSD/usdImaging/usdImagingGL/testenv/testUsdImagingGLGeomSubsets/testUsdImagingGLGeomSubsets.usda",
        "usd/PhysX/boxes_falling_on_groundplane.usda",
        "usd/kaolin/sample_data/meshes/amsterdam.usda",
    ],
)
def test_real_scenes(name):
    assert darkest(voxrt.build(asset(name), depth=6)) >= 0.1
