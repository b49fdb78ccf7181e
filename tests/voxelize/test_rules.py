"""Rules against brute force; thin parts; the same bytes in blocks, with any threads and by the command."""

import json
from pathlib import Path

import numpy as np
import pytest
from oracles.meshes import box_mesh, icosphere, joined, one_object, scene_of
from oracles.rules import AROUND, SIDES, centres_inside, dilated, pieces, ruled, shifted
from oracles.voxels import dense, snap

import voxrt
from voxrt import octree
from voxrt.voxelize import BoxCollider, Grid, Mesh, SceneObject, SphereCollider, load, voxelize, voxelize_in_blocks

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def turned(mesh, rng):
    """A mesh turned about its middle, and stretched along one of its axes: thin, or long."""
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    if np.linalg.det(turn) < 0:
        turn[:, 0] *= -1
    middle = mesh.positions.mean(0)
    stretch = [1, 1, rng.choice([1, 0.1, 4])]
    return Mesh((mesh.positions - middle) * stretch @ turn.T + middle, mesh.triangles, mesh.materials)


def some_mesh(rng, side, material):
    kind = rng.integers(3)
    if kind == 0:
        mesh = icosphere(int(rng.integers(2)), tuple(rng.uniform(0, side, 3)), rng.uniform(0.3, side / 2), material)
    else:  # corners at half voxels: centres lie on its faces
        low = rng.integers(0, 2 * side - 1, 3) / 2
        mesh = box_mesh(low, low + rng.choice([0.25, 0.5, 1, 2, 3, side / 3], 3), material)
        mesh = turned(mesh, rng) if kind == 2 else mesh
    other = rng.random(len(mesh.triangles)) < 0.3
    return Mesh(mesh.positions, mesh.triangles, np.where(other, 10 * material, material).astype(np.uint8))


def assert_ruled(scene, grid):
    """Compare with brute force, with thin parts and without."""
    meshes = [
        (snap(one.mesh.positions, one.transform, grid.origin, 1.0), one.mesh.triangles, one.mesh.materials)
        for one in scene.objects
    ]
    for thin in ("keep", "drop"):
        made = voxelize(scene, grid, rule="centre", thin=thin, threads=1)
        voxels = dense(made.voxels)
        wanted, open_to_doubt = ruled(meshes, grid.size, thin=thin)
        np.testing.assert_array_equal(np.where(open_to_doubt, wanted, voxels), wanted)
        np.testing.assert_array_equal(voxels != 0, wanted != 0)
        assert sum(one.voxels for one in made.objects) == np.count_nonzero(voxels)


@pytest.mark.parametrize("seed", range(14))
def test_the_rule_is_that_of_brute_force(seed):
    rng = np.random.default_rng(seed)
    grid = Grid(int(rng.integers(2, 6)), (0.0, 0.0, 0.0), 1.0)
    assert_ruled(scene_of(*(some_mesh(rng, grid.size, number + 1) for number in range(rng.integers(1, 4)))), grid)


def test_hundreds_of_triangles_in_a_column():
    """A ball shows, not the larger surface of the plates in it."""
    plates = joined(*(box_mesh((0.6, 0.6, z), (1.4, 1.4, z + 0.01), 2) for z in np.linspace(0.7, 1.3, 9)))
    scene = scene_of(turned(plates, np.random.default_rng(0)), icosphere(3, (1, 1, 1), 0.9, 1))
    np.testing.assert_array_equal(dense(voxelize(scene, Grid(1, (0.0, 0.0, 0.0), 1.0), rule="centre").voxels), 1)


def test_an_object_that_another_one_hides_does_not_show():
    """It comes first, and is in all voxels of the other one's surface."""
    hidden, shown = box_mesh((1.9, 1.9, 1.9), (2.1, 2.1, 2.1), 1), box_mesh((1.2, 1.2, 1.2), (2.8, 2.8, 2.8), 2)
    assert_ruled(scene_of(hidden, shown), Grid(2, (0.0, 0.0, 0.0), 1.0))


