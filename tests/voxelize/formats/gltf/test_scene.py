"""Triangles, materials and what authors say in extras, on files made by hand."""

import json
import tracemalloc

import numpy as np
import pytest
from oracles.gltf_writer import GltfWriter
from oracles.sound_scenes import kinds

from voxrt.voxelize import (
    EMPTY,
    AssetError,
    BoxCollider,
    DoesNotFitError,
    HullCollider,
    Material,
    MeshCollider,
    SphereCollider,
    load,
)

SQUARE = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0], [2, 1, 0]]
TRIANGLE = SQUARE[:3]
POINTS, LINES, LOOP, LINE_STRIP, TRIANGLES, STRIP, FAN = range(7)


@pytest.mark.parametrize(
    ("mode", "indices", "expected"),
    [
        (None, None, [[0, 1, 2], [3, 4, 5]]),
        (TRIANGLES, [2, 1, 0, 5, 4, 3], [[2, 1, 0], [5, 4, 3]]),
        # The specification's order: p_i = v_i, v_(i + 1 + i mod 2), v_(i + 2 - i mod 2) and v_(i + 1), v_(i + 2), v_0.
        (STRIP, None, [[0, 1, 2], [1, 3, 2], [2, 3, 4], [3, 5, 4]]),
        (FAN, None, [[1, 2, 0], [2, 3, 0], [3, 4, 0], [4, 5, 0]]),
        (STRIP, [0, 1, 2, 2, 3, 3, 4, 5], [[0, 1, 2], [3, 5, 4]]),
        (FAN, [5, 4, 3, 2, 1, 0], [[4, 3, 5], [3, 2, 5], [2, 1, 5], [1, 0, 5]]),
    ],
)
@pytest.mark.parametrize("index_dtype", ["u1", "u2", "u4"])
def test_every_mode_with_area_makes_its_triangles(mode, indices, expected, index_dtype, tmp_path):
    writer = GltfWriter()
    writer.show(mesh=writer.mesh(SQUARE, indices, mode=mode, index_dtype=index_dtype))
    (thing,) = load(writer.save(tmp_path / "a.glb")).objects
    assert thing.mesh.positions[thing.mesh.triangles].tolist() == np.array(SQUARE)[expected].tolist()


def test_points_and_lines_are_counted_and_alone_refused(tmp_path):
    writer = GltfWriter()
    for mode in (POINTS, LINES, LOOP, LINE_STRIP):
        writer.show(mesh=writer.mesh(SQUARE, mode=mode))
    with pytest.raises(AssetError, match=r"no triangles to voxelize \(points were left out: .*; lines were left out: "):
        load(writer.save(tmp_path / "a.glb"))
    writer.show(mesh=writer.mesh(TRIANGLE))
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [w.message for w in scene.warnings if w.kind == "no-area"] == [
        f"{what} were left out: they have no area to voxelize"
        for what in ("points", "lines", "line loops", "line strips")
    ]


def test_corners_that_make_no_whole_triangle_are_counted(tmp_path):
    writer = GltfWriter()
    writer.show(mesh=writer.mesh(SQUARE[:5]))
    writer.show(mesh=writer.mesh(SQUARE[:2], mode=STRIP))
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [thing.mesh.triangles.tolist() for thing in scene.objects] == [[[0, 1, 2]]]
    assert kinds(scene)["incomplete-triangle"] == 2


@pytest.mark.parametrize(
    ("indices", "dtype", "message"),
    [
        ([0, 1, 6], "u2", r"meshes\[0\]\.primitives\[0\]\.indices: index 6 at 2 is out of range: there are 6 vertices"),
        ([0, 1, 65535], "u2", r"primitives\[0\]\.indices: a primitive restart, which glTF does not allow"),
        ([0, 1, 2], "i2", r"indices of type int16, they must be unsigned integers"),
        ([0, 1, 2], "f4", r"indices of type float32, they must be unsigned integers"),
    ],
)
def test_broken_indices_are_refused(indices, dtype, message, tmp_path):
    writer = GltfWriter()
    writer.show(mesh=writer.mesh(SQUARE, indices, index_dtype=dtype))
    with pytest.raises(AssetError, match=message):
        load(writer.save(tmp_path / "a.glb"))


