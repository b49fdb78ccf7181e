"""Grids voxelized in squares of columns: the same octree and the same reports as at once."""

import pytest
from oracles.meshes import box_mesh, icosphere, joined, one_object, scene_of

import voxrt
from voxrt import octree
from voxrt.voxelize import Grid, Mesh, SceneObject, voxelize, voxelize_in_blocks


def in_blocks(scene, grid, side, **options):
    whole = octree.Assembly(grid.depth)
    report = voxelize_in_blocks(scene, grid, lambda voxels: whole.add(octree.build(voxels)), block_side=side, **options)
    return whole.octree(), report


def open_ball():
    ball = icosphere(3, (130.0, 120.0, 128.0), 100.0)
    return Mesh(ball.positions, ball.triangles[20:], ball.materials[20:])


def scenes():
    high = box_mesh((3, 3, 3), (250, 90, 17))
    yield one_object(joined(high, icosphere(2, (200.0, 190.0, 60.0), 50.0)))
    yield one_object(open_ball())
    yield scene_of(SceneObject("one", high), SceneObject("other", open_ball()))


@pytest.mark.parametrize("number", range(3))
@pytest.mark.parametrize("side", [64, 128, 256])
@pytest.mark.parametrize("fill", ["auto", "surface"])
def test_blocks_give_the_bytes_and_the_reports_of_the_whole(number, side, fill):
    scene, grid = list(scenes())[number], Grid(8, (0.0, 0.0, 0.0), 1.0)
    at_once = voxelize(scene, grid, fill=fill)
    tree, report = in_blocks(scene, grid, side, fill=fill)
    assert bytes(tree.words) == bytes(octree.build(at_once.voxels).words)
    assert report.objects == at_once.objects
    assert report.warnings == at_once.warnings


def test_a_build_with_little_memory_is_the_same(tmp_path):
    scene = scene_of(SceneObject("ball", icosphere(3, (0.0, 0.0, 0.0), 1.0)))
    small = voxrt.build(scene, tmp_path / "small", depth=11, memory=1 << 26)
    large = voxrt.build(scene, tmp_path / "large", depth=11, memory=1 << 40)
    assert bytes(small.octree.words) == bytes(large.octree.words)
    assert small.objects == large.objects
    assert set(small.seconds) == set(large.seconds)
    assert small.outputs["mem"].read_bytes() == large.outputs["mem"].read_bytes()
