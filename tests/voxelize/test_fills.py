"""Fills of objects' own: against brute force, with every rule, in blocks, and as each reader takes them."""

import numpy as np
import pytest
from msgspec.structs import replace
from oracles.meshes import box_mesh, icosphere, one_object, scene_of, without
from oracles.rules import centres_inside
from oracles.voxels import compete, dense, shell, snap, voxelize_mesh

import voxrt
from voxrt import octree
from voxrt.voxelize import (
    BoxCollider,
    Grid,
    PointCloud,
    SceneObject,
    authoring,
    join_open_objects,
    load,
    place_points,
    voxelize,
    voxelize_in_blocks,
)
from voxrt.voxelize.rules import OBJECT_FILLS


def some_objects(rng, side):
    """Objects of all fills that overlap, instances of one mesh among them."""
    mesh = None
    for number in range(rng.integers(2, 5)):
        if mesh is None or rng.random() < 0.6:
            reach = rng.uniform(0.5, side / 3, (2, 3))
            ball = icosphere(1, (0, 0, 0), rng.uniform(1, side / 2), number + 1)
            mesh = ball if rng.random() < 0.5 else box_mesh(-reach[0], reach[1], number + 1)
        place = np.eye(4)
        place[:3, 3] = rng.uniform(0, side, 3)
        yield SceneObject("o", mesh, place, fill=(*OBJECT_FILLS, None)[rng.integers(4)])


def corners_of(item, grid):
    return snap(item.mesh.positions, item.transform, grid.origin, grid.voxel_size), item.mesh.triangles


@pytest.mark.parametrize("seed", range(8))
def test_each_object_is_filled_as_it_says(seed):
    rng = np.random.default_rng(seed)
    grid = Grid(4, (0.0, 0.0, 0.0), 1.0)
    scene = scene_of(*some_objects(rng, grid.size))
    for fill in OBJECT_FILLS:
        made = voxelize(scene, grid, fill=fill, threads=1)
        layers = [
            voxelize_mesh(
                *corners_of(one, grid),
                one.mesh.materials,
                grid.size,
                solid=(one.fill or fill) != "surface",
                closed=True,
            )
            for one in scene.objects
        ]
        np.testing.assert_array_equal(dense(made.voxels), compete(layers))
        shells = [report.mode == "surface" for report in made.objects]
        assert shells == [(one.fill or fill) == "surface" for one in scene.objects]
        whole = octree.Assembly(grid.depth)
        voxelize_in_blocks(
            scene, grid, lambda part, whole=whole: whole.add(octree.build(part)), block_side=64, fill=fill
        )
        assert bytes(whole.octree().words) == bytes(octree.build(made.voxels).words)


@pytest.mark.parametrize("rule", ["centre", "half"])
@pytest.mark.parametrize("seed", range(4))
def test_a_shell_among_solids_fills_each_voxel_that_it_touches(rule, seed):
    """Whatever the rule, which goes for what encloses something, beside it or through it."""
    rng = np.random.default_rng(seed)
    grid = Grid(4, (0.0, 0.0, 0.0), 1.0)
    place = np.eye(4)
    place[:3, 3] = rng.uniform(4, 12, 3)
    ball = SceneObject("ball", icosphere(1, (0, 0, 0), rng.uniform(2, 5)), place, fill="surface")
    low = rng.integers(2, 14, 3) / 2
    high = low + rng.integers(4, 14, 3) / 2
    scene = scene_of(ball, box_mesh(low, high, 2))
    made = dense(voxelize(scene, grid, rule=rule, thin="drop").voxels)
    touched = shell(*corners_of(ball, grid), grid.size) >= 0
    if rule == "centre":
        solid = centres_inside(*corners_of(scene.objects[1], grid), grid.size)
    else:
        at = np.stack(np.meshgrid(*[np.arange(16)] * 3, indexing="ij"), axis=-1)
        solid = np.clip(np.minimum(at + 1, high) - np.maximum(at, low), 0, 1).prod(-1) >= 0.5
    np.testing.assert_array_equal(made != 0, touched | solid)


def test_instances_of_an_open_mesh_differ_by_their_fill():
    """A box with a hole in one side: `auto` leaves it open, and `solid` fills it."""
    box = box_mesh((0, 0, 0), (8, 8, 12))
    open_box = without(box, [0])  # half of a side
    places = [np.eye(4) for _ in OBJECT_FILLS]
    for number, place in enumerate(places):
        place[0, 3] = 10 * number + 1
    objects = [SceneObject("o", open_box, at, fill=fill) for at, fill in zip(places, OBJECT_FILLS, strict=True)]
    grid = Grid(5, (0.0, -1.0, -1.0), 1.0)
    touched = 8 * 8 * 12 - 6 * 6 * 10
    for fill in OBJECT_FILLS:
        found = voxelize(scene_of(*objects), grid, fill=fill)
        solid, surface, auto = (report.voxels for report in found.objects)
        assert solid > touched == 408
        assert surface == auto < touched
        assert [str(report.mode) for report in found.objects] == ["winding", "surface", "open"]


def test_colliders_have_the_fill_of_their_object():
    collider = BoxCollider((1.5, 1.5, 1.5), (6.5, 6.5, 6.5), pow2=False)
    item = SceneObject("box", box_mesh((2, 2, 2), (6, 6, 6)), colliders=(collider,), collider_material=2)
    grid = Grid(3, (0.0, 0.0, 0.0), 1.0)
    for fill, voxels in (("solid", 6**3), ("surface", 6**3 - 4**3)):
        assert voxelize(scene_of(replace(item, fill=fill)), grid).objects[0].voxels == voxels


