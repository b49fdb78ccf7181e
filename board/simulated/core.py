"""The verilated core as a device: the driver of the boards uses its registers, memory port and video stream."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.board.errors import DeviceError
from voxrt.board.register_device import RegisterDevice
from voxrt.sim.errors import NoSuchConfigurationError
from voxrt.sim.verilated import import_verilated

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from voxrt.board.register_writes import Writes

_FRAME_LIMIT = 4095
_PAUSE_CLOCKS = 1 << 15
_PIXEL_SECONDS = 1e-3
_WORDS_BEFORE = 7


def open_rtl(config: str = "lit") -> RegisterDevice:
    """Open a simulated core with the configuration `config`.

    Raises
    ------
    NoSuchConfigurationError
        The installation has no core with this configuration.
    SimulatorError
        The verilated core is not in this installation.
    """
    module = import_verilated("use --device model")
    if config not in module.CORES:
        raise NoSuchConfigurationError(config, module.CORES)
    core = module.Core(config)
    pause = partial(core.run, _PAUSE_CLOCKS)
    memory = _ExternalMemory(core) if core.cached else _MemoryPort(core)
    return RegisterDevice(
        f"simulated ray tracer {config}", _Registers(core), memory, _Stream(core), pause, pixel_seconds=_PIXEL_SECONDS
    )


class _Registers:
    def __init__(self, core: Any) -> None:  # noqa: ANN401 - the native module may be absent
        self._core = core

    def read(self, offsets: Sequence[int]) -> Sequence[int]:
        return [int(self._core.read(offset)) for offset in offsets]

    def write(self, writes: Writes) -> None:
        for start, values in writes:
            for place, value in enumerate(values):
                self._core.write(start + 4 * place, value)


class _ExternalMemory:
    """The words of an octree in external memory: word 0 is the last of a line, so blocks are lines."""

    base = 0x10000000

    def __init__(self, core: Any) -> None:  # noqa: ANN401
        # Pages that nothing was written to cost no memory.
        self._words = np.zeros(_WORDS_BEFORE + core.memory_words, dtype=np.uint32)
        core.map_external(self.base, self._words)

    def __len__(self) -> int:
        return len(self._words) - _WORDS_BEFORE

    def __getitem__(self, words: slice) -> NDArray[np.uint32]:
        return self._words[_WORDS_BEFORE + words.start : _WORDS_BEFORE + words.stop].copy()

    def __setitem__(self, words: slice, values: NDArray[np.uint32]) -> None:
        self._words[_WORDS_BEFORE + words.start : _WORDS_BEFORE + words.stop] = values


class _MemoryPort:
    """The words of the scene memory, read and written through the memory port."""

    base = None

    def __init__(self, core: Any) -> None:  # noqa: ANN401 - the native module may be absent
        self._core = core

    def __len__(self) -> int:
        return int(self._core.memory_words)

    def __getitem__(self, words: slice) -> NDArray[np.uint32]:
        start, stop, _ = words.indices(len(self))
        found: NDArray[np.uint32] = self._core.read_memory(start, stop - start)
        return found

    def __setitem__(self, words: slice, values: NDArray[np.uint32]) -> None:
        self._core.write_memory(words.start, values)


class _Stream:
    """The receiver of the video stream; it never stalls the core."""

    size = (_FRAME_LIMIT, _FRAME_LIMIT)
    width_step = 1

    def __init__(self, core: Any) -> None:  # noqa: ANN401
        self._core = core

    def expect(self, size: tuple[int, int]) -> None:
        self._core.expect(*size)

    def take(self) -> NDArray[np.uint8]:
        self._core.run(_PAUSE_CLOCKS)
        try:
            frame: NDArray[np.uint8] = self._core.frame()
        except RuntimeError as error:
            raise DeviceError(f"the simulated ray tracer: {error}") from error
        return frame

    def close(self) -> None:
        """Nothing to stop."""