@pytest.mark.parametrize("stretched", [False, True])
def test_solids_without_triangles(stretched):
    """Box, ball and ellipsoid: centres in the closed solid, by arithmetic on halves and quarters."""
    grid = Grid(5, (0.0, 0.0, 0.0), 1.0)
    at = np.stack(np.meshgrid(*[np.arange(32) + 0.5] * 3, indexing="ij"), axis=-1)
    middle = np.array((16.0, 15.5, 14.25))
    box = SceneObject(
        "box",
        box_mesh((0, 0, 0), (1, 1, 1)),
        np.eye(4),
        (BoxCollider((2.5, 3.5, 4.25), (9.5, 30.25, 4.75), pow2=False),),
        2,
    )
    voxels = dense(voxelize(scene_of(box), grid, rule="centre").voxels) != 0
    np.testing.assert_array_equal(voxels, ((at >= (2.5, 3.5, 4.25)) & (at <= (9.5, 30.25, 4.75))).all(-1))
    shape = np.diag([1.0, 0.5, 1.25, 1.0] if stretched else [1.0, 1.0, 1.0, 1.0])
    shape[:3, 3] = middle
    ball = SceneObject("ball", box_mesh((0, 0, 0), (1, 1, 1)), shape, (SphereCollider((0.0, 0.0, 0.0), 9.5),), 3)
    voxels = dense(voxelize(scene_of(ball), grid, rule="centre").voxels) != 0
    np.testing.assert_array_equal(voxels, (((at - middle) / np.diag(shape)[:3]) ** 2).sum(-1) <= 9.5**2)
    half = dense(voxelize(scene_of(ball), grid, rule="half").voxels) != 0
    np.testing.assert_array_equal(half, voxels)  # round solids go by their centres


def wires(count, side, thickness, seed):
    rng = np.random.default_rng(seed)
    made = []
    for _ in range(count):
        start, end = rng.uniform(0, side, (2, 3))
        along = end - start
        across = np.cross(along, (0.3, 0.5, 0.7))
        across *= thickness / np.linalg.norm(across)
        third = np.cross(along, across)
        third *= thickness / np.linalg.norm(third)
        mesh = box_mesh((-0.5, -0.5, 0), (0.5, 0.5, 1))
        made.append(Mesh(start + mesh.positions @ np.array([across, third, along]), mesh.triangles, mesh.materials))
    return joined(*made)


@pytest.mark.parametrize("thickness", [0.05, 0.4, 0.8, 1.3])
def test_thin_parts_stay_and_stay_connected(thickness):
    scene, grid = one_object(wires(6, 64, thickness, 3)), Grid(6, (0.0, 0.0, 0.0), 1.0)
    touched = dense(voxelize(scene, grid).voxels) != 0
    kept = dense(voxelize(scene, grid, rule="centre").voxels) != 0
    bare = dense(voxelize(scene, grid, rule="centre", thin="drop").voxels) != 0
    around = [d for d in np.ndindex(3, 3, 3) if d != (1, 1, 1)]
    steps = [tuple(v - 1 for v in d) for d in around]
    assert not (bare & ~kept).any()
    assert not (kept & ~touched).any()
    assert not (touched & ~dilated(kept)).any()
    assert len(pieces(map(tuple, np.argwhere(kept)), steps)) == len(pieces(map(tuple, np.argwhere(touched)), steps))
    assert kept.sum() < 0.6 * touched.sum()


def test_a_plate_has_no_hole():
    """What a thin plate parts under touch, it parts when it is thinned."""
    plate = turned(box_mesh((1, 1, 15.9), (31, 31, 16.1)), np.random.default_rng(5))
    big = Mesh((plate.positions - 16) * (4, 4, 4) + 16, plate.triangles, plate.materials)  # it leaves the grid
    scene, grid = one_object(big), Grid(5, (0.0, 0.0, 0.0), 1.0)
    sides = [(-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1)]
    parts = [
        len(pieces(map(tuple, np.argwhere(dense(voxelize(scene, grid, rule=rule).voxels) == 0)), sides))
        for rule in ("touch", "centre")
    ]
    assert parts == [2, 2]


def test_an_open_surface_keeps_what_it_touches():
    mesh = box_mesh((2, 3, 4), (29, 20, 21))
    sheet = Mesh(mesh.positions, mesh.triangles[:2], mesh.materials[:2])
    grid = Grid(5, (0.0, 0.0, 0.0), 1.0)
    for fill in ("auto", "surface"):
        made = [dense(voxelize(one_object(sheet), grid, fill=fill, rule=rule).voxels) for rule in ("touch", "centre")]
        np.testing.assert_array_equal(*made)


def reached_from_outside(empty, steps):
    left = np.pad(empty, 1, constant_values=True)
    reached, count = np.zeros_like(left), 0
    reached[0, 0, 0] = True
    while (now := int(reached.sum())) != count:
        count = now
        reached |= left & np.logical_or.reduce([shifted(reached, step) for step in steps])
    return reached[1:-1, 1:-1, 1:-1]


