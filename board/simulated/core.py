"""The verilated core as a device: the driver of the boards uses its registers, memory port and video stream."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from voxrt.board.errors import DeviceError
from voxrt.board.external_memory import WORDS_BEFORE, ExternalMemory
from voxrt.board.register_device import RegisterDevice
from voxrt.sim.errors import NoSuchConfigurationError
from voxrt.sim.verilated import import_verilated

if TYPE_CHECKING:
    from numpy.typing import NDArray

_FRAME_LIMIT = 4095
_PAUSE_CLOCKS = 1 << 15
_PIXEL_SECONDS = 1e-3


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
        raise NoSuchConfigurationError(config, module.CORES, complete=module.COMPLETE)
    core = module.Core(config)
    pause = partial(core.run, _PAUSE_CLOCKS)
    memory = _external_memory(core) if core.cached else _MemoryPort(core)
    return RegisterDevice(
        f"simulated ray tracer {config}", core, memory, _Stream(core), pause, pixel_seconds=_PIXEL_SECONDS
    )


class _Buffer(np.ndarray):
    """What :class:`ExternalMemory` needs of a buffer; there are no caches of a processor."""

    physical_address = 0x10000000

    def flush(self) -> None: ...

    def invalidate(self) -> None: ...

    def freebuffer(self) -> None: ...


def _external_memory(core: Any) -> ExternalMemory:  # noqa: ANN401 - the native module may be absent
    # Pages that nothing was written to cost no memory.
    buffer = np.zeros(WORDS_BEFORE + core.memory_words, dtype=np.uint32).view(_Buffer)
    core.map_external(buffer.physical_address, buffer)
    return ExternalMemory(buffer)


class _MemoryPort:
    """The words of the scene memory, read and written through the memory port."""

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
