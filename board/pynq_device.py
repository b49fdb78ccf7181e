"""The ray tracer on a PYNQ board: overlay, MMIO and VDMA for :class:`~.register_device.RegisterDevice`.

It follows PYNQ's documentation (``pynq.Overlay``, ``pynq.MMIO``, ``pynq.allocate``). The tests run it against a fake of
these classes with the verilated core inside. It has not run on a board.
"""

from __future__ import annotations

import time
from importlib import import_module
from typing import Any

from .errors import DeviceError
from .register_device import RegisterDevice
from .vdma import VdmaVideo

PARTS = ("core", "memory", "vdma")
"""Names of the parts in the block design, rtl/vivado/build.tcl."""

_PAUSE_SECONDS = 0.0005


def open_pynq(bitstream: str) -> RegisterDevice:
    """Load a bitstream (``.bit``, its ``.hwh`` beside it) and open the ray tracer in it.

    Raises
    ------
    DeviceError
        The machine is no PYNQ board, or the bitstream is not the ray tracer's.
    """
    try:
        pynq: Any = import_module("pynq")
    except ImportError as error:
        raise DeviceError(f"this machine has no package pynq ({error}); run it on the board") from error
    try:
        overlay = pynq.Overlay(bitstream)
        parts = {**overlay.ip_dict, **overlay.mem_dict}
        registers, memory, vdma = (pynq.MMIO(parts[name]["phys_addr"], parts[name]["addr_range"]) for name in PARTS)
    except (OSError, RuntimeError, KeyError, AttributeError) as error:
        raise DeviceError(
            f"{bitstream}: cannot be opened as the ray tracer's bitstream ({error!r}); build it with rtl/vivado"
        ) from error
    return RegisterDevice("PYNQ", registers, memory.array, VdmaVideo(vdma, pynq.allocate, _pause), _pause)


def _pause() -> None:
    time.sleep(_PAUSE_SECONDS)
