"""Morphs, skins, animations and instances against numbers worked out by hand or by other formulas."""

from itertools import pairwise

import numpy as np
import pytest
from assets import asset
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.gltf_writer import GltfWriter
from trimesh import transformations

from voxrt.voxelize import AssetError, load

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def positions(writer, path, **options):
    (thing,) = load(writer.save(path), **options).objects
    return thing.mesh.positions @ thing.transform[:3, :3].T + thing.transform[:3, 3]


def morphing(**node):
    writer = GltfWriter()
    mesh = writer.mesh(TRIANGLE)
    up, right = writer.accessor([[0, 2, 0]] * 3), writer.accessor(3, sparse=([1], [[4, 0, 0]], "u1"))
    primitive = writer.json["meshes"][mesh]["primitives"][0]
    primitive["targets"] = [{"POSITION": up}, {"POSITION": right}]
    writer.json["meshes"][mesh]["weights"] = [0.0, 0.5]
    writer.show(mesh=mesh, **node)
    return writer


@pytest.mark.parametrize(
    ("node", "expected"),
    [
        ({}, [[0, 0, 0], [3, 0, 0], [0, 1, 0]]),
        ({"weights": [0.5, 0.0]}, [[0, 1, 0], [1, 1, 0], [0, 2, 0]]),
        ({"weights": [1.0, 0.25]}, [[0, 2, 0], [2, 2, 0], [0, 3, 0]]),
    ],
)
def test_morph_weights_of_the_node_go_before_those_of_the_mesh(node, expected, tmp_path):
    assert positions(morphing(**node), tmp_path / "a.glb").tolist() == expected


def test_one_mesh_in_two_shapes_is_two_values(tmp_path):
    writer = morphing(weights=[1.0, 0.0])
    writer.show(mesh=0)
    writer.show(mesh=0)
    first, second, third = load(writer.save(tmp_path / "a.glb")).objects
    assert first.mesh is not second.mesh
    assert second.mesh is third.mesh


def test_targets_of_another_size_are_refused(tmp_path):
    writer = morphing()
    writer.json["meshes"][0]["primitives"][0]["targets"][1]["POSITION"] = writer.accessor([[0, 0, 0]] * 4)
    with pytest.raises(AssetError, match=r"primitives\[0\]\.targets\[1\]\.POSITION: moves 4 of 3 vertices"):
        load(writer.save(tmp_path / "a.glb"))


def arm(weights, joints=((0, 1, 0, 0),) * 3, *, bound=True, dtype="u1"):
    """A triangle on two joints: the first moves by (10, 0, 0), the second, its child, turns it a quarter about z."""
    writer = GltfWriter()
    attributes = {"JOINTS_0": writer.accessor(joints, dtype), "WEIGHTS_0": writer.accessor(weights)}
    mesh = writer.mesh(TRIANGLE, **attributes)
    half = np.sqrt(0.5)
    root = writer.add("nodes", {"translation": [10, 0, 0], "children": [1]})
    writer.add("nodes", {"translation": [0, 5, 0], "rotation": [0, 0, half, half]})
    skin = {"joints": [root, 1]}
    if bound:
        unmoved, down = np.eye(4), np.eye(4)
        down[1, 3] = -5.0
        skin["inverseBindMatrices"] = writer.accessor([unmoved.T, down.T])
    writer.add("skins", skin)
    # The node's own transform does not move what its skin carries.
    shown = writer.show(mesh=mesh, skin=0, translation=[99, 99, 99])
    writer.json["scenes"][0]["nodes"] = [root, shown]
    return writer


def test_skins_carry_vertices(tmp_path):
    moved = positions(arm([[1, 0, 0, 0]] * 3), tmp_path / "a.glb")
    np.testing.assert_allclose(moved, np.add(TRIANGLE, (10, 0, 0)), atol=1e-12)
    # Second joint: down 5, a quarter turn, up 5, and 10 to the right: (x, y) goes to (15 - y, 5 + x).
    turned = positions(arm([[0, 1, 0, 0]] * 3), tmp_path / "b.glb")
    np.testing.assert_allclose(turned, [[15, 5, 0], [15, 6, 0], [14, 5, 0]], atol=1e-6)
    both = positions(arm([[2, 2, 0, 0]] * 3), tmp_path / "c.glb")
    np.testing.assert_allclose(both, (moved + turned) / 2, atol=1e-6)


