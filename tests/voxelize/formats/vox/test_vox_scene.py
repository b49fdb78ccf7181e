"""MagicaVoxel files build like any asset: the same voxels as those that are read as they are."""

import struct

import numpy as np
import pytest
from oracles.sound_scenes import kinds

import voxrt
from voxrt.export import read_vox, write_vox
from voxrt.octree import Rom, from_points, to_dense
from voxrt.voxelize import EMPTY, Material, load

MATERIALS = (EMPTY, *(Material(f"m{i}", (50 * i, 255 - 50 * i, 9)) for i in range(1, 5)))


def art(path, seed, share):
    rng = np.random.default_rng(seed)
    points = np.argwhere(rng.random((16, 16, 16)) < share)
    write_vox(path, Rom("art", from_points(points, rng.integers(1, 5, len(points)).astype(np.uint8), 4), MATERIALS))
    return path


def shown(rom):
    """The colour of each solid voxel that lies open, and the solid voxels."""
    ids = np.pad(to_dense(rom.octree), 1)
    solid = ids != 0
    is_open = np.logical_or.reduce([~np.roll(solid, way, axis) for way in (-1, 1) for axis in range(3)])
    table = np.array([one.colour for one in rom.materials])
    return np.where((solid & is_open)[..., None], table[ids], 0), solid


@pytest.mark.parametrize("share", [0.02, 0.4, 0.97])
@pytest.mark.parametrize("seed", range(3))
def test_a_build_has_the_voxels_and_the_colours_of_the_file(seed, share, tmp_path):
    path = art(tmp_path / "art.vox", seed, share)
    built, read = voxrt.build(path).rom, read_vox(path)[0]
    assert built.grid.voxel_size == 1
    for ours, theirs in zip(shown(built), shown(read), strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_a_deeper_grid_has_cubes_of_the_file_and_units_are_those_of_its_voxels(tmp_path):
    path = art(tmp_path / "art.vox", 1, 0.3)
    read = to_dense(read_vox(path)[0].octree) != 0
    built = voxrt.build(path, depth=5, unit=0.1).rom
    np.testing.assert_array_equal(to_dense(built.octree) != 0, np.kron(read, np.ones((2, 2, 2), bool)))
    assert built.grid.voxel_size == pytest.approx(0.05)


def chunk(name, content=b"", children=b""):
    return name + struct.pack("<ii", len(content), len(children)) + content + children


def test_models_without_a_scene_graph_are_frames(tmp_path):
    models = b"".join(
        chunk(b"SIZE", struct.pack("<3i", 4, 4, 4)) + chunk(b"XYZI", struct.pack("<i4B", 1, at, 0, 0, 7))
        for at in range(3)
    )
    path = tmp_path / "old.vox"
    path.write_bytes(
        b"VOX " + struct.pack("<i", 150) + chunk(b"MAIN", b"", chunk(b"PACK", struct.pack("<i", 3)) + models)
    )
    first = load(path)
    assert kinds(first) == {"vox-animation": 2}
    lows = [load(path, time=number).objects[0].mesh.positions[:, 0].min() for number in range(4)]
    assert np.subtract(lows, lows[0]).tolist() == [0, 1, 2, 2]
    built = voxrt.build_animation(path, times=(0, 1, 2))
    assert len(built.blob.animation.frames) == 3
