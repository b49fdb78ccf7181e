import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.octree import reference_words, unshared_words
from oracles.random_worlds import dense_cubes
from oracles.worlds import lumps

from voxrt import octree
from voxrt.building.fitting import Views, fit_budget
from voxrt.voxelize import DoesNotFitError, Material


def surface(cube):
    padded = np.pad(cube, 1) != 0
    covered = np.ones(cube.shape, bool)
    for axis in range(3):
        for step in (-1, 1):
            covered &= np.roll(padded, step, axis)[1:-1, 1:-1, 1:-1]
    return (cube != 0) & ~covered


@given(dense_cubes())
def test_sharing_gives_the_canonical_memory(cube):
    tree = octree.decode(unshared_words(cube), "report", len(cube).bit_length() - 1)
    np.testing.assert_array_equal(octree.share(tree).words, reference_words(cube))
    assert octree.shared_words(tree) == octree.shared_words(octree.share(tree)) == len(reference_words(cube))


@given(dense_cubes(4), st.integers(0, 4))
def test_coarsening_is_the_majority_of_the_solid(cube, level):
    depth = len(cube).bit_length() - 1
    level = min(level, depth)
    side = 1 << level
    expected = cube.copy()
    for x, y, z in np.ndindex(*[len(cube) // side] * 3):
        part = expected[x * side : (x + 1) * side, y * side : (y + 1) * side, z * side : (z + 1) * side]
        counts = np.bincount(part.ravel(), minlength=256)
        counts[0] = 0
        part[:] = counts.argmax()
    np.testing.assert_array_equal(octree.coarsen(octree.from_dense(cube), level).words, reference_words(expected))


@given(st.data())
def test_surface_change_is_what_brute_force_counts(data):
    a, b = data.draw(dense_cubes(4)), data.draw(dense_cubes(4))
    side = max(len(a), len(b))
    a, b = (np.pad(c, (0, side - len(c))) for c in (a, b))
    trees = octree.from_dense(a), octree.from_dense(b)
    found = octree.surface_change(*trees)
    seen = surface(a)
    assert found.surface == np.count_nonzero(seen)
    assert found.changed == np.count_nonzero(seen & ~(surface(b) & (a == b)))
    assert found.percent == (100 * found.changed / found.surface if found.surface else 0)


@given(dense_cubes(5), st.floats(0, 1), st.booleans())
@settings(max_examples=40)
def test_a_fit_fits_and_opens_no_hole(cube, share, coloured):
    tree = octree.from_dense(cube)
    words = max(1, int(share * len(tree.words)))
    colours = np.random.default_rng(1).integers(0, 256, (256, 3)).astype(np.uint8) if coloured else None
    try:
        found = octree.fit(tree, words, colours=colours)
    except DoesNotFitError as error:
        smallest = int(str(error).split()[-2])
        assert smallest > words
        assert len(octree.fit(tree, smallest, colours=colours).octree.words) <= smallest
        return
    assert len(found.octree.words) <= words
    shown = octree.to_dense(found.octree)
    np.testing.assert_array_equal(found.octree.words, reference_words(shown))
    assert not (shown[cube != 0] == 0).any()
    assert set(np.unique(shown)) <= set(np.unique(cube))
    assert found.appeared == np.count_nonzero((cube == 0) & (shown != 0))
    assert found.recoloured == np.count_nonzero((cube != 0) & (shown != cube))
    assert found.surface == np.count_nonzero(surface(cube))
    assert found.changed == np.count_nonzero(surface(cube) & ~(surface(shown) & (shown == cube)))


def test_what_fits_is_not_touched():
    tree = octree.from_dense(lumps(5))
    found = octree.fit(tree, len(tree.words))
    np.testing.assert_array_equal(found.octree.words, tree.words)
    assert (found.changed, found.appeared, found.recoloured, found.percent_changed) == (0, 0, 0, 0.0)


def test_sharing_comes_first():
    cube = lumps(5)
    tree = octree.decode(unshared_words(cube), "report", 5)
    found = octree.fit(tree, len(reference_words(cube)))
    assert (found.words_before, found.words_shared) == (len(tree.words), len(found.octree.words))
    assert octree.diff(tree, found.octree).voxels == 0


@pytest.mark.parametrize("materials", [1, 3])
@pytest.mark.parametrize("level", [1, 2])
def test_closer_than_a_coarser_world_of_the_same_size(materials, level):
    tree = octree.from_dense(lumps(6, materials))
    plain = octree.coarsen(tree, level)
    plain_changed = octree.surface_change(tree, plain).changed
    found = octree.fit(tree, len(plain.words))
    assert len(found.octree.words) <= len(plain.words)
    assert found.changed + found.appeared < plain_changed + octree.diff(tree, plain).appeared


@pytest.mark.parametrize("materials", [1, 3])
@pytest.mark.parametrize("level", [1, 2])
def test_pictures_are_closer_too(materials, level):
    """Views from six sides: both figures of the pictures and the surface, none at the price of another."""
    colours = ((0, 0, 0), (200, 80, 60), (70, 160, 90), (80, 110, 200))[: materials + 1]
    whole = octree.Rom(
        "lumps",
        octree.from_dense(lumps(7, materials)),
        tuple(Material(f"material {number}", colour) for number, colour in enumerate(colours)),
    )
    plain = octree.coarsen(whole.octree, level)
    fitted = fit_budget(whole, len(plain.words), (64, 48), 0)[0].octree
    views = Views(whole)
    assert len(fitted.words) <= len(plain.words)
    assert octree.surface_change(whole.octree, fitted).changed < octree.surface_change(whole.octree, plain).changed
    for ours, theirs in zip(views.likeness(fitted), views.likeness(plain), strict=True):
        assert ours > theirs


def test_a_fit_may_be_chosen():
    tree = octree.from_dense(lumps(6))
    plain = octree.coarsen(tree, 1)
    found = octree.fit(tree, len(plain.words), choose=lambda fits: fits[0])
    np.testing.assert_array_equal(found.octree.words, plain.words)


def test_no_material_moves_to_where_it_stands_out():
    """A white ball beside one of blue stripes takes no blue, though patterns of the stripes may fit it better."""
    grid = np.stack(np.indices((64,) * 3), -1) + 0.5
    cube = np.zeros((64,) * 3, np.uint8)
    cube[np.linalg.norm(grid - (20, 20, 20), axis=-1) < 15] = 1
    striped = np.linalg.norm(grid - (44, 44, 44), axis=-1) < 15
    cube[striped] = 2 + (np.indices(cube.shape)[1][striped] // 3) % 2
    colours = np.array([[0, 0, 0], [255, 255, 255], [20, 30, 220], [40, 60, 240]], np.uint8)
    tree = octree.from_dense(cube)
    shown = octree.to_dense(octree.fit(tree, len(tree.words) // 2, colours=colours).octree)
    assert not (surface(shown) & (cube == 1) & (shown > 1)).any()


def test_hidden_materials_go_first():
    """A ball of one material around noise of three: the noise can go without a change that anyone sees."""
    cube = lumps(6) * 4
    hidden = np.zeros(cube.shape, bool)
    hidden[24:40, 24:40, 24:40] = True
    cube[16:48, 16:48, 16:48] = 4
    cube[hidden] = np.random.default_rng(0).integers(1, 4, hidden.sum())
    quiet = np.where(hidden, 4, cube)
    tree = octree.from_dense(cube)
    found = octree.fit(tree, len(octree.from_dense(quiet).words) + 80)
    assert (found.changed, found.appeared) == (0, 0)
    assert found.recoloured > 0


def test_similar_colours_stand_for_each_other_first():
    cube = np.zeros((32, 32, 32), np.uint8)
    cube[:, :, :8] = np.random.default_rng(0).integers(1, 4, (32, 32, 8))
    colours = np.array([[0, 0, 0], [200, 0, 0], [204, 0, 0], [0, 0, 255]], np.uint8)
    tree = octree.from_dense(cube)

    def far_changes(colours):
        shown = octree.to_dense(octree.fit(tree, len(tree.words) // 2, colours=colours).octree)
        return np.count_nonzero((cube == 3) != (shown == 3))

    assert far_changes(colours) < far_changes(None)


def test_infeasible_budgets_name_the_smallest():
    tree = octree.from_dense(lumps(6))
    smallest = len(octree.coarsen(tree, 3).words)
    with pytest.raises(
        DoesNotFitError, match=rf"does not fit {smallest - 1} words: .* give it at least {smallest} words"
    ):
        octree.fit(tree, smallest - 1)
    assert len(octree.fit(tree, smallest).octree.words) <= smallest


def test_boards_hold_whole_blocks():
    assert all(words % 8 == 1 for words in octree.BOARDS.values())


def test_refusals():
    tree = octree.from_dense(np.ones((2, 2, 2), int))
    with pytest.raises(ValueError, match="level must be an integer 0 … 1, not 2"):
        octree.coarsen(tree, 2)
    with pytest.raises(ValueError, match=r"colours must have shape \(M, 3\)"):
        octree.fit(octree.from_dense(lumps(4)), 9, colours=np.zeros((2, 4), np.uint8))
    with pytest.raises(ValueError, match="depth 1 and 4"):
        octree.surface_change(tree, octree.from_dense(lumps(4)))
