"""The device: what the frame server needs of a ray tracer, be it a board, its simulation or its model."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from .view import View


@dataclass(frozen=True, slots=True)
class Identity:
    """What a device says of itself.

    Attributes
    ----------
    name, version
        For people.
    capacity
        Words of scene memory.
    depth
        Deepest octree, levels.
    size
        Largest frame, columns and rows.
    position_limit
        Camera positions lie below this on either side of zero, 1/16 voxel.
    features
        Which of :data:`~.view.FEATURES` it has.
    width_step
        Frames have a multiple of this many columns.
    movable_root
        Whether an octree may stand anywhere in the memory, so that two can be there at a time; otherwise at word 0.
    clock
        Hertz; None where there is no clock.
    """

    name: str
    version: str
    capacity: int
    depth: int
    size: tuple[int, int]
    position_limit: int
    features: frozenset[str] = frozenset()
    width_step: int = 1
    movable_root: bool = True
    clock: int | None = None


@dataclass(frozen=True, slots=True)
class Counters:
    """What a frame cost: rays traced, octree words read and clocks (both None without hardware), wall seconds."""

    rays: int
    words_read: int | None
    cycles: int | None
    seconds: float


@dataclass(frozen=True, eq=False, slots=True)
class Frame:
    """A complete frame: uint8, shape (H, W, 3), sRGB, row 0 at the top, C-contiguous; and what it cost."""

    colour: NDArray[np.uint8]
    counters: Counters


class Device(Protocol):
    """A ray tracer with its scene memory.

    Calls come one at a time, from any thread, and may block. Frames are made by :meth:`frame` alone, so that between
    two calls the device stands at a frame boundary. What goes wrong raises :class:`~.errors.DeviceError`.
    """

    @property
    def identity(self) -> Identity:
        """What it is and what it holds."""

    def registers(self) -> Mapping[str, int]:
        """Read all registers, by name, in the order of their addresses."""

    def write_memory(self, address: int, words: NDArray[np.uint32]) -> None:
        """Write words (uint32, shape (N,)) from word `address` on."""

    def read_memory(self, address: int, count: int) -> NDArray[np.uint32]:
        """Read `count` words from word `address` on."""

    def write_materials(self, colours: NDArray[np.uint8], mirrors: NDArray[np.bool_], /) -> None:
        """Write the material table: uint8, shape (256, 3), sRGB, and bool, shape (256,)."""

    def select_scene(self, root: int, depth: int) -> None:
        """Trace the octree of `depth` levels whose root word stands at `root`, from the next frame on."""

    def frame(self, view: View) -> Frame:
        """Render a frame of exactly this view, and return when it is complete."""

    def close(self) -> None:
        """Let go of the device; nothing is called afterwards."""
