"""The ray tracer on a PYNQ board: overlay, MMIO and VDMA for :class:`~.register_device.RegisterDevice`.

It follows PYNQ's documentation (``pynq.Overlay``, ``pynq.MMIO``, ``pynq.allocate``). The tests run it against a fake of
these classes with the verilated core inside. It has not run on a board.
"""

from __future__ import annotations

import time
from importlib import import_module
from typing import Any

from .errors import DeviceError
from .external_memory import allocate_external
from .register_device import RegisterDevice
from .vdma import VdmaVideo

PARTS = ("core", "memory", "vdma")
"""Names of the parts in the block design, rtl/vivado/build.tcl. `memory` is absent where octrees are in the DRAM."""

_PAUSE_SECONDS = 0.0005


def open_pynq(bitstream: str) -> RegisterDevice:
    """Load a bitstream (``.bit``, its ``.hwh`` beside it) and open the ray tracer in it.

    Raises
    ------
    DeviceError
        The machine is no PYNQ board, the bitstream is not the ray tracer's, or its octree is in the processor's memory,
        of which too little is free.
    """
    try:
        pynq: Any = import_module("pynq")
    except ImportError as error:
        raise DeviceError(f"this machine has no package pynq ({error}); run it on the board") from error
    try:
        overlay = pynq.Overlay(bitstream)
        parts = {**overlay.ip_dict, **overlay.mem_dict}
        found = {
            name: pynq.MMIO(parts[name]["phys_addr"], parts[name]["addr_range"]) for name in PARTS if name in parts
        }
        core, memory, vdma = found["core"], found.get("memory"), found["vdma"]
    except (OSError, RuntimeError, KeyError, AttributeError) as error:
        raise DeviceError(
            f"{bitstream}: cannot be opened as the ray tracer's bitstream ({error!r}); build it with rtl/vivado"
        ) from error
    video = VdmaVideo(vdma, pynq.allocate, _pause)
    words = memory.array if memory is not None else allocate_external(pynq.allocate, video.size)
    return RegisterDevice("PYNQ", core, words, video, _pause)


def _pause() -> None:
    time.sleep(_PAUSE_SECONDS)
