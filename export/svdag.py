"""``.svdag`` files: which voxels of a memory are solid, as a sparse voxel DAG. The manual defines them."""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np

from voxrt.export.atomic import write_atomically
from voxrt.export.palette import default_materials
from voxrt.export.word_file import read_bytes
from voxrt.octree import OccupancyDag, Rom, RomError, occupancy_dag
from voxrt.voxelize import SceneWarning

if TYPE_CHECKING:
    from pathlib import Path

SVDAG_SUFFIX = ".svdag"

_HEADER = struct.Struct("<8s4IQ")  # magic, version, depth, address of the root, CRC-32 of the words, words
_MAGIC = b"VOXSVDAG"
_VERSION = 1
_NO_ROOT = 0xFFFFFFFF


def write_svdag(path: Path, rom: Rom) -> None:
    """Write which voxels of a memory are solid as a ``.svdag`` file. Equal voxels give equal bytes.

    The file has no materials and no place in the scene.

    Raises
    ------
    DoesNotFitError
        The memory has depth 1, or the graph more than 2**32 words.
    OSError
        The file cannot be written.

    Examples
    --------
    >>> import voxrt
    >>> from pathlib import Path
    >>> write_svdag(Path("house.svdag"), voxrt.build("examples/house.obj", depth=4).rom)
    """
    graph = occupancy_dag(rom.octree)
    words = graph.words.astype("<u4", copy=False).tobytes()
    root = 0 if words else _NO_ROOT
    header = _HEADER.pack(_MAGIC, _VERSION, graph.depth, root, zlib.crc32(words), len(graph.words))
    write_atomically(path, [header, words])


def read_svdag(path: Path) -> tuple[Rom, tuple[SceneWarning, ...]]:
    """Read a ``.svdag`` file as a memory of one material, with a warning that says so.

    Raises
    ------
    RomError
        The file cannot be read or is damaged.

    Examples
    --------
    >>> import voxrt
    >>> from pathlib import Path
    >>> write_svdag(Path("house.svdag"), voxrt.build("examples/house.obj", depth=4).rom)
    >>> rom, warnings = read_svdag(Path("house.svdag"))
    >>> rom, warnings[0].kind
    (<Rom 'house': depth 4, 449 words, 1 material>, 'assumed-palette')
    """
    data = read_bytes(path)
    if not data.startswith(_MAGIC):
        raise RomError(f"{path}: does not start with {_MAGIC.decode()}; name a .svdag file")
    if len(data) < _HEADER.size:
        raise RomError(f"{path}: ends within its header; the file is cut short")
    _, version, depth, root, crc32, count = _HEADER.unpack_from(data)
    if version != _VERSION:
        raise RomError(f"{path}: .svdag version {version} is not known to this version ({_VERSION}); upgrade voxrt")
    body = memoryview(data)[_HEADER.size :]
    if len(body) != 4 * count:
        raise RomError(f"{path}: the header says {count} words, and {len(body)} bytes follow; the file is damaged")
    if zlib.crc32(body) != crc32:
        raise RomError(f"{path}: the CRC-32 of the words is not the one that the header names; the file is damaged")
    if root != (0 if count else _NO_ROOT):
        raise RomError(f"{path}: the root is at word {root}, and must be at 0; the file is damaged")
    try:
        tree = OccupancyDag(depth, np.frombuffer(body, "<u4").astype(np.uint32, copy=False)).octree()
    except RomError as error:
        raise RomError(f"{path}: {error}") from None
    warning = SceneWarning("assumed-palette", f"{path.name} has no materials; its solid voxels have one")
    return Rom(path.stem, tree, default_materials(1)), (warning,)