def test_joints_outside_the_scene_are_where_their_parents_put_them(tmp_path):
    writer = arm([[0, 1, 0, 0]] * 3)
    writer.json["scenes"][0]["nodes"] = [2]
    np.testing.assert_allclose(positions(writer, tmp_path / "a.glb")[0], [15, 5, 0], atol=1e-6)


def test_vertices_without_weight_follow_the_first_joint_and_are_counted(tmp_path):
    writer = arm([[0, 0, 0, 0]] * 3)
    np.testing.assert_allclose(positions(writer, tmp_path / "a.glb"), np.add(TRIANGLE, (10, 0, 0)))
    kinds = {warning.kind: warning.count for warning in load(tmp_path / "a.glb").warnings}
    assert kinds["skin"] == 3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"joints": [[0, 2, 0, 0]] * 3}, r"attributes\.JOINTS_0: joint 2 of a skin that has 2"),
        ({"joints": [[0, 1, 0, 0]] * 3, "dtype": "f4"}, r"attributes\.JOINTS_0: joints of type float32"),
        ({"weights": [[0, -1, 0, 0]] * 3}, r"attributes\.WEIGHTS_0: a weight is negative or not a number"),
        ({"weights": [[0, 1, 0, 0]] * 4}, r"attributes\.JOINTS_0: 3 joints and 4 weights for 3 vertices"),
    ],
)
def test_broken_skins_are_refused(arguments, message, tmp_path):
    writer = arm(**({"weights": [[0, 1, 0, 0]] * 3} | arguments))
    with pytest.raises(AssetError, match=message):
        load(writer.save(tmp_path / "a.glb"))


def test_unused_influences_may_name_any_joint(tmp_path):
    writer = arm([[1, 0, 0, 0]] * 3, joints=[[0, 77, 0, 0]] * 3)
    np.testing.assert_allclose(positions(writer, tmp_path / "a.glb")[0], [10, 0, 0])


def animated(path, keys, values, interpolation="LINEAR", **node):
    writer = GltfWriter()
    target = writer.show(mesh=writer.mesh(TRIANGLE), name="moved", **node)
    sampler = {"input": writer.accessor(keys), "output": writer.accessor(values), "interpolation": interpolation}
    channel = {"sampler": 0, "target": {"node": target, "path": path}}
    writer.add("animations", {"samplers": [sampler], "channels": [channel]})
    return writer


@pytest.mark.parametrize(
    ("interpolation", "time", "expected"),
    [
        ("LINEAR", 0.0, 0),
        ("LINEAR", 1.0, 0),
        ("LINEAR", 1.5, 4),
        ("LINEAR", 2.0, 8),
        ("LINEAR", 3.0, 6),
        ("LINEAR", 9.0, 4),
        ("STEP", 1.99, 0),
        ("STEP", 2.0, 8),
        ("STEP", 99.0, 4),
    ],
)
def test_linear_and_step_keys(interpolation, time, expected, tmp_path):
    writer = animated("translation", [1.0, 2.0, 4.0], [[0, 0, 0], [8, 0, 0], [4, 0, 0]], interpolation)
    assert positions(writer, tmp_path / "a.glb", time=time)[0].tolist() == [expected, 0, 0]


@given(
    numbers=st.lists(st.floats(-10, 10, width=32), min_size=6, max_size=6),
    span=st.floats(0.25, 4, width=32),
    share=st.floats(0, 0.99),
)
@settings(max_examples=40, deadline=None)
def test_cubic_keys_are_hermite_splines(numbers, span, share, tmp_path_factory):
    _, start, leaving, arriving, end, _ = numbers
    values = [[numbers[at], 0, 0] for at in range(6)]
    writer = animated("translation", [0.0, span], values, "CUBICSPLINE")
    found = positions(writer, tmp_path_factory.mktemp("cubic") / "a.glb", time=share * span)[0, 0]
    # The same cubic by its Bezier points (de Casteljau).
    points = [start, start + leaving * span / 3, end - arriving * span / 3, end]
    while len(points) > 1:
        points = [a + (b - a) * share for a, b in pairwise(points)]
    assert found == pytest.approx(points[0], abs=1e-4)


quaternions = st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1)