@pytest.mark.parametrize("rule", ["touch", "centre", "half"])
@pytest.mark.parametrize("shape", ["ball", "turned box", "box on planes", "faces through corners"])
def test_surfaces_without_inside_leave_no_gap(shape, rule):
    """A flood stays outside: by sides always, by edges and corners where the surface passes none of these."""
    tips = 16 + 9 * np.array([(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)])
    faces = [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4), (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)]
    mesh = {
        "ball": icosphere(2, (15.3, 16.1, 14.7), 9.5),
        "turned box": turned(box_mesh((8, 9, 10), (21.3, 22.4, 20.1)), np.random.default_rng(2)),
        "box on planes": box_mesh((8, 9, 10), (20, 21, 19)),
        "faces through corners": Mesh(tips.astype(float), np.array(faces, np.int32), np.ones(8, np.uint8)),
    }[shape]
    grid = Grid(5, (0.0, 0.0, 0.0), 1.0)
    shell = dense(voxelize(one_object(mesh), grid, fill="surface", rule=rule).voxels) != 0
    solid = dense(voxelize(one_object(mesh), grid, fill="solid").voxels) != 0
    outside = reached_from_outside(~shell, SIDES)
    np.testing.assert_array_equal(~outside, solid)
    if shape in ("ball", "turned box"):
        np.testing.assert_array_equal(reached_from_outside(~shell, AROUND), outside)


def test_a_surface_with_small_holes_is_that_without_but_near_them():
    ball = icosphere(3, (16.0, 16.0, 16.0), 11.3)
    holed = Mesh(ball.positions, ball.triangles[1:], ball.materials[1:])
    grid = Grid(5, (0.0, 0.0, 0.0), 1.0)
    voxels = dense(voxelize(one_object(holed), grid, rule="centre", thin="drop").voxels) != 0
    wanted = centres_inside(snap(ball.positions, np.eye(4), grid.origin, 1.0), ball.triangles, 32)
    at = ball.positions[ball.triangles[0]].mean(0)
    far = np.linalg.norm(np.stack(np.meshgrid(*[np.arange(32) + 0.5] * 3, indexing="ij"), -1) - at, axis=-1) > 4
    np.testing.assert_array_equal(voxels[far], wanted[far])
    half = dense(voxelize(one_object(holed), grid, rule="half", thin="drop").voxels) != 0
    np.testing.assert_array_equal(half, voxels)  # it goes by centres, too


@pytest.mark.parametrize("thin", ["keep", "drop"])
def test_blocks_and_threads_give_the_bytes_and_the_reports_of_the_whole(thin):
    scene = scene_of(wires(8, 256, 0.7, 1), box_mesh((3, 3, 3), (250.3, 90.2, 17.8)), icosphere(2, (99, 150, 90), 60))
    grid = Grid(8, (0.0, 0.0, 0.0), 1.0)
    at_once = voxelize(scene, grid, rule="centre", thin=thin, threads=1)
    words = bytes(octree.build(at_once.voxels).words)
    for threads in (2, 3):
        assert (
            bytes(octree.build(voxelize(scene, grid, rule="centre", thin=thin, threads=threads).voxels).words) == words
        )
    for side in (64, 128):
        tree = octree.Assembly(8)
        report = voxelize_in_blocks(
            scene,
            grid,
            lambda voxels, tree=tree: tree.add(octree.build(voxels)),
            block_side=side,
            rule="centre",
            thin=thin,
        )
        assert bytes(tree.octree().words) == words
        assert report.objects == at_once.objects
        assert report.warnings == at_once.warnings


def test_a_thin_part_on_another_gives_it_its_material():
    """A sticker of a tenth of a voxel before a wall shows on the wall."""
    wall, sticker = box_mesh((2, 2, 2), (30, 30, 9.6), 1), box_mesh((10, 10, 9.6), (20, 20, 9.7), 2)
    for order in ((wall, sticker), (sticker, wall)):
        scene = scene_of(*order)
        voxels = dense(voxelize(scene, Grid(5, (0.0, 0.0, 0.0), 1.0), rule="centre").voxels)
        assert (voxels[10:20, 10:20, 9] == 2).all()
    apart = box_mesh((10, 10, 10.0), (20, 20, 10.1), 2)
    voxels = dense(voxelize(scene_of(wall, apart), Grid(5, (0.0, 0.0, 0.0), 1.0), rule="centre").voxels)
    assert (voxels[10:20, 10:20, 9] == 2).all()
    assert not voxels[:, :, 10].any()


def test_an_object_without_voxels_is_named():
    grid = Grid(4, (0.0, 0.0, 0.0), 1.0)
    scene = one_object(box_mesh((3.1, 3.1, 3.1), (3.2, 3.2, 3.2)))
    kept, dropped = (voxelize(scene, grid, rule="centre", thin=thin) for thin in ("keep", "drop"))
    assert [one.voxels for one in kept.objects] == [1]
    assert [one.voxels for one in dropped.objects] == [0]
    assert [warning.kind for warning in dropped.warnings] == ["no-voxels"]


