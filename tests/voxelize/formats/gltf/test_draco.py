"""Draco-compressed primitives that the library itself encoded."""

import DracoPy
import numpy as np
import pytest
import trimesh
from oracles.gltf_writer import GltfWriter

from voxrt.voxelize import AssetError, load

BALL = trimesh.creation.icosphere(subdivisions=2)


def compressed(data, *, mode=4, vertices=None, attributes=None, **accessors):
    """A node that shows a compressed ball; `accessors` are declared but hold no data of their own."""
    vertices = len(BALL.vertices) if vertices is None else vertices
    writer = GltfWriter()
    view = writer.view(data)
    position = writer.add("accessors", {"componentType": 5126, "type": "VEC3", "count": vertices})
    indices = writer.add("accessors", {"componentType": 5125, "type": "SCALAR", "count": 3 * len(BALL.faces)})
    extension = {"bufferView": view, "attributes": {"POSITION": 0} | (attributes or {})}
    declared = {name: writer.add("accessors", accessor) for name, accessor in accessors.items()}
    primitive = {
        "attributes": {"POSITION": position, **declared},
        "indices": indices,
        "mode": mode,
        "extensions": {"KHR_draco_mesh_compression": extension},
    }
    writer.show(mesh=writer.add("meshes", {"primitives": [primitive]}))
    writer.json["extensionsUsed"] = writer.json["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    return writer


def encoded(**options):
    return DracoPy.encode(BALL.vertices, BALL.faces, quantization_bits=16, **options)


@pytest.mark.parametrize("mode", [4, 5])
def test_a_ball_comes_back_within_its_quantization(mode, tmp_path):
    # Whatever the primitive's mode, compressed corners are a list of triangles.
    (thing,) = load(compressed(encoded(), mode=mode).save(tmp_path / "a.glb")).objects
    found = trimesh.Trimesh(thing.mesh.positions, thing.mesh.triangles)
    assert found.is_watertight
    assert len(found.faces) == len(BALL.faces)
    assert found.volume == pytest.approx(BALL.volume, rel=1e-3)


def test_compressed_colours_are_normalized_as_their_accessor_says(tmp_path):
    colours = np.tile(np.array([[255, 0, 0, 255]], np.uint8), (len(BALL.vertices), 1))
    data = encoded(colors=colours)
    numbers = {attribute["attribute_type"]: attribute["unique_id"] for attribute in DracoPy.decode(data).attributes}
    accessor = {"componentType": 5121, "type": "VEC4", "count": len(BALL.vertices), "normalized": True}
    writer = compressed(data, attributes={"POSITION": numbers[0], "COLOR_0": numbers[2]}, COLOR_0=accessor)
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [material.colour for material in scene.materials[1:]] == [(255, 0, 0)]


@pytest.mark.parametrize(
    ("writer", "message"),
    [
        (lambda: compressed(b"not a mesh"), r"primitives\[0\]\.extensions\.KHR_draco_mesh_compression: the Draco data"),
        (lambda: compressed(encoded()[:100]), r"the Draco data cannot be decoded"),
        (lambda: compressed(DracoPy.encode(BALL.vertices)), r"the Draco data is a point cloud, not a mesh"),
        (lambda: compressed(encoded(), mode=6), r"compressed primitives must be triangles or strips"),
        (lambda: compressed(encoded(), vertices=7), r"attributes\.POSITION: 162 x 3 numbers for an accessor of 7 VEC3"),
        (lambda: compressed(encoded(), attributes={"POSITION": 5}), r"there is no compressed attribute 5"),
    ],
)
def test_what_does_not_fit_is_refused(writer, message, tmp_path):
    with pytest.raises(AssetError, match=message):
        load(writer().save(tmp_path / "a.glb"))


def test_integers_cannot_stand_for_floats(tmp_path):
    writer = compressed(encoded())
    writer.json["accessors"][0]["componentType"] = 5123
    with pytest.raises(AssetError, match=r"attributes\.POSITION: compressed as another type than uint16"):
        load(writer.save(tmp_path / "a.glb"))
