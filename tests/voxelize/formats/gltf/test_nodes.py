"""Places in the scene, against products of rotation matrices written out and trimesh's quaternions."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.gltf_writer import GltfWriter
from trimesh import transformations

from voxrt.voxelize import AssetError, load

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def shown(writer, path):
    """World transforms by object name."""
    return {thing.name: thing.transform for thing in load(writer.save(path)).objects}


numbers = st.floats(-100, 100, width=32)
vectors = st.lists(numbers, min_size=3, max_size=3)
quaternions = st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1)


@settings(max_examples=60, deadline=None)
@given(chain=st.lists(st.tuples(vectors, quaternions, vectors), min_size=1, max_size=4))
def test_chains_of_trs_are_products_of_translation_rotation_scale(chain, tmp_path_factory):
    writer = GltfWriter()
    mesh = writer.mesh(TRIANGLE)
    expected = np.eye(4)
    for at, (translation, quaternion, scale) in enumerate(chain):
        rotation = np.array(quaternion) / np.linalg.norm(quaternion)
        node = {"translation": translation, "rotation": rotation.tolist(), "scale": scale, "children": [at + 1]}
        if at == len(chain) - 1:
            node["children"], node["mesh"], node["name"] = [], mesh, "leaf"
        writer.show(**node) if at == 0 else writer.add("nodes", node)
        turn = transformations.quaternion_matrix(rotation[[3, 0, 1, 2]])
        expected = expected @ transformations.translation_matrix(translation) @ turn @ np.diag([*scale, 1])
    transform = shown(writer, tmp_path_factory.mktemp("nodes") / "a.gltf")["leaf"]
    np.testing.assert_allclose(transform, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())


def test_matrices_are_column_major_and_mirrors_are_kept(tmp_path):
    writer = GltfWriter()
    mesh = writer.mesh(TRIANGLE)
    matrix = [-1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0, 10, 20, 30, 1]
    writer.show(name="matrix", mesh=mesh, matrix=matrix)
    writer.show(name="scale", mesh=mesh, scale=[-1, 2, 3], translation=[10, 20, 30])
    scene = load(writer.save(tmp_path / "a.glb"))
    expected = [[-1, 0, 0, 10], [0, 2, 0, 20], [0, 0, 3, 30], [0, 0, 0, 1]]
    for thing in scene.objects:
        assert thing.transform.tolist() == expected
        assert thing.mesh.triangles.tolist() == [[0, 1, 2]]
    assert scene.objects[0].mesh is scene.objects[1].mesh


def test_objects_stand_in_authored_order_parents_before_children(tmp_path):
    writer = GltfWriter()
    mesh = writer.mesh(TRIANGLE)
    for name in ("c", "d", "b"):
        writer.add("nodes", {"name": name, "mesh": mesh})
    writer.json["nodes"][2]["children"] = [1, 0]
    writer.show(name="a", mesh=mesh, children=[2])
    writer.show(name="e", mesh=mesh)
    assert list(shown(writer, tmp_path / "a.glb")) == ["a", "b", "d", "c", "e"]


def test_names_that_repeat_say_which_node(tmp_path):
    writer = GltfWriter()
    mesh = writer.mesh(TRIANGLE)
    writer.json["meshes"][0]["name"] = "wheel"
    writer.show(name="left", mesh=mesh)
    writer.show(mesh=mesh)
    writer.show(name="wheel", mesh=mesh)
    assert list(shown(writer, tmp_path / "a.glb")) == ["left", "wheel (nodes[1])", "wheel (nodes[2])"]


def two_scenes():
    writer = GltfWriter()
    mesh = writer.mesh(TRIANGLE)
    for name in ("first", "second", "loose"):
        writer.add("nodes", {"name": name, "mesh": mesh})
    writer.json["scenes"] = [{"nodes": [0]}, {"nodes": [1]}]
    return writer


@pytest.mark.parametrize(("named", "name"), [(None, "first"), (0, "first"), (1, "second")])
def test_the_named_scene_or_the_first_is_shown_and_the_others_counted(named, name, tmp_path):
    writer = two_scenes()
    if named is not None:
        writer.json["scene"] = named
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [thing.name for thing in scene.objects] == [name]
    assert [(w.count) for w in scene.warnings if w.kind == "other-scenes"] == [1]


def test_without_scenes_all_roots_are_shown(tmp_path):
    writer = two_scenes()
    del writer.json["scenes"]
    writer.json["nodes"][0]["children"] = [2]
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [thing.name for thing in scene.objects] == ["first", "loose", "second"]
    assert "no-scene" in {warning.kind for warning in scene.warnings}


def test_a_listed_child_is_shown_once_and_where_its_parents_put_it(tmp_path):
    writer = GltfWriter()
    child = writer.add("nodes", {"name": "child", "mesh": writer.mesh(TRIANGLE), "translation": [1, 0, 0]})
    writer.add("nodes", {"children": [child], "scale": [2, 2, 2]})
    writer.json["scenes"] = [{"nodes": [0]}]
    scene = load(writer.save(tmp_path / "child.glb"))
    writer.json["scenes"] = [{"nodes": [0, 1]}]
    both = load(writer.save(tmp_path / "both.glb"))
    for shown_once in (scene, both):
        assert [thing.transform[:3, 3].tolist() for thing in shown_once.objects] == [[2, 0, 0]]
        assert "not-a-root" in {warning.kind for warning in shown_once.warnings}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"scene": 2}, r"scene: scene 2 does not exist, the file has 2"),
        ({"scenes": [{"nodes": [7]}]}, r"scenes\[0\]\.nodes\[0\]: node 7 does not exist, the file has 3"),
        ({"nodes": [{"children": [1]}, {"children": [0]}]}, r"nodes\[1\]: the node is its own ancestor"),
        ({"nodes": [{"children": [0]}, {}]}, r"nodes\[0\]: the node is its own ancestor"),
        ({"nodes": [{"children": [1, 1]}, {}]}, r"nodes\[0\]\.children\[1\]: node 1 already has a parent, node 0"),
        ({"nodes": [{"children": [2]}, {"children": [2]}, {}]}, r"nodes\[1\]\.children\[0\]: node 2 already has a"),
        ({"nodes": [{"children": [9]}, {}]}, r"nodes\[0\]\.children\[0\]: node 9 does not exist"),
        ({"nodes": [{"mesh": 9}, {}]}, r"nodes\[0\]\.mesh: mesh 9 does not exist, the file has 1"),
        ({"nodes": [{"rotation": [0, 0, 0, 0]}, {}]}, r"nodes\[0\]\.rotation: a quaternion of length 0, it must be 1"),
        ({"nodes": [{"matrix": [1] * 16}, {}]}, r"nodes\[0\]\.matrix: is not affine"),
        ({"nodes": [{"matrix": [1] * 15}, {}]}, r"nodes\[0\]\.matrix: expected `array` of length >= 16"),
        (
            {"nodes": [{"matrix": np.eye(4).ravel().tolist(), "scale": [1, 1, 1]}, {}]},
            r"nodes\[0\]: has a matrix and translation, rotation or scale as well",
        ),
        ({"nodes": [{"scale": [1e999, 1, 1]}, {}]}, r"the JSON cannot be read"),
        ({"nodes": [{"mesh": 0, "scale": [1e308, 1e308, 1], "translation": [1e308] * 3}, {}]}, r"overflows"),
    ],
)
def test_broken_hierarchies_are_refused_with_their_place(changes, message, tmp_path):
    writer = two_scenes()
    writer.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = writer.accessor(np.eye(3) * 3)
    writer.json |= changes
    with pytest.raises(AssetError, match=message):
        load(writer.save(tmp_path / "a.gltf"))


def test_a_chain_of_many_nodes_is_neither_deep_nor_slow(tmp_path):
    writer = GltfWriter()
    count = 20_000
    writer.json["nodes"] = [{"translation": [1, 0, 0], "children": [at + 1]} for at in range(count)]
    writer.json["nodes"].append({"mesh": writer.mesh(TRIANGLE)})
    writer.json["scenes"] = [{"nodes": [0]}]
    (leaf,) = load(writer.save(tmp_path / "a.glb")).objects
    assert leaf.transform[0, 3] == count


def test_quaternions_of_another_length_are_normalized_with_a_warning(tmp_path):
    writer = GltfWriter()
    writer.show(mesh=writer.mesh(TRIANGLE), rotation=[0, 0, 3, 3])
    scene = load(writer.save(tmp_path / "a.glb"))
    np.testing.assert_allclose(scene.objects[0].transform[:2, :2], [[0, -1], [1, 0]], atol=1e-15)
    assert "rotation-length" in {warning.kind for warning in scene.warnings}


def test_hidden_nodes_hide_what_hangs_below_them(tmp_path):
    writer = GltfWriter()
    mesh = writer.mesh(TRIANGLE)
    hidden = {"KHR_node_visibility": {"visible": False}}
    writer.show(name="shown", mesh=mesh, extensions={"KHR_node_visibility": {"visible": True}})
    writer.show(name="hidden", mesh=mesh, extensions=hidden, children=[2])
    writer.add("nodes", {"name": "below", "mesh": mesh})
    assert list(shown(writer, tmp_path / "a.glb")) == ["shown"]


def test_a_chain_whose_nodes_are_all_listed_is_shown_once_without_delay(tmp_path):
    writer = GltfWriter()
    count = 3000
    writer.json["nodes"] = [{"children": [at + 1]} for at in range(count)]
    writer.json["nodes"].append({"mesh": writer.mesh(TRIANGLE)})
    writer.json["scenes"] = [{"nodes": list(range(count, -1, -1))}]
    assert len(load(writer.save(tmp_path / "a.glb")).objects) == 1


def test_roots_listed_twice_are_shown_once_and_counted(tmp_path):
    writer = GltfWriter()
    writer.show(name="once", mesh=writer.mesh(TRIANGLE))
    writer.json["scenes"][0]["nodes"] *= 2
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [thing.name for thing in scene.objects] == ["once"]
    assert "repeated-root" in {warning.kind for warning in scene.warnings}


def test_transforms_that_overflow_together_are_refused(tmp_path):
    writer = GltfWriter()
    writer.show(scale=[1e200, 1, 1], children=[1])
    writer.add("nodes", {"scale": [1e200, 1, 1], "mesh": writer.mesh(TRIANGLE)})
    with pytest.raises(AssetError, match=r"nodes\[1\]: the transform overflows"):
        load(writer.save(tmp_path / "a.glb"))
