"""Meshes from arrays and from trimesh: the same voxels and colours as from files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

import voxrt
from voxrt import octree

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
RED, BLUE = (255, 0, 0), (0, 0, 255)


def box():
    mesh = trimesh.creation.box((2, 2, 2))
    return mesh.vertices, mesh.faces


def colours_of(built):
    return {material.colour for material in built.rom.materials[1:]}


@pytest.fixture
def ball():
    return trimesh.creation.icosphere(subdivisions=3)


def test_arrays_give_the_voxels_of_the_file(ball, tmp_path):
    ball.export(tmp_path / "ball.ply")
    ball = trimesh.load(tmp_path / "ball.ply", process=False)
    from_file = voxrt.build(tmp_path / "ball.ply", depth=5)
    for built in (
        voxrt.voxelize_mesh(ball.vertices, ball.faces, depth=5),
        voxrt.voxelize_mesh(ball.vertices.tolist(), ball.faces.tolist(), depth=5),
        voxrt.build((ball.vertices, ball.faces), depth=5),
        voxrt.build(ball, depth=5),
        voxrt.build(trimesh.Scene(ball), depth=5),
        voxrt.build(voxrt.mesh_scene(ball.vertices, ball.faces), depth=5),
    ):
        np.testing.assert_array_equal(built.octree.words, from_file.octree.words)
        assert built.rom.grid == from_file.rom.grid
        assert built.warnings == ()
        assert not built.rom.materials[1].authored


def test_results_hand_out_arrays():
    built = voxrt.voxelize_mesh(*box(), depth=3)
    assert built.coordinates.shape == (512, 3)
    assert built.coordinates.dtype == np.int32
    assert set(built.material_ids.tolist()) == {1}
    assert built.to_dense().all()
    assert built.octree is built.rom.octree
    assert len(repr(built)) < 200
    again = octree.from_points(built.coordinates, built.material_ids, 3)
    np.testing.assert_array_equal(again.words, built.octree.words)


def test_points_are_those_of_the_dense_array():
    rng = np.random.default_rng(5)
    world = np.where(rng.random((64, 64, 64)) < 0.1, rng.integers(1, 256, (64, 64, 64)), 0)
    world[:32, :32, :32] = 9  # a leaf of level 5
    world[32:48, :16, :16] = 8  # of level 4
    points, materials = octree.to_points(octree.from_dense(world))
    x, y, z = points.T
    assert len(np.unique(points, axis=0)) == len(points) == np.count_nonzero(world)
    np.testing.assert_array_equal(world[x, y, z], materials)
    np.testing.assert_array_equal(octree.from_points(points, materials, 6).words, octree.from_dense(world).words)
    solid = octree.Octree(8, np.array([0xFFFFFF07], np.uint32))
    points, materials = octree.to_points(solid)
    keys = points.astype(np.int64) @ (1 << np.array([0, 8, 16]))
    np.testing.assert_array_equal(np.sort(keys), np.arange(1 << 24))
    assert (materials == 7).all()


def test_colours():
    vertices, faces = box()
    one = voxrt.voxelize_mesh(vertices, faces, depth=3, colours=RED)
    assert colours_of(one) == {RED}
    assert one.rom.materials[1].name == "mesh"
    by_face = np.where(vertices[faces].mean(axis=1)[:, :1] > 0.9, RED, BLUE)
    two = voxrt.voxelize_mesh(vertices, faces, depth=3, face_colours=by_face, fill="surface")
    assert {RED, BLUE} <= colours_of(two)
    seen = {tuple(two.rom.materials[id_].colour) for id_ in two.to_dense()[7, 1:7, 1:7].ravel()}
    assert seen == {RED}
    by_vertex = np.column_stack([vertices[:, 0] > 0, np.zeros((8, 2))]).astype(np.uint8) * 255
    shaded = voxrt.voxelize_mesh(vertices, faces, depth=4, colours=by_vertex, fill="surface")
    red = np.array([material.colour[0] for material in shaded.rom.materials])[shaded.to_dense()]
    assert red[15, 1:15, 1:15].min() > red[8, 0, 1:15].mean() > red[0, 1:15, 1:15].max()
    clear = np.column_stack([by_face, np.where(by_face[:, 0] == 255, 0, 255)])
    opened = voxrt.voxelize_mesh(vertices, faces, depth=3, face_colours=clear, fill="surface")
    assert RED not in colours_of(opened)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"vertices": np.zeros((4, 2))}, r"vertices must have shape \(V, 3\), not \(4, 2\)"),
        ({"vertices": [[0, 0, float("nan")]] * 8}, r"vertices\[0, 2\] must be a finite number"),
        ({"faces": [[0, 1, 8]]}, r"faces\[0\] names vertex 8, and there are 8 vertices"),
        ({"faces": [[0, 1, -1]]}, r"faces\[0, 2\] must be an integer"),
        ({"faces": [[0, 1, 0.5]]}, r"faces\[0, 2\] must be an integer"),
        ({"faces": [[0, 1, 2, 3]]}, r"faces must have shape \(F, 3\)"),
        ({"colours": (1.0, 0.5, 0.0)}, "colours must be integers 0 … 255, not floats: multiply by 255"),
        ({"colours": (300, 0, 0)}, r"colours\[0, 0\] must be an integer 0 … 255, not 300"),
        ({"colours": np.zeros((7, 3), int)}, "colours has 7 rows, and there are 8 vertices"),
        ({"face_colours": np.zeros((7, 3), int)}, "face_colours has 7 rows, and there are 12 faces"),
        ({"colours": RED, "face_colours": [RED] * 12}, "exclude each other"),
        ({"up": "w"}, "up must be 'x', 'y' or 'z', not 'w'"),
    ],
)
def test_refusals(arguments, message):
    vertices, faces = box()
    with pytest.raises((ValueError, TypeError), match=message):
        voxrt.voxelize_mesh(**{"vertices": vertices, "faces": faces, **arguments}, depth=2)


def test_no_triangles_are_nothing_to_voxelize():
    with pytest.raises(voxrt.AssetError, match="nothing to voxelize"):
        voxrt.voxelize_mesh(np.zeros((0, 3)), np.zeros((0, 3), int), depth=2)


def test_up_and_unit():
    tall = trimesh.creation.box((1, 1, 4))
    built = voxrt.build(tall, depth=3, up="z", unit=0.5)
    low, high = octree.solid_bounds(built.octree)
    assert np.subtract(high, low).tolist() == [2, 8, 2]
    assert built.rom.grid.voxel_size == 0.25
    scene = voxrt.mesh_scene(tall.vertices, tall.faces)
    assert [warning.kind for warning in voxrt.build(scene, depth=3, up="z", time=1.0).warnings] == [
        "ignored-option", "ignored-option"
    ]  # fmt: skip


def test_scenes_of_trimesh_keep_places_names_and_instances(ball):
    scene = trimesh.Scene()
    scene.add_geometry(ball, node_name="left", geom_name="ball")
    scene.graph.update("right", matrix=trimesh.transformations.translation_matrix([4, 0, 0]), geometry="ball")
    scene.add_geometry(trimesh.PointCloud(np.zeros((3, 3))), node_name="dust")
    built = voxrt.build(scene, depth=5)
    assert [item.name for item in built.objects] == ["left", "right"]
    assert built.scene.objects[0].mesh is built.scene.objects[1].mesh
    assert [warning.kind for warning in built.warnings] == ["no-triangles"]
    dense = built.to_dense()
    solid = np.flatnonzero(dense.any(axis=(1, 2)))
    assert (solid[0], solid[-1]) == (0, 31)
    assert not dense[14:18].any()


def test_textures_of_trimesh_lie_as_in_files(tmp_path):
    """A square whose picture is red above and blue below, in OBJ's convention."""
    pixels = np.zeros((8, 8, 3), np.uint8)
    pixels[:4], pixels[4:] = RED, BLUE
    Image.fromarray(pixels).save(tmp_path / "flag.png")
    (tmp_path / "flag.mtl").write_text("newmtl flag\nmap_Kd flag.png\n")
    (tmp_path / "flag.obj").write_text(
        "mtllib flag.mtl\nusemtl flag\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
    )
    loaded = trimesh.load(tmp_path / "flag.obj", process=False)
    ours, theirs = voxrt.build(tmp_path / "flag.obj", depth=4), voxrt.build(loaded, depth=4)
    shades = [
        np.array([material.colour for material in built.rom.materials])[built.to_dense()[:, :, 0]]
        for built in (ours, theirs)
    ]
    np.testing.assert_array_equal(*shades)
    assert shades[1][8, 3].tolist() == list(BLUE)
    assert shades[1][8, 12].tolist() == list(RED)


