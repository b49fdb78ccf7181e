"""The extension module of the verilated ray tracer, which some platforms are without."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from voxrt.sim.errors import SimulatorError


def import_verilated(instead: str) -> Any:  # noqa: ANN401 - the native module may be absent
    """Import ``voxrt.sim._rtl``; SimulatorError, which tells what to do `instead`, where it is not installed."""
    try:
        return import_module("voxrt.sim._rtl")
    except ImportError as error:
        raise SimulatorError(
            "this installation has no verilated ray tracer (it is built on Linux x86-64 and macOS arm64); " + instead
        ) from error
