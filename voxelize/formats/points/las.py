"""LAS files, and LAZ, its compressed form, by laspy."""

from __future__ import annotations

import io
import struct
import subprocess
import sys
import tempfile
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import read_asset
from voxrt.voxelize.formats.points.cloud_scene import cloud_scene
from voxrt.voxelize.formats.scene_frame import scene_transform
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from voxrt.voxelize.scene import Scene

_CHUNK = 1 << 25  # bytes of points that are read at once
_LARGEST_BYTE = 255
_AGAIN = "copy or export it again"

# Bytes of a header of LAS 1.0 to 1.4, and of the records before and behind the points.
_HEADER, _RECORD, _LATE_RECORD = 227, 54, 60
_LATE_HEADER, _LATE_VERSION = 375, 4
_KIND, _COMPRESSED = 104, 0x80  # where the kind of points is, and its bit for LAZ

_SECONDS = 600
_FREE_BYTES, _MOST_TIMES = 64 << 20, 256  # a LAZ file unpacks to so many bytes, and so many times its size, at most
_UNPACK = """
import resource, sys, laspy
most = int(sys.argv[3])
for kind, limit in (("CORE", 0), ("FSIZE", most), ("DATA", (1 << 30) + most)):
    kind = getattr(resource, "RLIMIT_" + kind)
    resource.setrlimit(kind, (limit, resource.getrlimit(kind)[1]))
with laspy.open(sys.argv[1]) as source, laspy.open(sys.argv[2], "w", header=source.header) as target:
    for points in source.chunk_iterator(1 << 16):
        target.write_points(points)
"""


def load_las(path: str | Path, *, unit: float | None = None, points: int | None = None) -> Scene:
    """Read a LAS or LAZ file: the points that are not withheld, with their colours. z is up.

    Parameters
    ----------
    path
        The file.
    unit
        Metres per unit of the file; None for 1. The file's coordinate system is not read.
    points
        How many points make a voxel solid; None for 1.

    Returns
    -------
    Scene
        One object, of one point cloud.

    Raises
    ------
    AssetError
        The file cannot be read, has no points, or laspy is not installed.
    """
    path = Path(path)
    try:
        laspy = import_module("laspy")
    except ImportError:
        raise AssetError(path, "takes laspy, which is not installed", fix="pip install laspy lazrs") from None
    data = read_asset(path)
    if not _is_whole(data):
        raise AssetError(path, "is no LAS file, or ends before its records do", fix=_AGAIN)
    if data[_KIND] & _COMPRESSED:
        data = _unpacked(path, data)
        if not _is_whole(data):
            raise AssetError(path, "ends before its points do", fix=_AGAIN)
    places, colours = [np.empty((0, 3))], [np.empty((0, 3), np.uint16)]
    try:
        with laspy.open(io.BytesIO(data), closefd=False) as reader:
            has_colours = "red" in set(reader.header.point_format.dimension_names)
            for chunk in reader.chunk_iterator(max(1, _CHUNK // reader.header.point_format.size)):
                shown = np.asarray(chunk.withheld) == 0
                places.append(np.stack([np.asarray(axis)[shown] for axis in (chunk.x, chunk.y, chunk.z)], axis=1))
                if has_colours:
                    channels = (chunk.red, chunk.green, chunk.blue)
                    colours.append(np.stack([np.asarray(one, np.uint16)[shown] for one in channels], axis=1))
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001 - it raises whatever its parsers do
        raise AssetError(path, f"laspy cannot read it ({type(error).__name__})", fix=_AGAIN) from None
    positions, stored = np.concatenate(places), np.concatenate(colours)
    # The format has bytes times 256; many programs write bytes.
    shift = 0 if stored.max(initial=0) <= _LARGEST_BYTE else 8
    rgb = (stored >> shift).astype(np.uint8) if has_colours and stored.any() else None
    return cloud_scene(path, positions, rgb, scene_transform("z", unit), least=points, log=WarningLog())


def _unpacked(path: Path, data: bytes) -> bytes:
    """Return a LAZ file as a LAS file, made by a process of its own: damaged files end lazrs in any way."""
    most = _FREE_BYTES + _MOST_TIMES * len(data)
    with tempfile.TemporaryDirectory(prefix="voxrt-laz-") as folder:
        made = Path(folder, "points.las")
        command = [sys.executable, "-P", "-c", _UNPACK, str(path.resolve()), str(made), str(most)]
        try:
            done = subprocess.run(command, capture_output=True, timeout=_SECONDS, check=False)  # noqa: S603
        except subprocess.TimeoutExpired:
            raise AssetError(path, f"takes more than {_SECONDS} seconds to unpack", fix=_AGAIN) from None
        if b"No module" in done.stderr or b"No LazBackend" in done.stderr:
            raise AssetError(path, "takes lazrs, which is not installed", fix="pip install lazrs")
        if done.returncode != 0:
            raise AssetError(path, "lazrs cannot unpack it", fix=_AGAIN)
        return made.read_bytes()


def _is_whole(data: bytes) -> bool:
    """Tell whether what a header counts fits a file: laspy makes room for as much as it says."""
    if len(data) < _HEADER or not data.startswith(b"LASF"):
        return False
    header, points, records = struct.unpack_from("<HII", data, 94)
    kind, size, count = struct.unpack_from("<BHI", data, _KIND)
    late, late_records = 0, 0
    if data[25] >= _LATE_VERSION:
        if len(data) < _LATE_HEADER:
            return False
        late, late_records, count = struct.unpack_from("<QIQ", data, 235)
    stored = 0 if kind & _COMPRESSED else size * count
    whole = header + _RECORD * records <= points <= points + stored <= len(data)
    return bool(whole and late + _LATE_RECORD * late_records <= len(data))
