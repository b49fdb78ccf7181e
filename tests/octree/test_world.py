"""Worlds that are edited, against dense arrays and dictionaries of voxels that are edited the slow way."""

import threading
import weakref

import numpy as np
import pytest
from oracles import edits
from oracles.octree import reference_words, unshared_words

from voxrt import octree
from voxrt.octree import Box, Capsule, Octree, Rom, Sphere, World
from voxrt.voxelize import EMPTY, DoesNotFitError, Material

UNDO_STEPS = 20
MATERIALS = (EMPTY, *(Material(f"m{i}", (i, 2 * i, 255 - i)) for i in range(1, 8)))


def world_of(tree, **options):
    return World(Rom("world", tree, MATERIALS), **options)


def test_a_world_does_not_keep_the_words_that_it_was_made_of():
    rom = Rom("world", octree.from_dense(np.ones((8, 8, 8), np.uint8)), MATERIALS)
    words = weakref.ref(rom.octree.words)
    world = World(rom)
    del rom
    assert words() is None
    assert np.array_equal(world.rom().octree.words, [0xFFFFFF01])


def random_shape(rng, side):
    def point():
        return rng.integers(-16, 16 * side + 16, 3) / 16

    radius = rng.integers(0, 4 * side) / 16
    match rng.integers(3):
        case 0:
            low = rng.integers(-2, side, 3)
            return Box(low, low + rng.integers(0, side + 2, 3))
        case 1:
            return Sphere(point(), 2 * radius)
        case _:
            start = point()
            return Capsule(start, start if rng.random() < 0.1 else point(), radius)


