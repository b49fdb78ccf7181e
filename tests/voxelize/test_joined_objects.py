"""The parts of one surface that a file has in several objects are filled as one surface."""

import numpy as np
import pytest
from msgspec.structs import replace
from oracles.meshes import MATERIALS, box_mesh, icosphere
from oracles.voxels import dense

from voxrt.voxelize import Appearance, CornerNormals, Grid, Mesh, Scene, SceneObject, SurfaceAppearance, voxelize
from voxrt.voxelize.colour.appearance import sample
from voxrt.voxelize.joined_objects import is_open, join_open_objects

GRID = Grid(4, (0, 0, 0), 1.0)
BOX = box_mesh((2, 2, 2), (14, 14, 14))


def scene_with(*items):
    return Scene("parts", items, MATERIALS)


def parts_of(mesh, *groups):
    """Return meshes of some triangles each, with the vertices that they use alone."""
    found = []
    for group in groups:
        used, corners = np.unique(mesh.triangles[group], return_inverse=True)
        found.append(Mesh(mesh.positions[used], corners.reshape(-1, 3).astype(np.int32), mesh.materials[group]))
    return found


def test_a_box_and_its_lid_are_filled_together():
    body, lid = parts_of(BOX, slice(0, 10), slice(10, 12))
    scene = scene_with(SceneObject("body", body), SceneObject("lid", lid))
    assert (dense(voxelize(scene, GRID).voxels) != 0).sum() < 12**3
    result = voxelize(join_open_objects(scene), GRID)
    assert [(one.name, one.voxels) for one in result.objects] == [("body + lid", 12**3)]


@pytest.mark.parametrize("mirror", [1, -1])
def test_each_part_may_lie_in_a_frame_of_its_own(mirror):
    """Each part is written in another frame, which its transform leads back from; some are mirrored."""
    rng = np.random.default_rng(5)
    items = []
    for i, part in enumerate(parts_of(BOX, *(slice(2 * n, 2 * n + 2) for n in range(6)))):
        transform = np.diag([2.0, 0.5 * mirror, 4.0, 1.0])[[*rng.permutation(3), 3]]
        transform[:3, 3] = rng.integers(-8, 8, 3)
        own = (part.positions - transform[:3, 3]) @ np.linalg.inv(transform[:3, :3]).T
        turned = np.linalg.det(transform[:3, :3]) < 0
        items.append(SceneObject(str(i), replace(part, positions=own,
                                                 triangles=part.triangles[:, ::-1] if turned else part.triangles),
                                 transform))  # fmt: skip
    joined = join_open_objects(scene_with(*items))
    assert joined.objects[0].name == "0 + 1 + 2 + 3 more"
    expected = dense(voxelize(scene_with(SceneObject("whole", BOX)), GRID).voxels)
    np.testing.assert_array_equal(dense(voxelize(joined, GRID).voxels), expected)


def test_what_closes_alone_has_colliders_or_is_hidden_stays():
    body, lid = parts_of(BOX, slice(0, 10), slice(10, 12))
    ball = SceneObject("ball", icosphere(2, (8, 8, 8), 3))
    hidden = SceneObject("hidden", lid, hidden=True)
    scene = scene_with(ball, SceneObject("body", body), hidden, SceneObject("lid", lid))
    assert [one.name for one in join_open_objects(scene).objects] == ["ball", "body + lid", "hidden"]
    alone = scene_with(ball, SceneObject("body", body), hidden)
    assert join_open_objects(alone) is alone


def test_a_mesh_is_open_where_faces_do_not_meet_a_face_wound_against_them():
    assert not is_open(BOX)
    assert not is_open(Mesh(BOX.positions[BOX.triangles].reshape(-1, 3), np.arange(36).reshape(12, 3), BOX.materials))
    assert not is_open(Mesh(np.empty((0, 3)), np.empty((0, 3), np.int32), np.empty(0, np.uint8)))
    assert is_open(parts_of(BOX, slice(0, 11))[0])
    turned = BOX.triangles.copy()
    turned[3] = turned[3, ::-1]
    assert is_open(Mesh(BOX.positions, turned, BOX.materials))


def test_colours_and_normals_stay_with_their_corners():
    first, second = parts_of(BOX, slice(0, 1), slice(1, 2))
    rng = np.random.default_rng(1)
    red = SurfaceAppearance([Appearance("red", (1, 0, 0, 1))], [0], np.zeros((1, 3, 2)), np.ones((1, 3, 4)))
    many = SurfaceAppearance([Appearance("many")], [0], np.zeros((1, 3, 2)), rng.random((1, 3, 4)))
    first = replace(first, appearance=red)
    second = replace(second, appearance=many, normals=CornerNormals([[1, 2, 3], [0, 0, 1]], [[0, -1, 1]]))
    mirrored = np.diag([-2.0, 1.0, 1.0, 1.0])
    joined = join_open_objects(scene_with(SceneObject("a", first), SceneObject("b", second, mirrored))).objects[0].mesh
    colours = sample(joined.appearance, np.array([0, 1, 1, 1]), np.vstack([[1, 0, 0], np.eye(3)]))
    np.testing.assert_allclose(colours[0], (1, 0, 0, 1))
    np.testing.assert_allclose(colours[1:], many.colours[0][[0, 2, 1]], atol=1e-6)
    corners = joined.positions[joined.triangles[1]]
    np.testing.assert_allclose(corners, (second.positions[second.triangles[0]] * (-2, 1, 1))[[0, 2, 1]])
    across = np.array([-1 / 2, 2, 3]) / np.linalg.norm([-1 / 2, 2, 3])
    np.testing.assert_allclose(joined.normals.of_corners(), [np.zeros((3, 3)), [across, (0, 0, 1), (0, 0, 0)]])
