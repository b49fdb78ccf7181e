"""Octants as files for other programs, read back by readers of ours and of others."""

from __future__ import annotations

import base64
import json
import re
import zipfile
import zlib

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.random_worlds import dense_cubes
from PIL import Image

from voxrt import export, octree, view, voxelize
from voxrt.export.vox import write_vox
from voxrt.view.animation import write_animation
from voxrt.view.octant_files import write_glb, write_ply
from voxrt.view.octant_page import write_page
from voxrt.voxelize import EMPTY, DoesNotFitError, Grid, Material

MATERIALS = (EMPTY, *(Material(f"m{n}", (n, 255 - n, n * 7 % 256)) for n in range(1, 256)))


def rom_of(cube, grid=None):
    return octree.Rom("world", octree.from_dense(cube), MATERIALS, grid)


def mesh_of(rom):
    return view.Pane(rom).mesh()


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return tmp_path_factory.mktemp("files")


@given(cube=dense_cubes(max_depth=5), data=st.data())
@settings(max_examples=30)
def test_magicavoxel_scenes_come_back(file, cube, data):
    high = data.draw(st.none() | st.tuples(*[st.integers(1, len(cube))] * 3))
    left = cube.copy()
    if high is not None:
        for axis, end in enumerate(high):
            left[(slice(None),) * axis + (slice(end, None),)] = 0
    if not left.any():
        return
    write_vox(file / "scene.vox", rom_of(cube), high)
    again = export.read_vox(file / "scene.vox")[0]
    low, end = (np.array(corner) for corner in octree.solid_bounds(octree.from_dense(left)))
    expected = left[tuple(slice(a, b) for a, b in zip(low, end, strict=True))]
    dense = octree.to_dense(again.octree, (0, 0, 0), tuple((end - low).tolist()))
    colours = [np.array([m.colour for m in materials]) for materials in (MATERIALS, again.materials)]
    colours[1][0] = EMPTY.colour
    np.testing.assert_array_equal(colours[1][dense], colours[0][expected])


def test_magicavoxel_scenes_of_several_models(file):
    points = np.array([[0, 0, 0], [300, 10, 700], [255, 255, 255], [256, 256, 256]])
    rom = octree.Rom("far", octree.from_points(points, np.arange(1, 5), 10), MATERIALS)
    write_vox(file / "far.vox", rom)
    again = export.read_vox(file / "far.vox")[0]
    for point, material in zip(points, (1, 2, 3, 4), strict=True):
        assert again.materials[octree.material_at(again.octree, point)].colour == MATERIALS[material].colour
    assert octree.census(again.octree).solid_voxels == 4


def test_worlds_too_large_for_magicavoxel(file):
    rom = octree.Rom("wide", octree.from_points(np.array([[0, 0, 0], [2048, 0, 0]]), np.ones(2, int), 12), MATERIALS)
    with pytest.raises(DoesNotFitError, match="wide: 2049 voxels from end to end"):
        write_vox(file / "wide.vox", rom)


@given(cube=dense_cubes(max_depth=4))
@settings(max_examples=20)
@pytest.mark.usefixtures("_pyvista")
def test_gltf_files_hold_the_sides_that_can_be_seen(file, cube):
    grid = Grid(len(cube).bit_length() - 1, (-3.0, 1.0, 0.5), 0.25)
    rom = rom_of(np.minimum(cube, 250), grid)
    if not cube.any():
        return
    cells = view.octants(rom)
    write_glb(file / "o.glb", rom, mesh_of(rom))
    scene = trimesh.load_scene(file / "o.glb")
    sides = view.open_sides(cells)[0]
    assert sum(len(mesh.faces) for mesh in scene.geometry.values()) == 2 * len(sides)
    np.testing.assert_allclose(
        scene.bounds, np.reshape(cells.bounds, (3, 2)).T * grid.voxel_size + grid.origin, atol=1e-5
    )
    ours = voxelize.load(file / "o.glb")
    named = {material.name: material.colour for material in ours.materials[1:]}
    assert named == {m.name: m.colour for m in (rom.materials[n] for n in np.unique(cells["material"]))}
    # Sides face outwards: a shell behind the faces is that of the solid voxels that can be seen.
    around = np.pad(cube, 1)
    shell = voxelize.voxelize(ours, grid, fill="surface").voxels
    found = octree.to_dense(octree.build(shell))
    assert (found[np.asarray(cube) == 0] == 0).all()
    exposed = np.zeros(cube.shape, bool)
    for axis in range(3):
        for step in (-1, 1):
            exposed |= np.roll(around, step, axis)[1:-1, 1:-1, 1:-1] == 0
    assert (found[exposed & (cube != 0)] != 0).all()


