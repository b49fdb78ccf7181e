"""Colliders of KHR_physics_rigid_bodies against the sizes their shapes state."""

import numpy as np
import pytest
from oracles.gltf_writer import GltfWriter

from voxrt.voxelize import AssetError, BoxCollider, HullCollider, MeshCollider, SphereCollider, load

TETRAHEDRON = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
FACES = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]


def scene_of(geometry, *shapes, on_mesh=True):
    writer = GltfWriter()
    mesh = writer.mesh(TETRAHEDRON, FACES)
    writer.json["extensions"] = {"KHR_implicit_shapes": {"shapes": list(shapes)}}
    writer.json["extensionsUsed"] = ["KHR_physics_rigid_bodies", "KHR_implicit_shapes"]
    body = {"KHR_physics_rigid_bodies": {"motion": {"mass": 5.0}, "collider": {"geometry": geometry}}}
    if on_mesh:
        writer.show(name="thing", mesh=mesh, extensions=body)
    else:
        writer.show(name="thing", mesh=mesh)
        writer.show(name="guard", extensions=body, translation=[7, 0, 0])
    return writer


def collider(tmp_path, geometry, *shapes):
    (thing,) = load(scene_of(geometry, *shapes).save(tmp_path / "a.glb")).objects
    return thing.colliders


def test_boxes_and_balls_are_centred_in_their_node(tmp_path):
    shapes = ({"type": "box", "box": {"size": [1, 2, 3]}}, {"type": "sphere", "sphere": {"radius": 4}})
    (box,) = collider(tmp_path, {"shape": 0}, *shapes)
    assert isinstance(box, BoxCollider)
    assert (box.minimum.tolist(), box.maximum.tolist()) == ([-0.5, -1, -1.5], [0.5, 1, 1.5])
    (ball,) = collider(tmp_path, {"shape": 1}, *shapes)
    assert isinstance(ball, SphereCollider)
    assert (ball.centre.tolist(), ball.radius) == ([0, 0, 0], 4)


@pytest.mark.parametrize("kind", ["cylinder", "capsule"])
def test_round_shapes_are_hulls_within_a_thousandth(kind, tmp_path):
    shape = {"type": kind, kind: {"height": 4, "radiusTop": 1, "radiusBottom": 2}}
    (hull,) = collider(tmp_path, {"shape": 0}, shape)
    assert isinstance(hull, HullCollider)
    ends = {"cylinder": (-2, 2), "capsule": (-4, 3)}[kind]
    np.testing.assert_allclose(hull.positions.min(axis=0), [-2, ends[0], -2], rtol=1e-3)
    np.testing.assert_allclose(hull.positions.max(axis=0), [2, ends[1], 2], rtol=1e-3)
    distance = np.linalg.norm(hull.positions - [0, 2 if kind == "capsule" else 0, 0], axis=1)
    upper = hull.positions[:, 1] > 1.9
    if kind == "capsule":
        np.testing.assert_allclose(distance[upper], 1, rtol=1e-9)


def test_planes_with_an_end_are_sheets_and_others_are_counted(tmp_path):
    (sheet,) = collider(tmp_path, {"shape": 0}, {"type": "plane", "plane": {"sizeX": 2, "sizeZ": 6}})
    assert isinstance(sheet, MeshCollider)
    corners = sheet.positions[sheet.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    assert normals.sum(axis=0).tolist() == [0, 12, 0]
    scene = load(scene_of({"shape": 0}, {"type": "plane"}).save(tmp_path / "a.glb"))
    assert scene.objects[0].colliders == ()
    assert "endless-plane" in {warning.kind for warning in scene.warnings}


@pytest.mark.parametrize("hull", [True, False])
@pytest.mark.parametrize("source", ["mesh", "node"])
def test_meshes_collide_as_they_are_or_as_their_hull(hull, source, tmp_path):
    (made,) = collider(tmp_path, {source: 0, "convexHull": hull})
    assert isinstance(made, HullCollider if hull else MeshCollider)
    assert made.positions.tolist() == TETRAHEDRON


def test_a_collider_without_mesh_is_an_object_of_its_own(tmp_path):
    writer = scene_of({"shape": 0}, {"type": "box"}, on_mesh=False)
    writer.add("materials", {"name": "steel"})
    thing, guard = load(writer.save(tmp_path / "a.glb")).objects
    assert (thing.colliders, guard.name, len(guard.mesh.triangles)) == ((), "guard", 0)
    assert guard.transform[0, 3] == 7
    writer.json["nodes"][1]["extras"] = {"voxrt_material": "steel"}
    scene = load(writer.save(tmp_path / "a.glb"))
    assert scene.materials[scene.objects[1].collider_material].name == "steel"


def test_a_skin_leaves_the_collider_of_its_node_behind(tmp_path):
    writer = scene_of({"shape": 0}, {"type": "box"})
    thing = writer.json["nodes"][0] | {"skin": 0, "translation": [7, 0, 0]}
    writer.json["nodes"][0] = thing
    attributes = writer.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["JOINTS_0"] = writer.accessor([[0, 0, 0, 0]] * 4, "u1")
    attributes["WEIGHTS_0"] = writer.accessor([[1, 0, 0, 0]] * 4)
    writer.add("skins", {"joints": [writer.add("nodes", {})]})
    skinned, guard = load(writer.save(tmp_path / "a.glb")).objects
    assert (skinned.name, skinned.colliders, skinned.transform[0, 3]) == ("thing", (), 0)
    assert (guard.name, len(guard.colliders), guard.transform[0, 3]) == ("thing collider", 1, 7)


@pytest.mark.parametrize(
    ("geometry", "shape", "message"),
    [
        ({}, {"type": "box"}, r"nodes\[0\]\.extensions\.KHR_physics_rigid_bodies\.collider\.geometry: names neither"),
        ({"shape": 3}, {"type": "box"}, r"collider\.geometry\.shape: shape 3 does not exist, the file has 1"),
        ({"mesh": 3}, {"type": "box"}, r"collider\.geometry\.mesh: mesh 3 does not exist, the file has 1"),
        ({"shape": 0}, {"type": "box", "box": {"size": [1, 0, 1]}}, r"shapes\[0\]\.box: a size is not positive"),
        ({"shape": 0}, {"type": "sphere", "sphere": {"radius": -1}}, r"shapes\[0\]\.sphere: a size is not positive"),
        (
            {"shape": 0},
            {"type": "cylinder", "cylinder": {"radiusTop": -1, "radiusBottom": 3}},
            r"shapes\[0\]\.cylinder: a radius is negative",
        ),
        ({"shape": 0}, {"type": "torus"}, r"extensions\.KHR_implicit_shapes\.shapes\[0\]\.type: invalid enum value"),
    ],
)
def test_broken_colliders_are_refused(geometry, shape, message, tmp_path):
    with pytest.raises(AssetError, match=message):
        collider(tmp_path, geometry, shape)
