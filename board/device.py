"""The interface of a device: what the frame server needs of a board, its simulation or the exact model."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Protocol

from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from voxrt.board.frame_drop import FrameDrop
    from voxrt.board.loaded_scene import LoadedScene
    from voxrt.board.view import View
    from voxrt.octree import Patch


class Identity(Value, frozen=True):
    """What a device is and what it can hold.

    Attributes
    ----------
    name, version
        Shown to users.
    capacity
        Words of scene memory.
    depth
        Levels of the deepest octree.
    size
        The largest frame, columns and rows.
    position_limit
        Bound of camera and light positions, 1/16 voxel: -limit <= position < limit.
    features
        The supported ones of :data:`~.view.FEATURES`.
    width_step
        The width of a frame is a multiple of this number of columns.
    clock
        Clock frequency, hertz; None for a device without a clock.
    pixel_seconds
        Seconds that a pixel may take, on average over a frame: many times what it takes in large scenes.
    """

    name: str
    version: str
    capacity: int
    depth: int
    size: tuple[int, int]
    position_limit: int
    features: frozenset[str] = frozenset()
    width_step: int = 1
    clock: int | None = None
    pixel_seconds: float = 2e-5

    def frame_seconds(self, size: tuple[int, int]) -> float:
        """Return the time limit of a frame of `size`, columns and rows, for :meth:`Device.frame`."""
        return 1 + self.pixel_seconds * size[0] * size[1]


class Counters(Value, frozen=True):
    """The cost of a frame: rays, octree words read and clock cycles (None where not counted), wall seconds."""

    rays: int
    words_read: int | None
    cycles: int | None
    seconds: float


class Frame(Value, frozen=True, eq=False):
    """A complete frame: uint8, shape (H, W, 3), sRGB, row 0 at the top, C-contiguous; and its cost."""

    colour: NDArray[np.uint8]
    counters: Counters


class Device(Protocol):
    """A ray tracer with its scene memory.

    The memory can hold several octrees. A frame shows the one that :meth:`select_scene` selected last.

    Calls come one at a time, from any thread, and may block. Every method raises :class:`~.errors.DeviceError` when
    the device fails.
    """

    @property
    def identity(self) -> Identity:
        """What it is and what it can hold."""

    def loaded(self) -> LoadedScene | None:
        """Read the scene that was in the memory when the device was opened; None where there is none, or no more."""

    def registers(self) -> Mapping[str, int]:
        """Read all registers, by name, in the order of their addresses."""

    def hold(self) -> None:
        """Let no frame start until :meth:`frame` is called, and wait until the present one ends."""

    def write_memory(self, address: int, words: NDArray[np.uint32]) -> None:
        """Write words (uint32, shape (N,)) from word `address` on.

        Words of the selected octree change the frame in progress: call :meth:`hold` before.
        """

    def read_memory(self, address: int, count: int) -> NDArray[np.uint32]:
        """Read `count` words from word `address` on."""

    def write_materials(self, colours: NDArray[np.uint8], mirrors: NDArray[np.bool_], /) -> None:
        """Write the material table: uint8, shape (256, 3), sRGB, and bool, shape (256,). Holds the device."""

    def select_scene(self, root: int, depth: int) -> None:
        """Show the octree of `depth` levels whose root is word `root` from the next frame on. Holds the device."""

    def apply_patch(self, patch: Patch, depth: int) -> None:
        """Show what an edit changed from the next frame on; frames of older roots may be drawn meanwhile.

        Writes the blocks of the patch, reads them back, writes the word of its root, and selects this root. If that
        fails, frames still show the octree before.

        Raises
        ------
        DeviceError
            A word was not kept.
        """

    def frame(self, view: View, seconds: float = math.inf, drop: FrameDrop | None = None) -> Frame:
        """Render one frame of `view`, and return it when it is complete.

        Raises
        ------
        TooSlow
            The frame took longer than `seconds`.
        FrameDropped
            `drop` was requested before the frame was complete.
        """

    def stop(self) -> None:
        """End the frame in progress; :meth:`frame` fails from now on.

        It may be called from any thread while another call runs.
        """

    def close(self) -> None:
        """Release the device; nothing is called afterwards."""
