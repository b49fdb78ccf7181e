"""One memory of many frames: against the builder of octrees, against each frame alone, and against wrong roots."""

from __future__ import annotations

import numpy as np
import pytest
from msgspec.structs import replace

from voxrt import octree
from voxrt.octree import (
    Animation,
    AnimationFrame,
    Octree,
    RomError,
    check_frame_count,
    check_roots,
    frame_octree,
    frames_as_octants,
    join_frames,
)
from voxrt.voxelize import DoesNotFitError, Grid, Voxels, authoring, voxelize


def frame_voxels(step: int, depth: int = 4) -> Voxels:
    """A pillar that stays and a box that walks."""
    yard = authoring.Author("yard")
    yard.material("stone", "#9a9aa0")
    yard.material("red", "#cc2020")
    yard.add("pillar", authoring.box((4, 16, 4), centre=(2, 8, 2)), material="stone")
    yard.add("box", authoring.box((3, 3, 3), centre=(7 + step % 7, 6.5, 9)), material="red")
    return voxelize(yard.build(), Grid(depth, (0, 0, 0), 1.0)).voxels


def together(frames: list[Voxels]) -> Octree:
    """The same by the builder alone: frame k's bricks and octants stand at Morton position k of a larger grid."""
    levels = 0
    while 8**levels < len(frames):
        levels += 1
    depth = frames[0].depth
    rows = np.cumsum([0, *(len(frame.cells) for frame in frames)])
    return octree.build(
        Voxels(
            depth + levels,
            np.concatenate([frame.brick_codes + np.uint64(k << 3 * (depth - 3)) for k, frame in enumerate(frames)]),
            np.concatenate([frame.brick_masks for frame in frames]),
            np.concatenate([frame.brick_materials for frame in frames]),
            np.concatenate(
                [
                    np.where(frame.brick_rows < 0, -1, frame.brick_rows + rows[k]).astype(np.int32)
                    for k, frame in enumerate(frames)
                ]
            ),
            np.concatenate([frame.cells for frame in frames]),
            np.concatenate(
                [
                    frame.octant_codes + (np.uint64(k) << (3 * (depth - frame.octant_levels)).astype(np.uint64))
                    for k, frame in enumerate(frames)
                ]
            ),
            np.concatenate([frame.octant_levels for frame in frames]),
            np.concatenate([frame.octant_materials for frame in frames]),
        )
    )


@pytest.mark.parametrize("count", [1, 2, 8, 9, 65])
def test_the_memory_is_that_of_one_octree_with_a_frame_per_octant(count):
    frames = [frame_voxels(step) for step in range(count)]
    memory, roots = join_frames(octree.build(frame) for frame in frames)
    whole = together(frames)
    assert np.array_equal(memory.words[1:], whole.words[1:])  # word 0 is the first frame's root
    assert memory.words[0] == memory.words[roots[0]]
    assert np.array_equal(octree.share(frames_as_octants(memory, roots)).words, whole.words)


@pytest.mark.parametrize("count", [1, 3, 20])
def test_each_frame_is_what_it_is_alone(count):
    alone = [octree.build(frame_voxels(step)) for step in range(count)]
    memory, roots = join_frames(alone)
    assert len(roots) == count
    for tree, root in zip(alone, roots, strict=True):
        assert np.array_equal(octree.share(frame_octree(memory, root)).words, tree.words)
    assert check_roots(memory, roots) == 2


def test_uniform_frames_and_frames_of_one_level():
    solid, empty = (octree.from_dense(np.full((2, 2, 2), material, np.uint8)) for material in (3, 0))
    memory, roots = join_frames([solid, empty, solid])
    assert [int(memory.words[root]) & 0xFF for root in roots] == [3, 0, 3]
    memory, roots = join_frames([solid] * 8)
    assert (len(memory.words), roots) == (1, (0,) * 8)


def test_words_in_another_order_give_the_same_memory():
    tree = octree.build(frame_voxels(1))
    twice = np.where(tree.words >> 31 == 0, tree.words + np.uint32(len(tree.words) - 1), tree.words)
    spread = np.concatenate([tree.words, twice[1:]])  # every block a second time, which nobody reaches
    others = [octree.build(frame_voxels(step)) for step in (0, 2)]
    memory, _ = join_frames([others[0], tree, others[1]])
    again, _ = join_frames([others[0], Octree(tree.depth, spread), others[1]])
    assert np.array_equal(memory.words, again.words)


def test_frames_of_two_depths_are_refused():
    with pytest.raises(ValueError, match="depths 4 and 5"):
        join_frames([octree.build(frame_voxels(0)), octree.build(frame_voxels(0, 5))])
    with pytest.raises(ValueError, match="no frame"):
        join_frames([])


def test_too_many_frames_for_their_depth():
    check_frame_count(16, 1)
    with pytest.raises(DoesNotFitError, match="build 8 frames, or with depth 14"):
        check_frame_count(15, 9)
    deep = octree.from_points([[0, 0, 0]], [1], 16)
    with pytest.raises(DoesNotFitError, match="fewer frames"):
        join_frames([deep, deep])


def test_wrong_roots_are_refused():
    memory, roots = join_frames([octree.build(frame_voxels(step)) for step in range(9)])
    for wrong in (-1, len(memory.words)):
        with pytest.raises(RomError, match="frame 1 has its root"):
            check_roots(memory, (roots[0], wrong))
    above = (1, *roots)  # a word of the upper level of the table: an octree of five levels
    with pytest.raises(RomError, match="more than 4 levels"):
        check_roots(memory, above)


def test_the_values_of_an_animation():
    frame = AnimationFrame(9, 73, 0.5, "walk")
    assert Animation((frame, replace(frame, time=1.0))).period == 0.5
    assert Animation((frame, replace(frame, time=None))).period is None
    with pytest.raises(ValueError, match="one frame"):
        Animation(())
    with pytest.raises(ValueError, match="root"):
        replace(frame, root=-1)
