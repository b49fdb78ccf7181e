"""The process that reads one USD file: ``python -m voxrt.voxelize.formats.usd.child PATH REQUEST``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.formats.reader_process.child import serve_reader
from voxrt.voxelize.formats.usd.request import UsdRequest

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.voxelize.formats.reader_process.limits import Allowance
    from voxrt.voxelize.scene import Scene


def _read(path: Path, request: UsdRequest, allowance: Allowance) -> Scene:
    from voxrt.voxelize.formats.usd.stage_scene import read_stage  # noqa: PLC0415 - within the limits

    return read_stage(
        path,
        allowance,
        variants=request.variants,
        time=request.time,
        allow_outside=request.allow_outside,
        opaque_from=request.opaque_from,
    )


if __name__ == "__main__":
    serve_reader(UsdRequest, _read)
