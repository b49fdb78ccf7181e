"""The scene that a board loads, and the check of its octree memory."""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING

from voxrt.board.errors import Refused
from voxrt.octree import RomError, check_roots, decode
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from voxrt.board.view import Camera, Lighting, Triple

MEMORY_SUFFIXES = (".blob", ".mem")
"""Suffixes of the files of an octree memory that a device takes."""


class Scene(Value, frozen=True, eq=False):
    """An octree memory with its materials, first camera and first lighting.

    Attributes
    ----------
    name
        Shown to users.
    depth
        Levels; the world has 2**depth voxels per side.
    words
        uint32, shape (N,), report dialect: word 0 is the root, blocks stand at 1 + 8k.
    colours
        uint8, shape (256, 3), sRGB by material id; row 0 is the background.
    mirrors
        bool, shape (256,): materials that reflect.
    camera
        First camera, for frames of 640 x 480; None where the file has none.
    lighting
        First lighting; None where the file has none.
    roots
        The words that are the roots of the frames of an animation; (0,) for a still scene.
    period
        Seconds from one frame of an animation to the next; None where that is not known.
    warnings
        What its file lost on the way here, a line each.
    names
        Names of the materials by id, as far as they are known.
    voxel_size
        Metres; None where that is not known.
    """

    name: str
    depth: int
    words: NDArray[np.uint32]
    colours: NDArray[np.uint8]
    mirrors: NDArray[np.bool_]
    camera: Camera | None = None
    lighting: Lighting | None = None
    roots: tuple[int, ...] = (0,)
    period: float | None = None
    warnings: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    voxel_size: float | None = None

    @property
    def background(self) -> Triple:
        """The colour of row 0 of `colours`."""
        red, green, blue = (int(channel) for channel in self.colours[0])
        return red, green, blue

    @property
    def crc32(self) -> int:
        """CRC-32 of the words as little-endian bytes."""
        return zlib.crc32(self.words.astype("<u4").tobytes())


def check_size(scene: Scene, holder: str, capacity: int, depth: int) -> None:
    """Refuse a scene that has more words or levels than what shall hold it."""
    for unit, count, verb, most in (
        ("words", len(scene.words), "holds", capacity),
        ("levels", scene.depth, "takes", depth),
    ):
        if count > most:
            raise Refused(f"{scene.name} has {count} {unit} and {holder} {verb} {most}; build it with a smaller depth")


def check_memory(words: NDArray[np.uint32], depth: int, roots: tuple[int, ...] = (0,)) -> None:
    """Refuse a memory that is no octree of `depth` levels, from any of its roots.

    Raises
    ------
    Refused
        As :func:`voxrt.octree.decode` and :func:`voxrt.octree.check_roots` say.
    """
    try:
        octree = decode(words, "report", depth)
        if roots != (0,):
            check_roots(octree, roots)
    except RomError as error:
        raise Refused(str(error)) from error


def frame_period(times: Sequence[float | None]) -> float | None:
    """Return the seconds from one frame to the next; None where frames have no times.

    Examples
    --------
    >>> frame_period([0.0, 0.5, 1.0])
    0.5
    """
    known = [float(time) for time in times if time is not None]
    return None if len(known) < max(2, len(times)) else (known[-1] - known[0]) / (len(known) - 1)
