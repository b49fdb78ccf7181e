"""Voxels against their meshes, where the answer is known."""

import sys

import numpy as np
import pytest
from msgspec.structs import replace

from voxrt.octree import Rom, from_dense
from voxrt.sim import Camera, Lighting, SimulatorError, compare, comparison_sheet, frame_scene, render
from voxrt.voxelize import EMPTY, Appearance, Grid, Material, Mesh, Scene, SceneObject, SurfaceAppearance
from voxrt.voxelize.colour.srgb import linear_from_srgb

SIZE = (96, 72)
MATERIALS = (EMPTY, Material("red", (220, 60, 40)), Material("blue", (40, 60, 220)))
GRID = Grid(5, (-3.0, 1.0, 2.0), 0.25)


def box_scene(*boxes):
    """Boxes (corner, corner, material) given in voxels, as a scene in metres."""
    objects = []
    for i, (low, high, material) in enumerate(boxes):
        corners = np.array([[(low, high)[j >> a & 1][a] for a in range(3)] for j in range(8)], np.float64)
        quads = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
        triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], np.int32)
        place = np.eye(4)
        place[:3, :3] *= GRID.voxel_size
        place[:3, 3] = GRID.origin
        mesh = Mesh(corners, triangles, np.full(12, material, np.uint8))
        objects.append(SceneObject(f"box {i}", mesh, place))
    return Scene("boxes", tuple(objects), MATERIALS)


def box_rom(*boxes, grid=GRID):
    voxels = np.zeros((32, 32, 32), np.uint8)
    for low, high, material in boxes:
        voxels[tuple(slice(a, b) for a, b in zip(low, high, strict=True))] = material
    return Rom("boxes", from_dense(voxels), MATERIALS, grid)


BOXES = (((4, 2, 6), (20, 12, 24), 1), ((8, 12, 8), (12, 28, 12), 2))


@pytest.fixture(scope="module", autouse=True)
def _open3d():
    pytest.importorskip("open3d", exc_type=ImportError, reason="Open3D, the extra 'compare', is not installed")


def test_boxes_on_the_grid_are_seen_the_same():
    rom = box_rom(*BOXES)
    camera = frame_scene(rom, SIZE)
    found = compare(box_scene(*BOXES), rom, camera, SIZE)
    assert found.likeness.silhouette_iou > 0.995  # rays along an edge fall to either side in 32-bit floats
    assert found.likeness.depth_95 < 1e-3
    assert found.likeness.normal_agreement > 0.995
    assert found.likeness.normal_cosine > 0.99
    assert found.likeness.ssim > 0.99
    assert found.likeness.psnr > 30
    by_angle = render(rom, camera, SIZE, engine="model", lighting=Lighting(faces=None))
    np.testing.assert_array_equal(found.voxels.colour, by_angle.colour)
    sheet = comparison_sheet(found)
    assert sheet.shape == (72, 288, 3)
    assert np.mean(sheet[:, 192:] == 0) > 0.98


def test_painted_meshes_show_their_paint():
    scene, rom = box_scene(*BOXES), box_rom(*BOXES)
    camera = frame_scene(rom, SIZE)
    bare = compare(scene, rom, camera, SIZE).meshes.colour
    # Vertex colours that are the materials' own: nothing may change, where the materials say otherwise.
    painted = []
    for item in scene.objects:
        linear = linear_from_srgb(np.array(MATERIALS[item.mesh.materials[0]].colour, np.uint8))
        colours = np.broadcast_to(np.append(linear, 1.0).astype(np.float32), (12, 3, 4))
        appearance = SurfaceAppearance((Appearance("p"),), np.zeros(12, np.int32), np.zeros((12, 3, 2)), colours)
        painted.append(replace(item, mesh=replace(item.mesh, appearance=appearance)))
    black = (EMPTY, *[Material("black", (0, 0, 0))] * 2)
    found = compare(replace(scene, objects=tuple(painted), materials=black), rom, camera, SIZE).meshes.colour
    np.testing.assert_array_equal(found, bare)


def test_a_voxel_of_error_along_the_look_is_a_voxel_of_depth():
    # Along -z from the front; the voxels' front face stands 1.5 voxels nearer than the mesh's.
    scene = box_scene(((4, 4, 4), (28, 28, 22.5), 1))
    rom = box_rom(((4, 4, 4), (28, 28, 24), 1))
    camera = Camera((16 * 16, 16 * 16, 16 * 400), (0, 0, -4000), (1, 0, 0), (0, 1, 0))
    found = compare(scene, rom, camera, SIZE)
    assert found.likeness.silhouette_iou == 1
    assert found.likeness.depth_median == pytest.approx(1.5, abs=1e-3)
    assert found.likeness.depth_mean == pytest.approx(1.5, abs=1e-3)
    assert found.likeness.normal_cosine == pytest.approx(1)


def test_what_is_missing_on_one_side_costs_silhouette():
    rom = box_rom(((4, 4, 4), (20, 20, 20), 1))
    camera = Camera((16 * 12, 16 * 12, 16 * 300), (0, 0, -2000), (1, 0, 0), (0, 1, 0))
    half = compare(box_scene(((4, 4, 4), (12, 20, 20), 1)), rom, camera, SIZE)
    assert 0.45 < half.likeness.silhouette_iou < 0.55
    away = compare(box_scene(((40, 40, 4), (50, 50, 20), 1)), rom, camera, SIZE)
    assert away.likeness.silhouette_iou == 0
    assert np.isnan(away.likeness.depth_mean)
    assert np.isnan(away.likeness.normal_cosine)


def test_a_mirrored_instance_is_cast_where_it_stands():
    (scene,) = [box_scene(((4, 2, 6), (20, 12, 24), 1))]
    mirror = scene.objects[0].transform.copy()
    mirror[:3, 0] *= -1
    mirror[0, 3] += 24 * GRID.voxel_size  # x -> 24 - x keeps the box's own extent
    mirrored = Scene("boxes", (SceneObject("box", scene.objects[0].mesh, mirror),), MATERIALS)
    rom = box_rom(((4, 2, 6), (20, 12, 24), 1))
    found = compare(mirrored, rom, frame_scene(rom, SIZE), SIZE)
    assert found.likeness.silhouette_iou > 0.995
    assert found.likeness.normal_cosine > 0.99


def test_a_memory_without_a_place_is_refused():
    rom = box_rom(*BOXES, grid=None)
    with pytest.raises(SimulatorError, match="boxes does not say where it stands"):
        compare(box_scene(*BOXES), rom, frame_scene(rom, SIZE), SIZE)


def test_a_missing_open3d_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "open3d", None)
    rom = box_rom(*BOXES)
    with pytest.raises(SimulatorError, match=r"needs Open3D.*pip install open3d"):
        compare(box_scene(*BOXES), rom, frame_scene(rom, SIZE), SIZE)
