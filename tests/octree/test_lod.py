"""The dialect lod and the mean materials of blocks."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles import lod
from oracles.cuts import memory_of
from oracles.random_worlds import dense_cubes

import voxrt
from voxrt.export import read_rom, write_rom
from voxrt.octree import (
    Octree,
    Rom,
    RomError,
    decode,
    detect_dialect,
    diff,
    encode,
    from_dense,
    from_points,
    with_means,
)
from voxrt.voxelize import EMPTY, DoesNotFitError, Material
from voxrt.voxelize.colour.srgb import linear_from_srgb

COLOURS = np.random.default_rng(12).integers(0, 256, (256, 3), dtype=np.uint8)
TABLE = (EMPTY, *(Material(str(row), tuple(int(c) for c in COLOURS[row])) for row in range(1, 256)))
ROUNDING = Fraction(1, 1000)


@given(dense_cubes(max_depth=4), st.booleans())
@settings(max_examples=60, deadline=None)
def test_means_are_those_of_the_definition(dense, share):
    depth = len(dense).bit_length() - 1
    words = memory_of(dense, share=share)
    means = with_means(Rom("world", Octree(depth, words), TABLE)).octree.means
    assert means is not None
    light = [[Fraction(float(c)) for c in row] for row in linear_from_srgb(COLOURS)]
    for word, (wanted, coverage) in lod.looks(words, depth, dense, COLOURS).items():
        mean = int(means[word >> 3])
        covered = lod.spare_coverage(coverage)
        if wanted is None or covered < -ROUNDING:
            assert mean == 0
            continue
        if mean == 0:
            assert covered < ROUNDING
            continue
        distances = [sum((a - b) ** 2 for a, b in zip(light[row], wanted, strict=True)) for row in range(1, 256)]
        assert distances[mean - 1] <= min(distances) + ROUNDING


def test_what_is_hidden_does_not_count():
    # A red block of 8 voxels per side in a skin of blue: every block shows blue.
    dense = np.zeros((16,) * 3, np.uint8)
    dense[4:12, 4:12, 4:12] = 2
    dense[5:11, 5:11, 5:11] = 1
    rom = Rom("skin", from_dense(dense), (EMPTY, Material("red", (255, 0, 0)), Material("blue", (0, 0, 255))))
    means = with_means(rom).octree.means
    assert means is not None
    assert set(means.tolist()) == {0, 2}
    assert (means == 2).sum() >= 8


def test_the_mean_is_that_of_linear_light():
    # Black and white in equal parts: sRGB 188 has half of the light, 128 a fifth.
    checks = (np.indices((8, 8, 8)).sum(axis=0) % 2 + 1).astype(np.uint8)
    table = (EMPTY, *(Material(str(grey), (grey,) * 3) for grey in (0, 255, 128, 188)))
    means = with_means(Rom("checks", from_dense(checks), table)).octree.means
    assert means is not None
    assert means[0] == 4


@pytest.mark.parametrize("axis", range(3))
def test_one_axis_with_less_coverage_than_eleven_sixteenths_is_enough(axis):
    # Along the axis: two columns of 1, one of two halves, 3/4, and an empty one. Along the others: 1. With one row of
    # voxels less the third column is a half and a quarter, 5/8.
    dense = np.zeros((4,) * 3, np.uint8)
    dense[:, :2] = 1
    dense[:, 2:, 0] = 1
    less = dense.copy()
    less[:2, 3, 0] = 0
    for voxels, mean in ((dense, 1), (less, 0)):
        means = with_means(Rom("corner", from_dense(np.moveaxis(voxels, 0, axis)), TABLE[:2])).octree.means
        assert means is not None
        assert means[0] == mean


def test_words_of_the_dialect():
    tree = from_points([[0, 0, 0], [3, 3, 3]], [1, 2], depth=2)
    means = np.array([7, 0, 255], np.uint8)
    words = encode(tree.words, "lod", means)
    assert [hex(word) for word in words[[0, 1, 8]]] == ["0x7", "0x100", "0x2ff"]
    leaves = tree.words >> 31 == 1
    np.testing.assert_array_equal(words[leaves], tree.words[leaves])
    again = decode(words, "lod", 2)
    np.testing.assert_array_equal(again.words, tree.words)
    np.testing.assert_array_equal(again.means, means)
    assert detect_dialect(words) == "report"  # only a manifest tells


@given(dense_cubes(), st.integers(0, 2**32 - 1))
def test_every_memory_comes_back(dense, seed):
    tree = from_dense(dense)
    means = np.random.default_rng(seed).integers(0, 256, tree.blocks, dtype=np.uint8)
    again = decode(encode(tree.words, "lod", means), "lod", tree.depth)
    np.testing.assert_array_equal(again.words, tree.words)
    np.testing.assert_array_equal(again.means, means)


def test_faults_are_told():
    tree = from_points([[0, 0, 0], [3, 3, 3]], [1, 2], depth=2)
    words = encode(tree.words, "lod", np.array([7, 5, 255], np.uint8))
    for address, word, problem in (
        (8, 0x00000305, "word 0x8: pointer 00000305 leads behind the last of 25 words"),
        (8, 0xFFFFFE05, "word 0x8: pointer FFFFFE05 leads behind the last of 25 words"),
        (1, 0x00000002, "word 0x1: pointer 00000002 leads back to a block that it lies in"),
    ):
        broken = words.copy()
        broken[address] = word
        with pytest.raises(RomError, match=problem):
            decode(broken, "lod", 2)
    torn = words.copy()
    torn[2] = 0x00000106  # block 1 has mean 5 at word 1
    with pytest.raises(RomError, match=r"0000010[56] gives block 1 another mean material"):
        decode(torn, "lod", 2)
    with pytest.raises(ValueError, match="no mean materials"):
        encode(tree.words, "lod")
    with pytest.raises(DoesNotFitError, match="dialect lod holds 16,777,215 blocks and the memory has 16,777,216"):
        encode(tree.words, "lod", np.zeros(1 << 24, np.uint8))


def test_a_memory_keeps_its_means_in_files(tmp_path):
    rom = with_means(Rom("dots", from_dense(np.random.default_rng(1).integers(0, 3, (8, 8, 8))), TABLE[:3]))
    assert rom.octree.means is not None
    files = write_rom(tmp_path, rom, dialect="lod")
    assert '"dialect": "lod"' in files.manifest.read_text()
    again, warnings = read_rom(files.mem)
    assert warnings == ()
    np.testing.assert_array_equal(again.octree.means, rom.octree.means)
    np.testing.assert_array_equal(again.octree.words, rom.octree.words)
    assert diff(again.octree, rom.octree).voxels == 0


def test_a_mean_without_a_material_is_refused(tmp_path):
    rom = with_means(Rom("dots", from_dense(np.random.default_rng(1).integers(0, 3, (8, 8, 8))), TABLE[:3]))
    foreign = np.full(rom.octree.blocks, 200, np.uint8)
    files = write_rom(tmp_path, Rom("dots", Octree(3, rom.octree.words, foreign), TABLE[:3]), dialect="lod")
    with pytest.raises(RomError, match="material 200 is missing from the manifest"):
        read_rom(files.mem)


def test_a_build_writes_it(tmp_path):
    built = voxrt.build("examples/house.obj", tmp_path, depth=5, lod=True)
    assert built.octree.means is not None
    again, _ = read_rom(built.outputs["mem"])
    np.testing.assert_array_equal(again.octree.means, built.octree.means)
    plain = voxrt.build("examples/house.obj", depth=5)
    np.testing.assert_array_equal(again.octree.words, plain.octree.words)
    with pytest.raises(ValueError, match="lod has its own dialect, and msb has no mean materials"):
        voxrt.BuildOptions(lod=True, dialect="msb")
