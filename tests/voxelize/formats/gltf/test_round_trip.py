"""Whole scenes written at random and read back: every triangle, its corners and its material."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.gltf_writer import GltfWriter

from voxrt.voxelize import load

COLOURS = [(0, 0, 0), (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)]


def corners_of(mode, corners):
    """The triangles of a primitive by the specification's formulas, less those that use a corner twice in strips."""
    count = len(corners)
    if mode == 4:
        return [tuple(corners[at : at + 3]) for at in range(0, count - count % 3, 3)]
    if mode == 5:
        made = [(corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]) for i in range(count - 2)]
    else:
        made = [(corners[i + 1], corners[i + 2], corners[0]) for i in range(count - 2)]
    return [triangle for triangle in made if len(set(triangle)) == 3]


@st.composite
def scenes(draw):
    """A writer, and for each object its world triangles and the colour of each."""
    writer = GltfWriter()
    used = draw(st.lists(st.sampled_from(COLOURS), min_size=1, max_size=4))
    for at, colour in enumerate(used):
        factor = [channel / 255 for channel in colour] + [1.0]
        writer.add("materials", {"name": f"m{at}", "pbrMetallicRoughness": {"baseColorFactor": factor}})
    meshes = []
    for _ in range(draw(st.integers(1, 3))):
        clouds = []
        for _ in range(draw(st.integers(1, 2))):
            points = draw(st.lists(st.tuples(*[st.integers(-9, 9)] * 3), min_size=3, max_size=8))
            dtype = draw(st.sampled_from(["f4", "i1", "i2"]))
            clouds.append((points, writer.accessor(points, dtype, stride=draw(st.sampled_from([None, 16, 28])))))
        primitives, expected = [], []
        for _ in range(draw(st.integers(1, 3))):
            points, accessor = draw(st.sampled_from(clouds))
            mode = draw(st.sampled_from([4, 5, 6]))
            primitive = {"attributes": {"POSITION": accessor}, "mode": mode}
            corners = list(range(len(points)))
            if draw(st.booleans()):
                corners = draw(st.lists(st.integers(0, len(points) - 1), min_size=1, max_size=9))
                primitive["indices"] = writer.accessor(corners, draw(st.sampled_from(["u1", "u2", "u4"])))
            material = draw(st.none() | st.integers(0, len(used) - 1))
            if material is not None:
                primitive["material"] = material
            primitives.append(primitive)
            colour = (200, 200, 200) if material is None else used[material]
            expected += [([points[corner] for corner in made], colour) for made in corners_of(mode, corners)]
        meshes.append((writer.add("meshes", {"primitives": primitives}), expected))
    objects = []
    for _ in range(draw(st.integers(1, 4))):
        mesh, expected = draw(st.sampled_from(meshes))
        scale = draw(st.tuples(*[st.sampled_from([-2, -1, 1, 3])] * 3))
        move = draw(st.tuples(*[st.integers(-50, 50)] * 3))
        writer.show(mesh=mesh, scale=scale, translation=move)
        if expected:
            objects.append([(np.array(corners) * scale + move, colour) for corners, colour in expected])
    return writer, objects


@settings(max_examples=150, deadline=None)
@given(scene=scenes().filter(lambda scene: scene[1]), suffix=st.sampled_from([".glb", ".gltf"]))
def test_scenes_are_read_back(scene, suffix, tmp_path_factory):
    writer, objects = scene
    read = load(writer.save(tmp_path_factory.getbasetemp() / f"round_trip{suffix}"))
    assert len(read.objects) == len(objects)
    for thing, expected in zip(read.objects, objects, strict=True):
        world = thing.mesh.positions @ thing.transform[:3, :3].T + thing.transform[:3, 3]
        found = world[thing.mesh.triangles]
        np.testing.assert_array_equal(found, [corners for corners, _ in expected])
        assert [read.materials[row].colour for row in thing.mesh.materials] == [colour for _, colour in expected]
