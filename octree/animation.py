"""Animation: one memory, many roots.

The octrees of all frames are one memory, in which equal blocks are stored once, in whichever frames they stand. Frame k
is the k-th octant, in Morton order, of an octree with a few more levels. The words of its lowest of these levels are
the roots of the frames. Word 0 is the root of the first frame: who knows nothing of animation sees that frame.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import force_setattr

from voxrt.octree import _native
from voxrt.octree.errors import RomError
from voxrt.octree.octree import MAX_DEPTH, Octree
from voxrt.octree.statistics import census
from voxrt.octree.words import EMPTY, is_leaf, move_pointers
from voxrt.voxelize import DoesNotFitError
from voxrt.voxelize.arguments import instance, real, text, whole
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

_HIGHEST = (1 << 31) - 1


class AnimationFrame(Value, frozen=True):
    """A frame of an animation.

    Attributes
    ----------
    root
        The word of the memory that is its root: what the register ``root`` takes.
    words
        Words of its octree alone.
    time
        Its second of the asset's animation; None where frames are assets of their own.
    name
        The name of its asset; empty where all frames are of one.

    Raises
    ------
    TypeError, ValueError
        A value of another type, or out of range.

    Examples
    --------
    >>> AnimationFrame(9, 721, 0.5)
    AnimationFrame(root=9, words=721, time=0.5, name='')
    """

    root: int
    words: int
    time: float | None = None
    name: str = ""

    def __post_init__(self) -> None:
        whole("root", self.root, 0, _HIGHEST)
        whole("words", self.words, 1, _HIGHEST)
        if self.time is not None:
            real("time", self.time)
        text("name", self.name)


class Animation(Value, frozen=True):
    """The table of roots of a memory that holds several frames.

    Attributes
    ----------
    frames
        In the order in which they are shown; one or more.

    Raises
    ------
    TypeError, ValueError
        There is no frame, or one is none.

    Examples
    --------
    >>> animation = Animation((AnimationFrame(1, 73, 0.0), AnimationFrame(2, 81, 0.5)))
    >>> animation.roots, animation.words_alone, animation.period
    ((1, 2), 154, 0.5)
    """

    frames: tuple[AnimationFrame, ...]

    def __post_init__(self) -> None:
        frames = tuple(instance(f"frames[{row}]", one, AnimationFrame) for row, one in enumerate(self.frames))
        force_setattr(self, "frames", frames)
        if not frames:
            raise ValueError("an animation has one frame or more")

    @property
    def roots(self) -> tuple[int, ...]:
        """The word that is the root of each frame."""
        return tuple(frame.root for frame in self.frames)

    @property
    def words_alone(self) -> int:
        """Words of all frames, each in a memory of its own."""
        return sum(frame.words for frame in self.frames)

    @property
    def period(self) -> float | None:
        """Seconds from one frame to the next; None where frames have no times."""
        times = [frame.time for frame in self.frames if frame.time is not None]
        if len(times) < len(self.frames) or len(times) < 2:
            return None
        return (times[-1] - times[0]) / (len(times) - 1)


def join_frames(frames: Iterable[Octree]) -> tuple[Octree, tuple[int, ...]]:
    """Join octrees of one depth to one memory. Equal blocks are stored once, in whichever octrees they stand.

    At any time it holds at most seven octrees of those given, and as many joined ones per level.

    Parameters
    ----------
    frames
        One or more. The same octrees give the same words, however their own words are arranged.

    Returns
    -------
    octree
        The memory. Its word 0 is the root of the first.
    roots
        The word that is the root of each.

    Raises
    ------
    ValueError
        There is none, or their depths differ.
    DoesNotFitError
        They are too deep and too many: :func:`check_frame_count`.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> memory, roots = join_frames([from_points([[x, 0, 0]], [1], depth=3) for x in range(4)])
    >>> len(memory.words), roots
    (89, (1, 2, 3, 4))
    """
    groups: list[list[Octree]] = [[]]
    count, depth = 0, 0
    for frame in frames:
        depth = instance("frames", frame, Octree).depth if count == 0 else depth
        if frame.depth != depth:
            raise ValueError(f"frames have depths {depth} and {frame.depth}; build all of them on one grid")
        count += 1
        groups[0].append(frame)
        level = 0
        while len(groups[level]) == 8:
            _join_group(groups, level)
            level += 1
    if count == 0:
        raise ValueError("there is no frame to join")
    level = 0
    while level + 1 < len(groups) or len(groups[level]) > 1:
        if groups[level]:
            _join_group(groups, level)
        level += 1
    from voxrt.octree.budget import share  # noqa: PLC0415 - slow to import, and few builds are animations

    whole_octree = groups[level][0] if level else share(groups[level][0])
    words = whole_octree.words.copy()
    roots = _addresses(words, level, count)
    words[0] = words[roots[0]]
    words.flags.writeable = False
    return Octree(depth, words), roots


def check_frame_count(depth: int, count: int) -> None:
    """Refuse more frames than an octree of 16 levels has octants of that depth.

    Raises
    ------
    DoesNotFitError
        8**(16 - depth) are the most.

    Examples
    --------
    >>> check_frame_count(13, 512)
    """
    if depth + _levels(count) > MAX_DEPTH:
        most = 8 ** (MAX_DEPTH - depth)
        raise DoesNotFitError(
            f"{count} frames of depth {depth} do not fit one memory, which holds {most} of that depth; "
            f"build {most} frames, or with depth {MAX_DEPTH - _levels(count)}"
        )


def frame_octree(octree: Octree, root: int) -> Octree:
    """Return the octree whose root is a word of a memory: the same words and means, but for word 0.

    Parameters
    ----------
    octree
        The memory.
    root
        The word; :func:`check_roots` accepts it.

    Examples
    --------
    >>> from voxrt.octree import from_points, to_points
    >>> memory, roots = join_frames([from_points([[x, 0, 0]], [1], depth=3) for x in range(4)])
    >>> to_points(frame_octree(memory, roots[2]))[0].tolist()
    [[2, 0, 0]]
    """
    words = instance("octree", octree, Octree).words
    root = whole("root", root, 0, len(words) - 1)
    if words[root] == words[0]:
        return octree
    moved = words.copy()
    moved[0] = words[root]
    moved.flags.writeable = False
    return Octree(octree.depth, moved, octree.means)


def frames_as_octants(octree: Octree, roots: Sequence[int]) -> Octree:
    """Return one octree in which each frame of an animation is an octant: frame k is the k-th, in Morton order.

    Parameters
    ----------
    octree
        The memory.
    roots
        Those of the frames; :func:`check_roots` accepts them.

    Examples
    --------
    >>> from voxrt.octree import from_points, to_points
    >>> memory, roots = join_frames([from_points([[x, 0, 0]], [1], depth=3) for x in range(4)])
    >>> to_points(frames_as_octants(memory, roots))[0].tolist()
    [[0, 0, 0], [9, 0, 0], [2, 8, 0], [11, 8, 0]]
    """
    levels = _levels(len(roots))
    words = _with_table(octree.words, octree.words[np.asarray(roots, np.int64)], levels)
    words.flags.writeable = False
    return Octree(octree.depth + levels, words)


def check_roots(octree: Octree, roots: Sequence[int], *, source: str = "") -> int:
    """Refuse roots of a memory from which an octree would have too many levels.

    Linear in words and roots.

    Parameters
    ----------
    octree
        The memory, which :func:`decode` has read.
    roots
        Words of it.
    source
        The file that they come from, for errors.

    Returns
    -------
    int
        The highest material of all frames.

    Raises
    ------
    RomError
        A root is no word of the memory, or has more levels below it than the memory says, or there are too many.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> memory, roots = join_frames([from_points([[x, 0, 0]], [x + 1], depth=3) for x in range(4)])
    >>> check_roots(memory, roots)
    4
    """
    label = source or "memory"
    words, levels = octree.words, _levels(len(roots))
    if not roots:
        raise RomError(f"{label}: it has no frame; build it again")
    for row, root in enumerate(roots):
        if not 0 <= root < len(words):
            raise RomError(f"{label}: frame {row} has its root at word {root} of {len(words)}; build it again")
    if octree.depth + levels > MAX_DEPTH:
        raise RomError(f"{label}: {len(roots)} frames of depth {octree.depth} are too many; build it again")
    together = frames_as_octants(octree, roots)
    if _native.validate(together.words, together.depth).fault:
        raise RomError(f"{label}: the root of a frame has more than {octree.depth} levels; build it again")
    return max(census(together).voxels)


def _levels(count: int) -> int:
    """Return the levels above the roots of so many frames."""
    levels = 0
    while 8**levels < count:
        levels += 1
    return levels


def _join_group(groups: list[list[Octree]], level: int) -> None:
    """Make the octrees of one level, at most eight, one octree of the next."""
    group, groups[level] = groups[level], []
    depth = group[0].depth
    if depth + 1 > MAX_DEPTH:
        raise DoesNotFitError(
            f"so many frames of depth {depth - level} do not fit one memory; build fewer frames, or with less depth"
        )
    parts, roots, start = [np.array([EMPTY], np.uint32)], [], 0
    for octree in group:
        moved = move_pointers(octree.words, start)
        roots.append(moved[0])
        parts.append(moved[1:])
        start += len(moved) - 1
        if start > _HIGHEST:
            raise DoesNotFitError(
                f"frames of {start:,} words are too many for one memory; build fewer, or with less depth"
            )
    from voxrt.octree.budget import share  # noqa: PLC0415 - as above

    joined = share(Octree(depth + 1, _with_table(np.concatenate(parts), np.array(roots, np.uint32), 1)))
    if level + 1 == len(groups):
        groups.append([])
    groups[level + 1].append(joined)


def _with_table(words: NDArray[np.uint32], roots: NDArray[np.uint32], levels: int) -> NDArray[np.uint32]:
    """Return a memory with the octree above some roots behind its blocks; word 0 becomes its root."""
    parts, end = [words], len(words)
    for _ in range(levels):
        table = np.full(-(-len(roots) // 8) * 8, EMPTY, np.uint32)
        table[: len(roots)] = roots
        parts.append(table)
        roots = np.arange(end, end + len(table), 8, dtype=np.uint32)
        end += len(table)
    stacked = np.concatenate(parts)
    stacked[0] = roots[0]
    return stacked


def _addresses(words: NDArray[np.uint32], levels: int, count: int) -> tuple[int, ...]:
    """Return the words of the first `count` octants below so many levels; of a larger one where that is uniform."""
    found = []
    for number in range(count):
        address = 0
        for level in reversed(range(levels)):
            if is_leaf(int(words[address])):
                break
            address = int(words[address]) + (number >> 3 * level & 7)
        found.append(address)
    return tuple(found)