def test_materials_of_trimesh(ball):
    plain = trimesh.visual.material.PBRMaterial(name="paint", baseColorFactor=(255, 128, 0, 255))
    ball.visual = trimesh.visual.TextureVisuals(material=plain)
    built = voxrt.build(ball, depth=3)
    assert built.rom.materials[1].name == "paint"
    assert built.rom.materials[1].colour == (255, 188, 0)  # 128 / 255 of linear light
    ball.visual = trimesh.visual.TextureVisuals(material=trimesh.visual.material.SimpleMaterial(diffuse=(9, 99, 199)))
    assert colours_of(voxrt.build(ball, depth=3)) == {(9, 99, 199)}
    glass = trimesh.visual.material.PBRMaterial(baseColorFactor=(255, 255, 255, 20), alphaMode="BLEND")
    ball.visual = trimesh.visual.TextureVisuals(material=glass)
    with pytest.raises(voxrt.AssetError, match="nothing to voxelize"):
        voxrt.build(ball, depth=3)


def test_arrays_are_written_with_manifest_and_preview(tmp_path):
    built = voxrt.build(box(), tmp_path, depth=3, preview=True, engine="model", size=(16, 12))
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mesh.json", "mesh.mem", "mesh.preview.png"]
    read, warnings = voxrt.read_rom(tmp_path / "mesh.mem")
    assert warnings == ()
    assert read.grid == built.rom.grid


def test_options_and_keywords_are_one(tmp_path):
    house = EXAMPLES / "house.obj"
    options = voxrt.BuildOptions(depth=4, fill="surface")
    results = [
        voxrt.build(house, tmp_path, options),
        voxrt.build(house, options=options),
        voxrt.build(house, depth=4, fill="surface"),
        voxrt.build(house, options=voxrt.BuildOptions(depth=6, fill="surface"), depth=4),
    ]
    for result in results:
        np.testing.assert_array_equal(result.octree.words, results[0].octree.words)
