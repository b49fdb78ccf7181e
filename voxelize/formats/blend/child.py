"""The process that reads one Blender file: ``python -m voxrt.voxelize.formats.blend.child PATH REQUEST``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.formats.reader_process.child import serve_reader
from voxrt.voxelize.formats.reader_process.limits import Request

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.voxelize.formats.reader_process.limits import Allowance
    from voxrt.voxelize.scene import Scene


def _read(path: Path, request: Request, allowance: Allowance) -> Scene:
    from voxrt.voxelize.formats.blend.file import read_file  # noqa: PLC0415 - within the limits

    return read_file(
        path, allowance, time=request.time, allow_outside=request.allow_outside, opaque_from=request.opaque_from
    )


if __name__ == "__main__":
    serve_reader(Request, _read)