@pytest.mark.parametrize(
    ("dtype", "normalized", "values", "expected"),
    [
        ("i1", True, [[-128, 0, 127], [127, 127, 127], [0, -127, 0]], [[-1, 0, 1], [1, 1, 1], [0, -1, 0]]),
        ("u2", False, [[0, 1, 65535], [2, 3, 4], [5, 6, 7]], [[0, 1, 65535], [2, 3, 4], [5, 6, 7]]),
    ],
)
def test_quantized_positions(dtype, normalized, values, expected, tmp_path):
    writer = GltfWriter()
    position = writer.accessor(values, dtype, normalized=normalized, stride=12)
    mesh = writer.add("meshes", {"primitives": [{"attributes": {"POSITION": position}}]})
    writer.show(mesh=mesh)
    writer.json["extensionsRequired"] = writer.json["extensionsUsed"] = ["KHR_mesh_quantization"]
    scene = load(writer.save(tmp_path / "a.glb"))
    assert scene.objects[0].mesh.positions.tolist() == expected


def test_unused_vertices_do_not_stretch_the_bounds(tmp_path):
    writer = GltfWriter()
    writer.show(mesh=writer.mesh([[9e9, 0, 0], *SQUARE], [1, 2, 3, 4, 5, 6]))
    (thing,) = load(writer.save(tmp_path / "a.glb")).objects
    assert thing.mesh.positions.tolist() == SQUARE


def test_a_small_file_that_asks_for_much_is_refused(tmp_path):
    path = tmp_path / "a.gltf"
    path.write_text(
        '{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],'
        '"accessors":[{"componentType":5126,"type":"VEC3","count":900000000}]}'
    )
    with pytest.raises(AssetError, match=r"accessors\[0\]: needs 10800000000 bytes, more than a file of this size"):
        load(path)


@pytest.mark.parametrize("count", [900_000, 3_000_000, 3_600_000, 2**31, 2**62])
@pytest.mark.parametrize("shared", [1, 40])
def test_the_memory_of_a_small_file_is_bounded_whatever_it_asks_for(count, shared, tmp_path):
    zeros = {"componentType": 5126, "type": "VEC3", "count": count}
    primitive = {"attributes": {"POSITION": 0}}
    gltf = {
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive | {"attributes": {"POSITION": at}} for at in range(shared)]}],
        "accessors": [zeros] * shared,
    }
    path = tmp_path / "a.gltf"
    path.write_text(json.dumps(gltf))
    tracemalloc.start()
    try:
        load(path)
    except AssetError as error:
        assert "more than a file of this size may use" in str(error)  # noqa: PT017
    finally:
        _, peak = tracemalloc.get_traced_memory()
        tracemalloc.stop()
    assert peak < 500 << 20


def materials_of(writer, path):
    scene = load(writer.save(path))
    return scene, [[scene.materials[m].name for m in thing.mesh.materials] for thing in scene.objects]


def two_coloured():
    """One mesh: a red, a bare and a blue triangle; the file also has an unused green material."""
    writer = GltfWriter()
    for name, colour in (("blue", [0, 0, 1, 1]), ("green", [0, 1, 0, 1]), ("red", [0.5, 0.214, 0, 1])):
        writer.add("materials", {"name": name, "pbrMetallicRoughness": {"baseColorFactor": colour}})
    shared = writer.accessor(SQUARE)
    primitives = [
        {"attributes": {"POSITION": shared}, "indices": writer.accessor(corners, "u1")}
        for corners in ([0, 1, 2], [1, 2, 3], [3, 4, 5])
    ]
    primitives[0]["material"], primitives[2]["material"] = 2, 0
    writer.add("meshes", {"primitives": primitives})
    return writer


def test_every_triangle_has_its_material_and_only_used_ones_are_listed_in_authored_order(tmp_path):
    writer = two_coloured()
    writer.show(mesh=0)
    scene, names = materials_of(writer, tmp_path / "a.glb")
    assert names == [["red", "default", "blue"]]
    assert scene.materials == (
        EMPTY,
        Material("blue", (0, 0, 255)),
        Material("red", (188, 127, 0)),
        Material("default", (200, 200, 200), authored=False),
    )
    assert kinds(scene) == {"default-material": 1}
    assert len(scene.objects[0].mesh.positions) == len(SQUARE)


