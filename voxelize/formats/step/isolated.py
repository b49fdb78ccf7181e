"""Loading STEP files, each in a process of its own: OpenCASCADE is a large C++ library that trusts its files."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.formats.reader_process.limits import Limits, Request
from voxrt.voxelize.formats.reader_process.parent import Reader, read_apart, reader_module

if TYPE_CHECKING:
    from voxrt.voxelize.scene import Scene

_SECONDS = 300.0  # of the processor: curved faces take long


def load_step(path: str | Path, *, opaque_from: float = OPAQUE_FROM, limits: Limits | None = None) -> Scene:
    """Read a STEP file: its solids as triangles, by OpenCASCADE, in a process of its own.

    `limits`: what reading a small file may take; None for the limits of this machine. AssetError where it cannot be
    read, exceeds the limits, or the extra ``cad`` is not installed.
    """
    path = Path(path)
    if find_spec("cascadio") is None:
        raise AssetError(path, "takes cascadio, which is not installed", fix="pip install cascadio")
    limits = replace(Limits.of_this_machine(), seconds=_SECONDS) if limits is None else limits
    reader = Reader(
        "OpenCASCADE", reader_module("voxrt.voxelize.formats.step.child"), too_slow="repair it, or export it as glTF"
    )
    return read_apart(reader, path, Request(limits=limits, time=None, allow_outside=False, opaque_from=opaque_from))
