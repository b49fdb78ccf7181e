"""Real files: sizes as glTF-Transform measured them, and the triangles of trimesh where it is right."""

import numpy as np
import pytest
import trimesh
from assets import asset, need_assets
from oracles.surfaces import area, bounds, scene_triangles, volume

from voxrt.voxelize import AssetError, load

need_assets()


@pytest.mark.parametrize(
    ("name", "triangles", "size", "uniform"),
    [
        ("gltf/trimesh/CesiumMilkTruck.glb", 3624, (4.87, 2.58, 2.79), 2),
        ("gltf/trimesh/no_indices_3storybuilding.glb", 72, (56.1, 9, 63.4), 1),
        ("gltf/trimesh/nested.glb", 36, (1.44, 3.34, 0.539), 1),
        ("gltf/trimesh/BoxInterleaved.glb", 12, (1, 1, 1), 1),
        ("gltf/bevy/AlienCake/alien.glb", 292, (0.483, 0.843, 0.33), 5),
        ("gltf/bevy/AlienCake/cakeBirthday.glb", 1332, (0.639, 0.364, 0.639), 7),
        ("gltf/bevy/animated/Fox.glb", 576, (25.2, 79, 155), 0),
        ("gltf/bevy/CornellBox/CornellBox.glb", 36, (556, 549, 559), 5),
        ("gltf/bevy/PalmTree/PalmTree.gltf", 10124, (392, 4.86, 392), 3),
        ("gltf/Vulkan-Assets/retroufo.glb", 16428, (146, 89.3, 146), 7),
        ("gltf/glTF-Transform/functions/test/in/ShapeCollection.glb", 3542, (14.5, 2, 2.5), 1),
        ("gltf/draco/KhronosSampleModels/SimpleSparseAccessor/glTF/SimpleSparseAccessor.gltf", *(12, (6, 4, 0), 1)),
        ("gltf/gltf-pipeline/meshopt-fallback/meshopt-fallback.gltf", 60, (2, 4.71, 2), 2),
        ("gltf/manifold/mengerSponge3.glb", 21598, (1, 1, 1), 0),
        ("gltf/draco/Box/glTF_Binary/Box_Draco.glb", 12, (1, 1, 1), 1),
        ("gltf/glTF-Transform/functions/test/in/DenseSphere.glb", 30720, (1.85, 1.86, 1.85), 1),
        ("gltf/glTF-Transform/extensions/test/in/DracoSparseMesh.gltf", 102, (0.0262, 0.0395, 0.00295), 1),
        ("gltf/bevy/animated/MorphStressTest.gltf", 2412, (4, 0.6, 1), 0),
        ("gltf/3d-demo-data/scene.glb", 21883, (11.4, 7.01, 11.4), 13),
        ("gltf/meshoptimizer/pirate.glb", 5010, (1.52, 1.91, 0.455), 1),
        ("gltf/gltf-pipeline/meshopt-no-fallback/meshopt-no-fallback.gltf", 60, (2, 4.71, 2), 2),
        ("gltf/cesium-native/0.gltf", 21, (1.78e5, 1.56e5, 3.31e5), 1),
    ],
)
def test_sizes_are_those_that_another_reader_measured(name, triangles, size, uniform):
    scene = load(asset(name))
    corners = scene_triangles(scene)
    assert len(corners) == triangles
    painted = {
        appearance.name
        for thing in scene.objects
        if thing.mesh.appearance
        for appearance in thing.mesh.appearance.entries
    }
    assert sum(material.name not in painted for material in scene.materials[1:]) == uniform
    np.testing.assert_allclose(np.ptp(bounds(corners), axis=0), size, rtol=6e-3, atol=1e-9)


@pytest.mark.parametrize(
    "name",
    [
        "gltf/trimesh/CesiumMilkTruck.glb",
        "gltf/trimesh/nested.glb",
        "gltf/bevy/AlienCake/alien.glb",
        "gltf/bevy/CornellBox/CornellBox.glb",
        "gltf/Vulkan-Assets/retroufo.glb",
        "gltf/manifold/mengerSponge3.glb",
    ],
)
def test_triangles_are_those_of_trimesh(name):
    path = asset(name)
    ours = scene_triangles(load(path))
    theirs = trimesh.load_scene(path, process=False).to_mesh().triangles
    assert len(ours) == len(theirs)
    for corners in (ours, theirs):
        assert np.isfinite(corners).all()

    def ordered(corners):
        """Triangles as sets of rounded corners, in an order that both readers share."""
        rows = np.round(corners, 3).reshape(-1, 9)
        return corners[np.lexsort(rows.T)]

    np.testing.assert_allclose(ordered(ours).sum(axis=1), ordered(theirs).sum(axis=1), rtol=0, atol=0.01)
    np.testing.assert_allclose(volume(ours), volume(theirs), rtol=1e-4, atol=1e-4)


def test_primitive_modes_of_the_generator():
    for number in (4, 5, 6, 11, 12, 13, 14, 15):
        path = asset(f"gltf/assimp/Mesh_PrimitiveMode/Mesh_PrimitiveMode_{number:02}.gltf")
        corners = scene_triangles(load(path))
        assert (len(corners), area(corners)) == (2, pytest.approx(1))
    for number in (0, 1, 2, 3, 7, 8, 9, 10):
        with pytest.raises(AssetError, match="has no triangles to voxelize"):
            load(asset(f"gltf/assimp/Mesh_PrimitiveMode/Mesh_PrimitiveMode_{number:02}.gltf"))


def test_negative_scales_are_kept_as_transforms():
    scene = load(asset("gltf/bevy/PalmTree/PalmTree.gltf"))
    assert any(np.linalg.det(thing.transform[:3, :3]) < 0 for thing in scene.objects)


BUILDS_ALTHOUGH_MALFORMED = {"BoxBadNormals.glb", "texcoord_crash.gltf"}


def test_malformed_files_are_refused_in_one_line():
    folder = asset("malformed")
    files = sorted(path for path in folder.rglob("*") if path.suffix in {".gltf", ".glb"})
    assert len(files) > 30
    for path in files:
        if path.name in BUILDS_ALTHOUGH_MALFORMED:
            assert load(path).objects
            continue
        with pytest.raises(AssetError) as caught:
            load(path)
        assert "\n" not in str(caught.value)


def test_instances_share_one_mesh():
    scene = load(asset("gltf/glTF-Blender-IO/24_gpu_instancing.gltf"))
    assert len(scene.objects) == 1900
    assert len({id(thing.mesh) for thing in scene.objects}) == 2
    assert sum(len(thing.mesh.triangles) for thing in scene.objects) == 7_656_770
