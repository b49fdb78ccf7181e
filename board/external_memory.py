"""The octree of a core whose memory is external: a contiguous buffer in the processor's memory."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

WORDS_BEFORE = 7
"""Words of a buffer before word 0 of the octree, which is the last of a line: so blocks are lines."""

_MOST_WORDS = 8 + (8 << 24)  # what the largest core can address
_FEWEST_WORDS = 1 << 15  # as many as a block RAM holds


class ExternalMemory:
    """The words of the octree; :class:`~.register_device.Memory` documents the methods.

    The core does not see the processor's caches: what is written is flushed at once, and what is read comes from the
    memory itself.

    Parameters
    ----------
    buffer
        An array of ``pynq.allocate``: uint32, shape (N,), which begins at a multiple of 32 bytes.

    Attributes
    ----------
    base
        What the register ``memory_base`` must hold: the byte address of `buffer` on the core's bus.
    """

    def __init__(self, buffer: Any) -> None:  # noqa: ANN401 - pynq is there on boards alone
        self.base = int(buffer.physical_address)
        self._buffer = buffer

    def __len__(self) -> int:
        """Give the number of words."""
        return len(self._buffer) - WORDS_BEFORE

    def __getitem__(self, words: slice) -> NDArray[np.uint32]:
        """Read words."""
        part = self._part(words)
        # Lines of the processor's caches that reach beyond the part hold nothing that is not in the memory.
        part.invalidate()
        return np.array(part, dtype=np.uint32)

    def __setitem__(self, words: slice, values: NDArray[np.uint32]) -> None:
        """Write words."""
        part = self._part(words)
        part[:] = values
        part.flush()

    def close(self) -> None:
        """Free the buffer."""
        self._buffer.freebuffer()

    def _part(self, words: slice) -> Any:  # noqa: ANN401
        start, stop, _ = words.indices(len(self))
        return self._buffer[start + WORDS_BEFORE : stop + WORDS_BEFORE]


def allocate_external(allocate: Callable[..., Any], frame_size: tuple[int, int]) -> ExternalMemory:
    """Allocate most of the contiguous memory that is free; a frame still fits beside it.

    Parameters
    ----------
    allocate
        ``pynq.allocate``.
    frame_size
        Columns and rows of the largest frame.

    Raises
    ------
    DeviceError
        Too little is free, or it is beyond the 4 GiB that the core's bus reaches.
    """
    columns, rows = frame_size
    frame = _try_to_allocate(allocate, (rows, columns, 3), np.uint8)
    memory = None
    words = _MOST_WORDS
    while frame is not None and memory is None and words >= _FEWEST_WORDS:
        memory = _try_to_allocate(allocate, (words,), np.uint32)
        words = words * 3 // 4
    if frame is not None:
        frame.freebuffer()
    if memory is None:
        raise DeviceError(
            "too little contiguous memory is free for an octree and a frame; end other programs that use "
            "pynq.allocate, or give Linux more of it (cma= in its boot arguments)"
        )
    if memory.physical_address + memory.nbytes > 1 << 32:
        memory.freebuffer()
        raise DeviceError(
            f"pynq.allocate gave memory at 0x{memory.physical_address:X}, and the ray tracer reaches 4 GiB; "
            "have Linux reserve contiguous memory below that"
        )
    return ExternalMemory(memory)


def _try_to_allocate(allocate: Callable[..., Any], shape: tuple[int, ...], dtype: type) -> Any:  # noqa: ANN401
    try:
        return allocate(shape=shape, dtype=dtype)
    except (RuntimeError, MemoryError, OSError):  # which one depends on the version of pynq
        return None