@given(start=quaternions, end=quaternions, share=st.floats(0, 0.99))
@settings(max_examples=40, deadline=None)
def test_rotations_turn_along_the_shorter_arc(start, end, share, tmp_path_factory):
    start, end = (np.array(q, np.float32) / np.linalg.norm(q) for q in (start, end))
    writer = animated("rotation", [0.0, 1.0], [start, end])
    (thing,) = load(writer.save(tmp_path_factory.mktemp("slerp") / "a.glb"), time=share).objects
    between = transformations.quaternion_slerp(start[[3, 0, 1, 2]], end[[3, 0, 1, 2]], share, shortestpath=True)
    np.testing.assert_allclose(thing.transform, transformations.quaternion_matrix(between), atol=1e-5)


def test_weights_and_scales_are_animated_and_normalized_keys_read(tmp_path):
    writer = animated("scale", [0.0, 1.0], [[1, 1, 1], [3, 1, 1]])
    assert positions(writer, tmp_path / "a.glb", time=0.5)[1].tolist() == [2, 0, 0]
    writer = morphing()
    samplers = [
        {"input": writer.accessor([0.0, 1.0]), "output": writer.accessor([0, 0, 255, 0], "u1", normalized=True)}
    ]
    channels = [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]
    writer.add("animations", {"samplers": samplers, "channels": channels})
    assert positions(writer, tmp_path / "b.glb", time=0.5).tolist() == [[0, 1, 0], [1, 1, 0], [0, 2, 0]]


def test_without_a_time_the_file_stands_still_and_says_so(tmp_path):
    writer = animated("translation", [1.0], [[5, 0, 0]], translation=[1, 2, 3])
    scene = load(writer.save(tmp_path / "a.glb"))
    assert scene.objects[0].transform[:3, 3].tolist() == [1, 2, 3]
    assert [warning.kind for warning in scene.warnings if warning.kind == "animation"] == ["animation"]


@pytest.mark.parametrize(
    ("keys", "values", "path", "message"),
    [
        ([1.0, 1.0], [[0, 0, 0]] * 2, "translation", r"samplers\[0\]\.input: the times do not increase"),
        ([0.0, 1.0], [[0, 0, 0]] * 3, "translation", r"samplers\[0\]\.output: 9 numbers for 2 keys of translation"),
        ([0.0, 1.0], [[0, 0, 0]] * 2, "rotation", r"samplers\[0\]\.output: 6 numbers for 2 keys of rotation"),
        ([0.0, 1.0], [[0, 0, 0, 0]] * 2, "rotation", r"nodes\[0\]\.rotation: a quaternion of length 0"),
    ],
)
def test_broken_animations_are_refused(keys, values, path, message, tmp_path):
    writer = animated(path, keys, values)
    with pytest.raises(AssetError, match=message):
        load(writer.save(tmp_path / "a.glb"), time=0.5)


def test_a_time_without_animation_is_refused(tmp_path):
    writer = GltfWriter()
    writer.show(mesh=writer.mesh(TRIANGLE))
    with pytest.raises(AssetError, match=r"a time was given, and the file has no animation; leave it out"):
        load(writer.save(tmp_path / "a.glb"), time=0.0)


def test_the_fox_runs():
    path = asset("gltf/bevy/animated/Fox.glb")
    (still,), (first,), (later,) = (load(path, time=time).objects for time in (None, 0.0, 0.5))
    assert still.mesh.positions.shape == first.mesh.positions.shape == later.mesh.positions.shape
    assert np.abs(first.mesh.positions - later.mesh.positions).max() > 0.5
    edges = [
        np.linalg.norm(np.diff(thing.mesh.positions[thing.mesh.triangles], axis=1), axis=2) for thing in (still, later)
    ]
    assert np.median(edges[0] / edges[1]) == pytest.approx(1.0, abs=0.02)


def instanced(**attributes):
    writer = GltfWriter()
    extension = {"attributes": {name: writer.accessor(values) for name, values in attributes.items()}}
    writer.show(
        name="tree",
        mesh=writer.mesh(TRIANGLE),
        translation=[100, 0, 0],
        extensions={"EXT_mesh_gpu_instancing": extension},
    )
    return writer