class Model:
    """A world, and what it should hold: a dense array with its history, and a memory that gets the patches."""

    def __init__(self, cube, rng):
        self.rng, self.cube = rng, cube
        self.world = world_of(octree.from_dense(cube), undo_steps=UNDO_STEPS)
        self.undo, self.redo = [], []
        self.device, self.live = self.world.image, {0: cube}

    def edit(self, cube):
        if not np.array_equal(cube, self.cube):
            self.undo = [*self.undo, self.cube][-UNDO_STEPS:]
            self.redo.clear()
        self.cube = cube

    def step(self):
        self.rng.choice([self.set, self.fill, self.paint, self.paste, self.go_back, self.go_forth, self.commit])()

    def set(self):
        count = self.rng.integers(1, 6)
        points, ids = self.rng.integers(0, len(self.cube), (count, 3)), self.rng.integers(0, 4, count)
        self.world.set(points, ids)
        cube = self.cube.copy()
        for point, material in zip(points, ids, strict=True):
            cube[tuple(point)] = material
        self.edit(cube)

    def fill(self):
        shape, material = random_shape(self.rng, len(self.cube)), int(self.rng.integers(0, 4))
        self.world.fill(shape, material)
        self.edit(np.where(edits.shape_mask(len(self.cube), shape), material, self.cube).astype(np.uint8))

    def paint(self):
        shape, material = random_shape(self.rng, len(self.cube)), int(self.rng.integers(1, 4))
        self.world.paint(shape, material)
        chosen = edits.shape_mask(len(self.cube), shape) & (self.cube != 0)
        self.edit(np.where(chosen, material, self.cube).astype(np.uint8))

    def paste(self):
        side = len(self.cube)
        low = self.rng.integers(-2, side, 3)
        high = low + self.rng.integers(1, side + 2, 3)
        at, turned = self.rng.integers(-side // 2, side, 3), int(self.rng.integers(4))
        self.world.paste(self.world.copy(low, high), at, turned=turned)
        self.edit(edits.paste(self.cube, edits.box(self.cube, low, high), at, turned))

    def go_back(self):
        assert self.world.undo() == bool(self.undo)
        if self.undo:
            self.redo.append(self.cube)
            self.cube = self.undo.pop()

    def go_forth(self):
        assert self.world.redo() == bool(self.redo)
        if self.redo:
            self.undo.append(self.cube)
            self.cube = self.redo.pop()

    def commit(self):
        patch = self.world.commit()
        read = self.device[[*self.live]]
        self.device = patch.apply(self.device)
        assert (self.device[[*self.live]] == read).all()
        self.live[patch.root] = self.cube
        assert set(self.world.live_roots) == set(self.live)
        for root in self.world.live_roots[:-1]:
            if self.rng.random() < 0.5:
                self.world.release(root)
                del self.live[root]

    def check(self, words):
        self.world._native.check()
        np.testing.assert_array_equal(self.world.rom().octree.words, words(self.cube))
        assert self.world.steps == (len(self.undo), len(self.redo))

    def check_device(self):
        for root, cube in self.live.items():
            words = self.device.copy()
            words[0] = words[root]
            np.testing.assert_array_equal(octree.to_dense(Octree(self.world.depth, words)), cube)
            np.testing.assert_array_equal(octree.to_dense(self.world.octree_at(root)), cube)


@pytest.mark.parametrize(("depth", "steps"), [(1, 2000), (2, 1000), (3, 600)])
def test_random_edits_of_small_worlds_are_canonical_after_each(depth, steps):
    rng = np.random.default_rng(depth)
    model = Model(rng.integers(0, 3, (1 << depth,) * 3).astype(np.uint8), rng)
    for _ in range(steps):
        model.step()
        model.check(reference_words)
        model.check_device()


@pytest.mark.parametrize("depth", [2, 3, 5])
def test_a_world_goes_on_where_a_memory_with_its_patches_was(depth):
    """Blocks stay where they are, and those that the root does not reach, whatever they hold, are used first."""
    rng = np.random.default_rng(depth)
    model = Model(rng.integers(0, 3, (1 << depth,) * 3).astype(np.uint8), rng)
    for _ in range(20):
        for _ in range(8):
            model.step()
        model.commit()
        root = model.world.live_roots[-1]
        words = model.device.copy()
        words[0] = words[root]
        reached = octree.from_dense(model.cube).blocks  # equal blocks are one
        model.world = world_of(Octree(depth, words), undo_steps=UNDO_STEPS, root=root)
        model.undo, model.redo, model.live = [], [], {root: model.cube}
        assert model.world.live_roots == (root,)
        assert (model.world.image == words).all()
        figures = model.world.figures()
        assert (figures.blocks, figures.kept) == (reached, int(root != 0))
        assert figures.free == (len(words) - 1) // 8 - reached - int(root != 0)
        model.check(lambda cube: octree.from_dense(cube).words)
        model.check_device()


def test_the_root_of_a_world_has_the_word_of_the_first():
    tree = octree.from_points([[1, 2, 3]], [1], depth=2)
    for root in (1, 17):
        with pytest.raises(ValueError, match="root"):
            world_of(tree, root=root)
    words = np.full(17, 0xFFFFFF00, np.uint32)
    words[[0, 1, 9]] = 9, 9, 0xFFFFFF01
    assert world_of(Octree(2, words), root=1).live_roots == (1,)
    words[1], words[9:17] = 9, 0xFFFFFF01  # uniform blocks are no memory to go on with
    assert world_of(Octree(2, words), root=1).live_roots == (0,)


LONG = 6250
"""Operations of a world that is edited for long: 100,000 in worlds of depths 1 to 16."""


def long(depths):
    return [pytest.param(depth, LONG, marks=pytest.mark.slow) for depth in depths]


@pytest.mark.parametrize(("depth", "steps"), [(4, 1000), (5, 600), (6, 200), *long(range(1, 7))])
def test_random_edits_are_those_of_an_array(depth, steps):
    rng = np.random.default_rng(depth)
    model = Model(np.zeros((1 << depth,) * 3, np.uint8), rng)
    for step in range(steps):
        model.step()
        model.check(lambda cube: octree.from_dense(cube).words)
        if step % 10 == 0:
            model.check_device()


@pytest.mark.parametrize(("depth", "steps"), [*((depth, 60) for depth in (7, 10, 12, 14, 16)), *long(range(7, 17))])
def test_random_voxels_of_large_worlds_are_those_of_a_dictionary(depth, steps):
    rng = np.random.default_rng(depth)
    side, voxels, history = 1 << depth, {(0, 0, 0): 1}, []
    world = world_of(octree.from_points([[0, 0, 0]], [1], depth=depth), undo_steps=3)
    for step in range(1, steps + 1):
        if history and rng.random() < 0.1:
            assert world.undo()
            voxels |= history.pop()
        else:
            middle = rng.integers(0, side, 3)
            points = np.clip(middle + rng.integers(-4, 5, (rng.integers(1, 30), 3)), 0, side - 1)
            known = world.steps[0]
            if rng.random() < 0.3:
                radius = rng.integers(0, 50) / 16
                near = np.clip(middle + np.indices((9, 9, 9)).reshape(3, -1).T - 4, 0, side - 1)
                points = near[((near + 0.5 - middle) ** 2).sum(axis=1) <= radius**2]
                ids = [3] * len(points)
                world.fill(Sphere(middle, radius), 3)
            else:
                ids = rng.integers(0, 4, len(points)).tolist()
                world.set(points, ids)
            after = dict(zip(map(tuple, points.tolist()), ids, strict=True))
            before = {point: voxels.get(point, 0) for point in after}
            if after != before:
                history = [*history, before][-3:]
            assert world.steps[0] == len(history) >= known - (known == 3)
            voxels |= after
        world._native.check()
        if step % 1000 == 0 or step == steps:
            solid = {point: material for point, material in voxels.items() if material}
            expected = octree.from_points(list(solid), list(solid.values()), depth=depth)
            np.testing.assert_array_equal(world.rom().octree.words, expected.words)
            np.testing.assert_array_equal(world.material_at(list(voxels)), list(voxels.values()))


def test_a_voxel_takes_one_block_per_level_and_old_roots_stay():
    rng = np.random.default_rng(1)
    depth = 9
    points = rng.integers(0, 1 << depth, (3000, 3))
    before = octree.from_points(points, rng.integers(1, 4, 3000), depth=depth)
    world = world_of(before, undo_steps=0)
    device, cut = before.words, 0
    for point in rng.integers(0, 1 << depth, (50, 3)):
        old = world.live_roots[-1]
        seen = octree.to_points(world.octree_at(old))
        world.set([point], [5])
        patch = world.commit()
        assert len(patch.addresses) <= depth
        assert patch.words == 8 * len(patch.addresses) + 1
        cut = patch.apply(device)  # the new root is not taken yet
        if old == 0:
            again = octree.to_points(Octree(depth, cut))
            assert all(np.array_equal(a, b) for a, b in zip(seen, again, strict=True))
        device = cut
        world.release(old)
    figures = world.figures()
    assert 100 * (figures.free + figures.kept) <= figures.blocks
    assert octree.Octree(depth, world.image).blocks == figures.blocks + figures.kept + figures.free


def test_a_memory_that_does_not_share_is_shared_first():
    cube = np.zeros((8, 8, 8), np.uint8)
    cube[::2] = 1
    cube[0, 0, 0] = 2
    tree = octree.decode(unshared_words(cube), "report", 3)
    world = world_of(tree)
    np.testing.assert_array_equal(world.image, reference_words(cube))
    world.set([[1, 1, 1]], 3)
    cube[1, 1, 1] = 3
    np.testing.assert_array_equal(world.rom().octree.words, reference_words(cube))


def test_other_frames_of_an_animation_stay():
    rng = np.random.default_rng(8)
    cubes = [rng.integers(0, 2, (8, 8, 8)).astype(np.uint8) for _ in range(5)]
    cubes[3][:4] = cubes[0][:4]
    memory, roots = octree.join_frames([octree.from_dense(cube) for cube in cubes])
    world = world_of(memory)
    device = memory.words
    np.testing.assert_array_equal(world.image, device)
    for _ in range(20):
        older = world.live_roots[-1]
        world.fill(random_shape(rng, 8), int(rng.integers(0, 3)))
        device = world.commit().apply(device)
        if older != world.live_roots[-1]:
            world.release(older)
        world._native.check()
    for root, cube in zip(roots, cubes, strict=True):
        np.testing.assert_array_equal(octree.to_dense(octree.frame_octree(Octree(3, device), root)), cube)


def test_an_edit_without_room_changes_nothing():
    rng = np.random.default_rng(3)
    cube = np.zeros((16, 16, 16), np.uint8)
    world = world_of(octree.from_dense(cube), words=1 + 8 * 40)
    problems, forgotten = [], 0
    for _ in range(300):
        state = world.rom().octree.words, world.steps
        points, ids = rng.integers(0, 16, (rng.integers(1, 9), 3)), int(rng.integers(0, 3))
        edited = cube.copy()
        edited[tuple(points.T)] = ids
        if rng.random() < 0.02:
            world.fill(Box((0, 0, 0), (16, 16, 16)), 0)
            edited = np.zeros_like(cube)
        else:
            try:
                world.set(points, ids)
            except DoesNotFitError as error:
                problems.append(str(error))
                assert world.steps == state[1]
                np.testing.assert_array_equal(world.rom().octree.words, state[0])
                edited = cube
            else:
                forgotten += world.steps[0] < state[1][0]
        cube = edited
        world._native.check()
        assert len(world.image) <= 321
        np.testing.assert_array_equal(octree.to_dense(world.rom().octree), cube)
    assert len(problems) > 10
    assert all("does not fit the 321 words of the world's memory" in problem for problem in problems)
    assert forgotten > 0


def test_live_roots_keep_their_words():
    world = world_of(octree.from_points([[1, 1, 1]], [1], depth=3), words=1 + 8 * 12, undo_steps=0)
    for x in range(8):
        try:
            world.set([[x, x, 0]], 2)
            world.commit()
        except DoesNotFitError as error:
            problem = str(error)
            break
    assert "release older roots" in problem
    live = world.live_roots
    assert [len(octree.to_points(world.octree_at(root))[0]) for root in live] == list(range(1, len(live) + 1))
    for root in live[:-1]:
        world.release(root)
    world.set([[0, 7, 7]], 3)
    world._native.check()


def test_roots_that_are_not_live_are_refused():
    world = world_of(octree.from_points([[1, 1, 1]], [1], depth=3))
    with pytest.raises(ValueError, match="committed last"):
        world.release(0)
    world.set([[2, 2, 2]], 2)
    patch = world.commit()
    assert world.commit().root == patch.root
    world.release(0)
    for call in (world.release, world.octree_at):
        with pytest.raises(ValueError, match="the root at word 0 is not live"):
            call(0)


def test_threads_read_old_roots_while_one_edits():
    rng = np.random.default_rng(5)
    world = world_of(octree.from_points([[0, 0, 0]], [1], depth=8), undo_steps=5)
    problems = []

    def read(root, points):
        for _ in range(20):
            found, _ = octree.to_points(world.octree_at(root))
            if sorted(found.tolist()) != points:
                problems.append(root)

    voxels, readers = {(0, 0, 0)}, []
    for _ in range(12):
        points = rng.integers(0, 256, (200, 3)).tolist()
        world.set(points, 1)
        voxels |= set(map(tuple, points))
        root = world.commit().root
        readers.append(threading.Thread(target=read, args=(root, sorted(map(list, voxels)))))
        readers[-1].start()
    for reader in readers:
        reader.join()
    assert not problems


def test_materials_are_added_while_255_allow():
    world = world_of(octree.from_points([[1, 1, 1]], [1], depth=3))
    assert world.add_material(MATERIALS[3]) == 3
    ids = [world.add_material(Material(f"n{i}", (i, 0, 0))) for i in range(248)]
    assert ids == list(range(8, 256))
    with pytest.raises(DoesNotFitError, match="255 materials and can have 255: there is no room for 'more'"):
        world.add_material(Material("more", (1, 2, 3)))
    world.set([[0, 0, 0]], 255)
    assert world.rom().materials[255].name == "n247"
    coin = Rom("coin", octree.from_points([[0, 0, 0]], [1], depth=1), (EMPTY, Material("more", (1, 2, 3))))
    with pytest.raises(DoesNotFitError, match="no room for 'more'"):
        world.paste(coin, (0, 0, 0))
    assert world.material_at([0, 0, 0]) == 255


def test_pasting_a_memory_matches_materials_by_their_values():
    world = world_of(octree.from_points([[1, 1, 1]], [1], depth=3))
    red = Material("red", (255, 0, 0))
    other = Rom("other", octree.from_points([[0, 0, 0], [1, 0, 0]], [1, 2], depth=1), (EMPTY, red, MATERIALS[5]))
    world.paste(other, (4, 4, 4))
    assert world.material_at([[4, 4, 4], [5, 4, 4], [1, 1, 1]]).tolist() == [8, 5, 1]
    assert world.materials[8] == red


def test_means_are_made_anew_and_refused_in_patches():
    cube = np.zeros((8, 8, 8), np.uint8)
    cube[:, :5] = 1
    world = World(octree.with_means(Rom("floor", octree.from_dense(cube), MATERIALS)))
    world.fill(Box((0, 0, 0), (4, 5, 8)), 2)
    cube[:4, :5] = 2
    expected = octree.with_means(Rom("floor", octree.from_dense(cube), MATERIALS)).octree
    np.testing.assert_array_equal(world.rom().octree.means, expected.means)
    with pytest.raises(ValueError, match="floor has mean materials"):
        world.commit()


@pytest.mark.parametrize(
    ("call", "problem"),
    [
        (lambda world: world.set([[8, 0, 0]], 1), r"points\[0, 0\] must be an integer 0 … 7, not 8"),
        (lambda world: world.set([[0, 0, 0]], 8), "material must be an integer 0 … 7, not 8"),
        (lambda world: world.set([[0, 0, 0]], [1, 2]), r"points and materials must be \(N, 3\) and \(N,\)"),
        (lambda world: world.fill("ball", 1), "shape must be a Box, a Sphere or a Capsule, not 'ball'"),
        (lambda world: world.paint(Box((0, 0, 0), (1, 1, 1)), 0), "material must be an integer 1 … 7, not 0"),
        (lambda world: world.copy((0, 0, 0), (0, 1, 1)), "a box of 0 x 1 x 1 voxels cannot be copied"),
        (lambda world: world.paste(7, (0, 0, 0)), "other must be a Piece or a Rom, not int"),
        (lambda _: Sphere((0, 0, 0), 0.1), "Sphere.radius must have multiples of 1/16 voxel"),
        (lambda _: Sphere((0, 0, 1 / 3), 1), "Sphere.centre must have multiples of 1/16 voxel"),
        (lambda _: Capsule((0, 0, 0), (1, 1, 1), -1), "Capsule.radius must be a finite number"),
        (lambda world: World(world.rom(), words=9), "its 25 words do not fit the 9"),
    ],
)
def test_what_is_wrong_is_refused_in_one_line(call, problem):
    world = world_of(octree.from_points([[1, 1, 1]], [1], depth=3))
    with pytest.raises((TypeError, ValueError, DoesNotFitError), match=problem):
        call(world)
