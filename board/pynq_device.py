"""The ray tracer on a PYNQ board: overlay, MMIO and VDMA behind :class:`~.register_device.RegisterDevice`.

Written from PYNQ's documentation (``pynq.Overlay``, ``pynq.MMIO``, ``pynq.lib.video.AxiVDMA``) and exercised against a
stand-in; it has not run on a board.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import DeviceError
from .register_device import RegisterDevice

if TYPE_CHECKING:
    from numpy.typing import NDArray

CORE = "pixel_generator_0"
MEMORY = "axi_bram_ctrl_0"
VDMA = "axi_vdma_0"
"""What the block design calls its parts."""


def open_pynq(bitstream: str) -> RegisterDevice:
    """Load a bitstream (``.bit``, its ``.hwh`` beside it) and open the ray tracer in it.

    Raises
    ------
    DeviceError
        This is no PYNQ board, or the bitstream is not this ray tracer's.
    """
    try:
        pynq: Any = import_module("pynq")
        video: Any = import_module("pynq.lib.video")
    except ImportError as error:
        raise DeviceError(f"this machine has no PYNQ ({error}); run it on the board") from error
    try:
        overlay = pynq.Overlay(bitstream)
        parts = {**overlay.ip_dict, **overlay.mem_dict}
        registers, memory = (pynq.MMIO(parts[name]["phys_addr"], parts[name]["addr_range"]) for name in (CORE, MEMORY))
        channel = getattr(overlay, VDMA).readchannel
    except (OSError, RuntimeError, KeyError, AttributeError) as error:
        raise DeviceError(f"{bitstream}: cannot be opened as the ray tracer's bitstream ({error!r})") from error
    return RegisterDevice("PYNQ", registers, memory.array, _VdmaVideo(channel, video.VideoMode))


class _VdmaVideo:
    """The write channel of the VDMA: frames from the stream into memory."""

    def __init__(self, channel: Any, video_mode: Any) -> None:  # noqa: ANN401 - PYNQ has no types
        self._channel = channel
        self._video_mode = video_mode
        self._size: tuple[int, int] | None = None

    def expect(self, size: tuple[int, int]) -> None:
        if size == self._size:
            return
        if self._size is not None:
            self._channel.stop()
        self._channel.mode = self._video_mode(*size, 24)
        self._channel.start()
        self._size = size

    def take(self) -> NDArray[np.uint8]:
        frame = self._channel.readframe()
        colour = np.array(frame, dtype=np.uint8)
        frame.freebuffer()
        return colour