def test_materials_get_unique_names(tmp_path):
    writer = GltfWriter()
    for name in ("a", "a", None, "default", "empty"):
        index = writer.add("materials", {"name": name} if name else {})
        writer.show(mesh=writer.mesh(TRIANGLE, material=index))
    writer.show(mesh=writer.mesh(TRIANGLE))
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [material.name for material in scene.materials] == [
        *("empty", "a", "a (2)", "materials[2]", "default", "empty (2)", "default (2)")
    ]


@pytest.mark.parametrize(("count", "fits"), [(255, True), (256, False)])
def test_more_than_255_materials_do_not_fit(count, fits, tmp_path):
    writer = GltfWriter()
    for at in range(count):
        colour = [at / 255, 0, 0, 1]
        index = writer.add("materials", {"name": f"m{at}", "pbrMetallicRoughness": {"baseColorFactor": colour}})
        writer.show(mesh=writer.mesh(TRIANGLE, material=index))
    path = writer.save(tmp_path / "a.glb")
    if fits:
        assert len(load(path).materials) == 256
    else:
        with pytest.raises(DoesNotFitError, match=r"a\.glb: uses more than 255 materials; merge some"):
            load(path)


def test_voxrt_material_of_a_node_names_the_material_of_its_faces(tmp_path):
    writer = two_coloured()
    writer.show(mesh=0, extras={"voxrt_material": "green"})
    writer.show(mesh=0)
    _, names = materials_of(writer, tmp_path / "a.glb")
    assert names == [["green"] * 3, ["red", "default", "blue"]]
    writer.json["nodes"][0]["extras"]["voxrt_material"] = "gren"
    with pytest.raises(AssetError, match=r"nodes\[0\]\.extras\.voxrt_material: no material 'gren'.*'blue', 'green'"):
        load(writer.save(tmp_path / "a.glb"))


def test_voxrt_material_of_materials_merges_them(tmp_path):
    writer = two_coloured()
    writer.json["materials"][0]["extras"] = writer.json["materials"][2]["extras"] = {"voxrt_material": "appearance"}
    writer.show(mesh=0)
    scene, names = materials_of(writer, tmp_path / "a.glb")
    assert names == [["appearance", "default", "appearance"]]
    assert scene.materials[1] == Material("appearance", (0, 0, 255))
    assert "merged-materials" in kinds(scene)


def test_voxrt_reflect_makes_mirrors(tmp_path):
    writer = two_coloured()
    writer.json["materials"][0]["extras"] = {"voxrt_reflect": 1}
    writer.show(mesh=0)
    writer.show(mesh=0, extras={"voxrt_reflect": True})
    scene = load(writer.save(tmp_path / "a.glb"))
    mirrors = [[scene.materials[m].mirror for m in thing.mesh.materials] for thing in scene.objects]
    assert mirrors == [[False, False, True], [True, True, True]]
    assert len({material.name for material in scene.materials}) == len(scene.materials)


def test_voxrt_collider_stands_in_for_the_mesh(tmp_path):
    writer = two_coloured()
    for kind in ("box", "sphere", "hull", "mesh"):
        writer.show(mesh=0, name=kind, extras={"voxrt_collider": kind, "other": 1})
    scene = load(writer.save(tmp_path / "a.glb"))
    box, sphere, hull, mesh = (thing.colliders[0] for thing in scene.objects)
    assert isinstance(box, BoxCollider)
    assert (box.minimum.tolist(), box.maximum.tolist(), box.pow2) == ([0, 0, 0], [2, 1, 0], True)
    assert isinstance(sphere, SphereCollider)
    assert (sphere.centre.tolist(), sphere.radius) == ([1, 0.5, 0], pytest.approx(1.25**0.5))
    assert isinstance(hull, HullCollider)
    assert hull.positions.tolist() == SQUARE
    assert isinstance(mesh, MeshCollider)
    assert mesh.triangles.tolist() == [[0, 1, 2], [1, 2, 3], [3, 4, 5]]
    assert {scene.materials[thing.collider_material].name for thing in scene.objects} == {"red"}
    assert kinds(scene)["collider-material"] == 4