@given(cube=dense_cubes(max_depth=4))
@settings(max_examples=10)
@pytest.mark.usefixtures("_pyvista")
def test_pages_need_nothing_else_and_hold_the_octants(file, cube):
    rom = rom_of(cube)
    cells = view.octants(rom)
    write_page(file / "o.html", rom, mesh_of(rom))
    page = (file / "o.html").read_text()
    assert not re.search(r"https?:|src=|href=|@import|{{", page)
    scene = json.loads(re.search(r"const scene = (\{.*\});", page).group(1))
    data = zlib.decompress(base64.b64decode(scene["octants"]))
    count = scene["count"]
    assert count == cells.n_cells
    assert len(data) == 18 * count
    address = np.frombuffer(data, "<u4", count)
    low, last = (np.frombuffer(data, "<u2", 3 * count, start * count).reshape(-1, 3) for start in (4, 10))
    for where, first, end in zip(address, low, last, strict=True):
        found = octree.octant_at(rom.octree, tuple(first.tolist()))
        assert (found.address, found.end) == (where, tuple((end.astype(int) + 1).tolist()))


@given(cube=dense_cubes(max_depth=4))
@settings(max_examples=20)
def test_ply_files_hold_the_sides_and_their_colours(file, cube):
    """Read by trimesh: each visible side of a voxel lies in a face of its material's colour, and no other does."""
    rom = rom_of(cube, Grid(len(cube).bit_length() - 1, (-3.0, 1.0, 0.5), 0.25))
    write_ply(file / "o.ply", rom, mesh_of(rom))
    assert (file / "o.ply").read_bytes().startswith(b"ply\nformat binary_little_endian 1.0\n")
    if not cube.any():
        return
    mesh = trimesh.load(file / "o.ply", process=False)
    points = (mesh.vertices - (-3.0, 1.0, 0.5)) / 0.25
    corners = points[mesh.faces]
    colours = np.array([material.colour for material in MATERIALS])
    visible = np.zeros(3)
    around = np.pad(cube, 1)
    for axis in range(3):
        steps = np.diff((around != 0).astype(int), axis=axis)
        visible[axis] = np.count_nonzero(steps)
    # Sides of octants of different size may lie on each other in part: at least what is visible is there.
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (np.abs(across).sum(axis=0) / 2 >= visible - 1e-9).all()
    behind = np.floor(corners.mean(axis=1) - 0.01 * np.sign(across)).astype(int)
    np.testing.assert_array_equal(mesh.visual.face_colors[:, :3], colours[cube[tuple(behind.T)]])


@given(cube=dense_cubes(max_depth=4), data=st.data())
@settings(max_examples=20)
def test_numpy_archives_hold_the_voxels(file, cube, data):
    high = data.draw(st.none() | st.tuples(*[st.integers(1, len(cube))] * 3))
    rom = rom_of(cube, Grid(len(cube).bit_length() - 1, (-3.0, 1.0, 0.5), 0.25))
    export.write_npz(file / "o.npz", rom, high)
    kept = cube.copy()
    for axis, end in enumerate(high or ()):
        kept[(slice(None),) * axis + (slice(end, None),)] = 0
    with np.load(file / "o.npz") as read:
        again = np.zeros_like(cube)
        again[tuple(read["coordinates"].T)] = read["material_ids"]
        np.testing.assert_array_equal(again, kept)
        assert [tuple(colour) for colour in read["colours"].tolist()] == [m.colour for m in MATERIALS]
        assert read["names"][1] == "m1"
        assert (read["depth"], read["voxel_size"]) == (rom.octree.depth, 0.25)
        assert read["origin"].tolist() == [-3.0, 1.0, 0.5]
    with zipfile.ZipFile(file / "o.npz") as archive:  # no time of day: equal memories give equal bytes
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


def test_names_in_pages_are_text(file):
    rom = octree.Rom("</script><b>", octree.from_dense(np.ones((2, 2, 2), np.uint8)), MATERIALS)
    write_page(file / "o.html", rom, mesh_of(rom))
    assert "</script><b>" not in (file / "o.html").read_text()


def test_animations(file):
    pictures = [np.full((20, 30, 3), shade, np.uint8) for shade in (0, 100, 200)]
    pictures[0][:10] = 200  # the palette is of the first
    pictures[0][10:15] = 100
    write_animation(file / "a.gif", pictures)
    with Image.open(file / "a.gif") as animation:
        assert animation.n_frames == 3
        for number, picture in enumerate(pictures):
            animation.seek(number)
            assert np.abs(np.asarray(animation.convert("RGB")).astype(int) - picture).max() < 8
