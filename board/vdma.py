"""The AXI VDMA: it writes the video stream to a buffer in the processor's memory, one frame at a time.

Registers and their use are those of AMD's product guide PG020. PYNQ's own VDMA driver is not used. It is made for
endless video: it waits for four frames before it returns the first one, and it returns the last frame but one. The ray
tracer starts every frame by itself.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from .register_device import Registers

# S2MM, the channel from the stream into memory.
_CONTROL, _STATUS, _ROWS, _ROW_BYTES, _STRIDE, _FIRST_BUFFER = 0x30, 0x34, 0xA0, 0xA4, 0xA8, 0xAC
_BUFFERS = 3  # buffer addresses of the channel; all are set to the same buffer
_RUN, _RESET = 1 << 0, 1 << 2
_FRAME_DONE = 1 << 12
_ERRORS = {
    1 << 4: "an internal error",
    1 << 5: "an error of the memory",
    1 << 6: "an invalid address",
    1 << 7: "a frame that starts too early",
    1 << 8: "a line that ends too early",
    1 << 11: "a frame that starts too late",
    1 << 15: "a line that ends too late",
}
_SECONDS = 2.0


class VdmaVideo:
    """Frames from a VDMA; :class:`~.register_device.Video` documents the methods.

    Parameters
    ----------
    registers
        The registers of the VDMA.
    allocate
        ``pynq.allocate``: makes arrays that the VDMA can write.
    pause
        Called between two reads of the status register.
    """

    size = (1920, 1080)
    """A frame of this size fits into the contiguous memory of every board."""

    width_step = 8
    """The VDMA writes whole 64-bit words: a line of 3-byte pixels needs a multiple of 8 pixels."""

    def __init__(self, registers: Registers, allocate: Callable[..., Any], pause: Callable[[], None]) -> None:
        self._registers = registers
        self._allocate = allocate
        self._pause = pause
        self._buffer: Any = None
        self._expected = False

    def expect(self, size: tuple[int, int]) -> None:
        """Prepare for one frame; an earlier frame that is not complete is dropped."""
        columns, rows = size
        shape = rows, columns, 3
        if self._expected or self._buffer is None or self._buffer.shape != shape:
            self._reset()
            self._free()
            self._buffer = self._allocate(shape=shape, dtype=np.uint8)
            self._registers.write(_CONTROL, self._registers.read(_CONTROL) | _RUN)
            for buffer in range(_BUFFERS):
                self._registers.write(_FIRST_BUFFER + 4 * buffer, self._buffer.physical_address)
            self._registers.write(_STRIDE, 3 * columns)
            self._registers.write(_ROW_BYTES, 3 * columns)
            self._registers.write(_ROWS, rows)  # this starts the channel
        self._registers.write(_STATUS, _FRAME_DONE | sum(_ERRORS))  # writing 1 clears
        self._expected = True

    def take(self) -> NDArray[np.uint8]:
        """Wait until the frame is in memory, and return it."""
        status = self._until(_STATUS, lambda status: bool(status & (_FRAME_DONE | sum(_ERRORS))))
        errors = [problem for bit, problem in _ERRORS.items() if status & bit]
        if errors:
            raise DeviceError(f"the VDMA reports {' and '.join(errors)}; the frame was dropped, try again")
        self._expected = False
        self._buffer.invalidate()
        return np.array(self._buffer, dtype=np.uint8)

    def close(self) -> None:
        """Stop the channel and free its buffer."""
        self._reset()
        self._free()

    def _reset(self) -> None:
        self._registers.write(_CONTROL, _RESET)
        self._until(_CONTROL, lambda control: not control & _RESET)
        self._expected = False

    def _free(self) -> None:
        if self._buffer is not None:
            self._buffer.freebuffer()
            self._buffer = None

    def _until(self, register: int, holds: Callable[[int], bool]) -> int:
        end = time.monotonic() + _SECONDS
        while not holds(value := self._registers.read(register)):
            if time.monotonic() > end:
                raise DeviceError(f"the VDMA did not answer for {_SECONDS:.0f} s; check the block design")
            self._pause()
        return value