@pytest.mark.parametrize(
    ("extras", "message"),
    [
        ({"voxrt_colider": "box"}, r"nodes\[0\]\.extras\.voxrt_colider: unknown property for voxrt; did you "),
        ({"voxrt_rule": "center"}, r"nodes\[0\]\.extras\.voxrt_rule: invalid enum value 'center'; use touch"),
        ({"voxrt_fill": "together"}, r"voxrt_fill: invalid enum value 'together'; use solid, surface, auto$"),
        ({"voxrt_collider": "cone"}, r"nodes\[0\]\.extras\.voxrt_collider: invalid enum value 'cone'; use box, sphere"),
        ({"voxrt_reflect": "yes"}, r"nodes\[0\]\.extras\.voxrt_reflect: expected `bool \| float`, got `str`"),
        ({"voxrt_material": 3}, r"nodes\[0\]\.extras\.voxrt_material: expected `str \| null`, got `int`"),
    ],
)
def test_wrong_properties_are_refused(extras, message, tmp_path):
    writer = two_coloured()
    writer.show(mesh=0, extras=extras)
    with pytest.raises(AssetError, match=message):
        load(writer.save(tmp_path / "a.gltf"))


def test_properties_in_the_wrong_place_are_refused(tmp_path):
    writer = two_coloured()
    writer.show(mesh=0)
    empty = writer.show(extras={"voxrt_collider": "box"})
    with pytest.raises(
        AssetError, match=rf"nodes\[{empty}\]\.extras\.voxrt_collider: the node shows no triangles; put "
    ):
        load(writer.save(tmp_path / "a.gltf"))
    writer.json["nodes"][empty] = {}
    writer.json["materials"][0]["extras"] = {"voxrt_collider": "box"}
    with pytest.raises(AssetError, match=r"materials\[0\]\.extras\.voxrt_collider: unknown property for voxrt"):
        load(writer.save(tmp_path / "a.gltf"))


@pytest.mark.parametrize("array", ["scenes", "meshes"])
def test_properties_on_scenes_and_meshes_are_refused(array, tmp_path):
    writer = two_coloured()
    writer.show(mesh=0)
    writer.json[array][0]["extras"] = {"voxrt_collider": "box"}
    with pytest.raises(
        AssetError, match=rf"{array}\[0\]\.extras: properties for voxrt belong on nodes and materials; move"
    ):
        load(writer.save(tmp_path / "a.gltf"))


@pytest.mark.parametrize("extras", [None, 3, "voxrt_", ["voxrt_collider"], {"other": {"voxrt_collider": 3}}])
def test_extras_of_others_are_left_alone(extras, tmp_path):
    writer = two_coloured()
    writer.show(mesh=0, extras=extras)
    assert len(load(writer.save(tmp_path / "a.gltf")).objects) == 1


def test_primitives_without_positions_are_counted(tmp_path):
    writer = two_coloured()
    writer.show(mesh=0)
    writer.json["meshes"][0]["primitives"].append({"attributes": {"NORMAL": 0}})
    scene = load(writer.save(tmp_path / "a.glb"))
    assert len(scene.objects[0].mesh.triangles) == 3
    assert kinds(scene)["no-positions"] == 1


def test_voxrt_ignore_leaves_an_object_out(tmp_path):
    writer = two_coloured()
    writer.show(mesh=0, name="own", extras={"voxrt_ignore": True})
    writer.show(mesh=0, name="other", extras={"voxrt_ignore": False})
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [one.name for one in scene.objects] == ["other"]
    assert kinds(scene)["ignored"] == 1


def test_voxrt_rule_and_fill_are_those_of_the_object(tmp_path):
    writer = two_coloured()
    writer.show(mesh=0, name="own", extras={"voxrt_rule": "centre", "voxrt_fill": "surface"})
    writer.show(mesh=0, name="other")
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [(one.name, one.rule, one.fill) for one in scene.objects] == [
        ("own", "centre", "surface"),
        ("other", None, None),
    ]
