"""Real OBJ files against trimesh and against what is known of them."""

import numpy as np
import pytest
import trimesh
from assets import asset, need_assets
from oracles.sound_scenes import kinds
from oracles.surfaces import area, bounds, scene_triangles, volume

from voxrt.voxelize import AssetError
from voxrt.voxelize.assets import load

need_assets()


@pytest.mark.parametrize(
    ("name", "objects", "materials", "triangles"),
    [
        ("trimesh/rabbit.obj", 9, 1, 1252),
        ("trimesh/negative_indices.obj", 1, 1, 12),
        ("trimesh/quadknot.obj", 1, 1, 2880),
        ("assimp/spider.obj", 19, None, 1368),
        ("odedstein-meshes/skull/skull.obj", 1, 1, 100_002),
        ("odedstein-meshes/spot/spot_control_mesh.obj", 1, 1, 372),
        ("kaolin/amsterdam.obj", 18, 14, 3864),
        ("kaolin/pizza.obj", 1, None, 960),
    ],
)
def test_same_surface_as_trimesh(name, objects, materials, triangles):
    path = asset(f"obj/{name}")
    scene = load(path)
    assert len(scene.objects) == objects
    if materials:  # textured ones have a palette
        assert len(scene.materials) - 1 == materials
    ours = scene_triangles(scene)
    assert len(ours) == triangles
    theirs = trimesh.load(path, process=False, force="mesh").triangles
    assert np.allclose(bounds(ours), bounds(theirs), atol=1e-6 * np.abs(theirs).max())
    assert area(ours) == pytest.approx(area(theirs), rel=0.02)  # quads that are not flat may be cut either way
    assert volume(ours) == pytest.approx(volume(theirs), rel=0.02)


@pytest.mark.parametrize(
    ("name", "objects", "materials", "size"),
    [
        # trimesh counts negative numbers back from the end of the file and not from the face.
        ("tinyobjloader/cornell_box.obj", 8, 4, (556.0, 548.8, 559.2)),
        ("tinyobjloader/cornell_box_multimaterial.obj", 8, 4, (556.0, 548.8, 559.2)),
        ("tinyobjloader/missing_material_file.obj", 8, 4, (556.0, 548.8, 559.2)),
        ("assimp/regr01.obj", 55, 12, (1640.0, 1170.0, 338.0)),  # group names in Windows-1252
        ("trimesh/chair_model.obj", 4, 3, (0.531, 0.664, 0.527)),
    ],
)
def test_size(name, objects, materials, size):
    scene = load(asset(f"obj/{name}"))
    assert len(scene.objects) == objects
    assert len(scene.materials) - 1 == materials
    assert np.ptp(bounds(scene_triangles(scene)), axis=0).tolist() == pytest.approx(size, rel=0.01)


@pytest.mark.parametrize(("name", "triangles"), [("box_UTF16BE", 12), ("box_longline", 944), ("concave_polygon", 64)])
def test_odd_files(name, triangles):
    assert len(scene_triangles(load(asset(f"obj/assimp/{name}.obj")))) == triangles


def test_the_concave_polygon_does_not_overlap_itself():
    corners = scene_triangles(load(asset("obj/assimp/concave_polygon.obj")))
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    whole = normals.sum(axis=0)
    assert np.linalg.norm(whole) == pytest.approx(np.linalg.norm(normals, axis=1).sum(), rel=1e-3)


def test_unreadable_vertices_that_no_face_has_are_counted():
    scene = load(asset("obj/assimp/number_formats.obj"))
    assert kinds(scene)["unused-vertex"] == 6


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("assimp/invalid/empty.obj", "has no faces"),
        ("assimp/invalid/malformed.obj", "line 23: vertex 12 of a face does not exist: the file has 8"),
        ("trimesh/face_in_group_name.obj", "has no faces"),
    ],
)
def test_malformed(name, message):
    with pytest.raises(AssetError) as caught:
        load(asset(f"malformed/{name}"))
    assert message in str(caught.value)