def test_clouds_have_fills_of_their_own():
    solid = np.zeros((8, 8, 8), bool)
    solid[1:7, 1:7, 1:7] = True
    solid[2:6, 2:6, 2:6] = False
    grid = Grid(3, (0, 0, 0), 1.0)
    for own, build, voxels in (("surface", "auto", 6**3 - 4**3), ("auto", "surface", 6**3), (None, "solid", 6**3)):
        scene = scene_of(SceneObject("cloud", points=PointCloud(np.argwhere(solid) + 0.5), fill=own))
        scene = replace(scene, materials=scene.materials[:2])
        placed = place_points(scene, grid, colours=1, fill=build)
        assert voxelize(placed, grid, fill=build).objects[0].voxels == voxels


def test_objects_with_a_fill_of_their_own_are_not_joined():
    halves = [without(box_mesh((0, 0, 0), (2, 2, 2)), drop) for drop in (range(6), range(6, 12))]
    plain = scene_of(*halves)
    assert len(join_open_objects(plain).objects) == 1
    kept = replace(plain, objects=(replace(plain.objects[0], fill="surface"), plain.objects[1]))
    assert join_open_objects(kept) is kept


def test_volumes_do_not_depend_on_fills():
    grid = Grid(4, (0.0, 0.0, 0.0), 1.0)
    plain = one_object(box_mesh((1.5, 2, 3), (9, 8, 7)))
    shell_alone = replace(plain, objects=(replace(plain.objects[0], fill="surface"),))
    assert voxrt.volume_fractions(shell_alone, depth=4).volumes == voxrt.volume_fractions(plain, depth=4).volumes
    assert voxelize(shell_alone, grid).objects[0].voxels < voxelize(plain, grid).objects[0].voxels


SCENE = """
[[objects]]
name = "own"
box.size = [4, 4, 4]
fill = "surface"
[[objects]]
name = "other"
box.size = [4, 4, 4]
translate = [8, 0, 0]
"""


def usd_prim(name, mesh, at):
    own = 'token voxrt:fill = "surface"' if name == "own" else ""
    points = ", ".join(str(tuple(point)) for point in (mesh.positions + at).tolist())
    return (
        f'def Xform "x{name}" {{ {own}\n def Mesh "{name}" {{ point3f[] points = [{points}]\n'
        f"int[] faceVertexCounts = {[3] * 12}\nint[] faceVertexIndices = {mesh.triangles.ravel().tolist()}\n}}\n}}"
    )


def test_scene_files_and_usd_say_it(tmp_path):
    """USD through the process that reads it."""
    (tmp_path / "scene.toml").write_text(SCENE)
    mesh = box_mesh((-2, -2, -2), (2, 2, 2))
    prims = "\n".join(usd_prim(name, mesh, at) for name, at in (("own", (0, 0, 0)), ("other", (8, 0, 0))))
    (tmp_path / "scene.usda").write_text(f'#usda 1.0\n(\n metersPerUnit = 1\n upAxis = "Y"\n)\n{prims}\n')
    grid = Grid(4, (-2.0, -2.0, -2.0), 1.0)
    for file in ("scene.toml", "scene.usda"):
        scene = load(tmp_path / file)
        assert [one.fill for one in scene.objects] == ["surface", None]
        for fill, voxels in (("solid", [4**3 - 2**3, 4**3]), ("surface", [4**3 - 2**3] * 2)):
            assert [one.voxels for one in voxelize(scene, grid, fill=fill).objects] == voxels


def test_an_asset_has_the_fill_of_its_place_but_for_objects_with_their_own(tmp_path):
    (tmp_path / "inner.toml").write_text(SCENE)
    author = authoring.Author("yard")
    author.add_asset("a", load(tmp_path / "inner.toml"), np.eye(4), fill="solid")
    assert [one.fill for one in author.build().objects] == ["surface", "solid"]
    (tmp_path / "scene.toml").write_text('[[objects]]\nasset.file = "box.obj"\nfill = "surface"\n')
    (tmp_path / "box.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
    assert [one.fill for one in load(tmp_path / "scene.toml").objects] == ["surface"]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        (
            '#usda 1.0\ndef Cube "box" {\ntoken voxrt:fill = "together"\n}',
            "'together' is no fill; name one of solid, surface",
        ),
        ('[[objects]]\nbox.size = [1, 1, 1]\nfill = "together"\n', "invalid enum value 'together'"),
        ('[[objects]]\nfill = "solid"\ngroup = [{box.size = [1, 1, 1]}]\n', "a group cannot have a fill"),
        ('[[objects]]\nunion = [{box.size = [1, 1, 1], fill = "solid"}]\n', "a part of a union cannot have a fill"),
    ],
)
def test_what_cannot_be_filled_so_is_refused(tmp_path, text, problem):
    file = tmp_path / ("scene.usda" if text.startswith("#usda") else "scene.toml")
    file.write_text(text)
    with pytest.raises(voxrt.AssetError, match=problem) as refused:
        load(file)
    assert "\n" not in str(refused.value)


def test_python_takes_it(tmp_path):
    yard = authoring.Author("yard")
    yard.add("hollow", authoring.box((4, 4, 4), centre=(2, 2, 2)), fill="surface")
    scene = yard.build()
    assert scene.objects[0].fill == "surface"
    assert voxrt.build(scene, tmp_path / "out", voxel_size=1).objects[0].voxels == 4**3 - 2**3
    with pytest.raises(ValueError, match=r"^SceneObject\.fill must be 'solid', 'surface' or 'auto', not 'together'$"):
        SceneObject("o", fill="together")