def test_instances_scale_turn_and_move_in_the_frame_of_their_node(tmp_path):
    half = np.sqrt(0.5)
    writer = instanced(
        TRANSLATION=[[0, 0, 0], [5, 0, 0]], ROTATION=[[0, 0, 0, 1], [0, 0, half, half]], SCALE=[[1, 1, 1], [2, 3, 4]]
    )
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [thing.name for thing in scene.objects] == ["tree [0]", "tree [1]"]
    first, second = (thing.transform for thing in scene.objects)
    np.testing.assert_allclose(first[:3], [[1, 0, 0, 100], [0, 1, 0, 0], [0, 0, 1, 0]])
    np.testing.assert_allclose(second[:3], [[0, -3, 0, 105], [2, 0, 0, 0], [0, 0, 4, 0]], atol=1e-6)


def test_instances_that_disagree_are_refused(tmp_path):
    writer = instanced(TRANSLATION=[[0, 0, 0]] * 2, SCALE=[[1, 1, 1]] * 3)
    with pytest.raises(AssetError, match=r"different numbers of instances: TRANSLATION 2, SCALE 3"):
        load(writer.save(tmp_path / "a.glb"))


def test_a_million_instances_of_nothing_are_refused(tmp_path):
    writer = instanced(TRANSLATION=[[0, 0, 0]] * 2)
    writer.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        "TRANSLATION": writer.add("accessors", {"componentType": 5126, "type": "VEC3", "count": 1_000_000})
    }
    with pytest.raises(AssetError, match=r"needs 1024000000 bytes"):
        load(writer.save(tmp_path / "a.glb"))


def test_what_is_not_played_is_counted(tmp_path):
    writer = animated("translation", [0.0, 1.0], [[0, 0, 0], [1, 0, 0]])
    channels = writer.json["animations"][0]["channels"]
    channels += [{"sampler": 0, "target": {"path": "pointer"}}, {"sampler": 0, "target": {"node": 0, "path": "colour"}}]
    writer.json["animations"].append(writer.json["animations"][0])
    scene = load(writer.save(tmp_path / "a.glb"), time=0.5)
    assert [warning.message for warning in scene.warnings if warning.kind == "animation"] == [
        "animations after the first were not played: --animation chooses another",
        "animations of 'pointer' were not played",
        "animations of 'colour' were not played",
    ]


def test_nodes_with_matrices_cannot_be_animated(tmp_path):
    writer = animated("translation", [0.0], [[0, 0, 0]], matrix=np.eye(4).ravel().tolist())
    with pytest.raises(AssetError, match=r"channels\[0\]\.target\.node: node 0 has a matrix and cannot be animated"):
        load(writer.save(tmp_path / "a.glb"), time=0.0)


def test_fewer_bind_matrices_than_joints_are_refused(tmp_path):
    writer = arm([[1, 0, 0, 0]] * 3)
    writer.json["skins"][0]["joints"] += [0]
    with pytest.raises(AssetError, match=r"skins\[0\]\.inverseBindMatrices: 2 matrices for 3 joints"):
        load(writer.save(tmp_path / "a.glb"))


def test_instances_that_are_not_placed_are_shown_once(tmp_path):
    writer = instanced(_ID=[[1.0, 2.0]] * 5)
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [thing.name for thing in scene.objects] == ["tree"]
    assert "instancing" in {warning.kind for warning in scene.warnings}


@pytest.mark.parametrize(
    ("choice", "x"), [({"time": 1.0}, 1), ({"time": 1.0, "animation": "jump"}, 5), ({"animation": "1"}, 3)]
)
def test_an_animation_is_chosen_by_name_or_number(choice, x, tmp_path):
    writer = GltfWriter()
    writer.show(mesh=writer.mesh(TRIANGLE))
    for name, start in (("walk", 0), ("jump", 3)):
        output = writer.accessor([[start, 0, 0], [start + 2, 0, 0]])
        sampler = {"input": writer.accessor([0.0, 1.0 if name == "jump" else 2.0]), "output": output}
        channel = {"sampler": 0, "target": {"node": 0, "path": "translation"}}
        writer.add("animations", {"name": name, "samplers": [sampler], "channels": [channel]})
    path = tmp_path / "a.glb"
    assert positions(writer, path, **choice)[0].tolist() == [x, 0, 0]
    with pytest.raises(AssetError, match=r"no animation 'swim' in the file; it has 'walk', 'jump'"):
        load(path, animation="swim")