def test_builds_by_a_rule(tmp_path):
    """Through options, tiles and the manifest."""
    whole = voxrt.build(EXAMPLES / "courtyard.glb", tmp_path / "whole", depth=10, rule="centre")
    tiled = voxrt.build(EXAMPLES / "courtyard.glb", tmp_path / "tiled", depth=10, rule="centre", memory=1 << 26)
    touched = voxrt.build(load(EXAMPLES / "courtyard.glb"), depth=10)
    assert whole.outputs["mem"].read_bytes() == tiled.outputs["mem"].read_bytes()
    assert 0.98 * touched.solid_voxels < whole.solid_voxels < touched.solid_voxels
    assert json.loads(whole.outputs["manifest"].read_text())["source"]["settings"]["rule"] == "centre"


@pytest.mark.parametrize(("name", "value"), [("rule", "center"), ("thin", "no")])
def test_other_values_are_refused(name, value):
    scene = one_object(box_mesh((1, 1, 1), (2, 2, 2)))
    with pytest.raises(ValueError, match=f"^{name} must be "):
        voxelize(scene, Grid(3, (0.0, 0.0, 0.0), 1.0), **{name: value})


def test_objects_keep_rules_of_their_own(tmp_path):
    """In scene files, glTF and USD, through the process that reads USD."""
    boxes = {"own": [0.25, 0.25, 0.25], "other": [4.25, 0.25, 0.25]}
    entries = [f'[[objects]]\nname = "{name}"\nbox.size = [2, 2, 2]\ntranslate = {at}\n' for name, at in boxes.items()]
    (tmp_path / "scene.toml").write_text(f'{entries[0]}rule = "centre"\n{entries[1]}')
    half = box_mesh((-1, -1, -1), (1, 1, 1))
    prims = "\n".join(
        f'def Xform "x{name}" {{ {"token voxrt:rule = " + chr(34) + "centre" + chr(34) if name == "own" else ""}\n'
        f'def Mesh "{name}" {{ double3 xformOp:translate = ({at[0]}, {at[1]}, {at[2]})\n'
        'uniform token[] xformOpOrder = ["xformOp:translate"]\n'
        f"point3f[] points = [{', '.join(str(tuple(p)) for p in half.positions.tolist())}]\n"
        f"int[] faceVertexCounts = {[3] * 12}\nint[] faceVertexIndices = {half.triangles.ravel().tolist()}\n}}\n}}"
        for name, at in boxes.items()
    )
    (tmp_path / "scene.usda").write_text(f'#usda 1.0\n(\n metersPerUnit = 1\n upAxis = "Y"\n)\n{prims}\n')
    for file in ("scene.toml", "scene.usda"):
        scene = load(tmp_path / file)
        made = voxelize(scene, Grid(4, (-4.0, -4.0, -4.0), 1.0))
        assert [(one.rule, report.voxels) for one, report in zip(scene.objects, made.objects, strict=True)] == [
            ("centre", 8),
            (None, 27),
        ]
    scene = load(tmp_path / "scene.toml")
    assert [one.voxels for one in voxelize(scene, Grid(4, (-4.0, -4.0, -4.0), 1.0), rule="centre").objects] == [8, 8]


@pytest.mark.parametrize(
    ("low", "high"),
    [
        ((2.5, 3.5, 4.5), (40.5, 50.5, 60.5)),
        ((2.25, 3, 4), (40.75, 50, 60)),
        ((-3000.5, -70000, 4.5), (40.5, 65000, 60.5)),
        ((8, 16, 24), (32, 40, 48)),  # all faces between bricks of the native voxelizer
        ((8.5, 16.5, 8), (32.25, 40, 16)),
    ],
)
def test_halves_of_a_box_count(low, high):
    """Faces in the middle of voxels; edges there have a quarter, corners an eighth. Triangles of any size."""
    grid = Grid(6, (0.0, 0.0, 0.0), 1.0)
    mesh = box_mesh(low, high)
    at = np.stack(np.meshgrid(*[np.arange(64)] * 3, indexing="ij"), axis=-1)
    fraction = np.clip(np.minimum(at + 1, high) - np.maximum(at, low), 0, 1).prod(-1)
    wanted = fraction >= 0.5
    for scene in (
        one_object(mesh),
        scene_of(SceneObject("box", mesh, np.eye(4), (BoxCollider(low, high, pow2=False),), 2)),
    ):
        made = dense(voxelize(scene, grid, rule="half", thin="drop").voxels) != 0
        np.testing.assert_array_equal(made, wanted)


def test_two_solids_that_share_a_side_leave_no_crack():
    grid = Grid(5, (0.0, 0.0, 0.0), 1.0)
    scene = scene_of(box_mesh((2, 2, 2), (9.3, 30, 30), 1), box_mesh((9.3, 2, 2), (30, 30, 30), 2))
    voxels = dense(voxelize(scene, grid, rule="half").voxels)
    assert np.count_nonzero(voxels) == 28**3
    assert (voxels[2:30, 2:30, 2:30] != 0).all()
