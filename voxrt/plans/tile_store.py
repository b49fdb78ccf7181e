"""The finished tiles of a build, in a folder beside its output, so that a build that was killed goes on from them.

A tile is the octree of a square of columns, as words of the whole world, and what the square has of each object. Its
file ends with its CRC-32. The folder has the key of the build: of what decides the voxels, and of the program. Tiles of
another key are removed, and no other files. A folder without such a key, or that is a link, is somebody else's.
"""

from __future__ import annotations

import os
import re
import struct
import zlib
from contextlib import suppress
from typing import TYPE_CHECKING, Self

import numpy as np
from msgspec import Struct

from voxrt.export.atomic import write_atomically
from voxrt.export.outputs import OutputError
from voxrt.octree import Assembly, DiskAssembly, Octree
from voxrt.voxelize import AssetError, DoesNotFitError
from voxrt.voxelize.block_voxelizer import TALLIES

try:
    import fcntl
except ImportError:  # no POSIX system: nobody tells whether another build uses the folder
    fcntl = None  # type: ignore[assignment]

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path
    from types import TracebackType

    from numpy.typing import NDArray

    from voxrt.voxelize import ColumnBlock

_HEADER = struct.Struct("<8s16sIIqq")  # magic, key, depth, 0, words, rows of tallies
_MAGIC = b"voxrtil2"
_CRC32 = struct.Struct("<I")
_KEY = re.compile(rb"(?P<key>[0-9a-f]{32}) (?P<side>[0-9]{1,6})\n")
_TEMPORARY = re.compile(r"\.(?:key|[0-9]+-[0-9]+\.tile)\.[0-9a-f]{8}\.tmp")  # as write_atomically names them
_TALLIES = 1 + TALLIES  # numbers per row: the object, and its tally
_BYTES_OF_BLOCK = 32
_FORGED = "a finished tile is not what its build writes; remove the folder of the tiles, NAME.tiles, and build again"


class Tile(Struct, frozen=True, eq=False):
    """A finished tile, or several that were joined.

    The octree is of the whole world, empty outside of the tile. The tallies are of the objects that it reaches: int64,
    shape (N, 7), the number of an object and its row of :meth:`voxrt.voxelize.BlockVoxelizer.voxelize`.
    """

    octree: Octree
    tallies: NDArray[np.int64]


def sparse_tallies(tallies: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the rows of objects with a tally: from shape (O, 6) to (N, 7).

    Examples
    --------
    >>> sparse_tallies(np.array([[0, 0, 0, 0, 0, 0], [7, 0, 0, 1, 1, 0]])).tolist()
    [[1, 7, 0, 0, 1, 1, 0]]
    """
    rows = np.flatnonzero(tallies.any(axis=1))
    return np.column_stack([rows, tallies[rows]]).astype(np.int64)


def sum_tallies(tallies: NDArray[np.int64], objects: int) -> NDArray[np.int64]:
    """Return the sum of rows of tallies by object: from shape (N, 7) to (O, 6).

    OutputError where an object is none of the scene's, or counts are negative: no build of the scene wrote the rows.

    Examples
    --------
    >>> sum_tallies(np.array([[1, 7, 0, 0, 1, 1, 0], [1, 2, 0, 0, 1, 1, 0]]), 2).tolist()
    [[0, 0, 0, 0, 0, 0], [9, 0, 0, 2, 2, 0]]
    """
    if tallies.size and (tallies.min() < 0 or tallies[:, 0].max() >= objects):
        raise OutputError(_FORGED)
    total = np.zeros((objects, _TALLIES - 1), np.int64)
    np.add.at(total, tallies[:, 0], tallies[:, 1:])
    return total


def write_tile(path: Path, key: str, tile: Tile) -> int:
    """Write a tile, whole or not at all, and return its bytes; OSError if the file cannot be written."""
    tallies = np.ascontiguousarray(tile.tallies, "<i8")
    words = np.ascontiguousarray(tile.octree.words, "<u4")
    header = _HEADER.pack(_MAGIC, bytes.fromhex(key), tile.octree.depth, 0, len(words), len(tallies))
    parts = [header, tallies.tobytes(), words.tobytes()]
    crc32 = 0
    for part in parts:
        crc32 = zlib.crc32(part, crc32)
    write_atomically(path, [*parts, _CRC32.pack(crc32)])
    return sum(map(len, parts)) + _CRC32.size


def read_tile(path: Path, key: str) -> Tile | None:
    """Read a tile; None where there is none, or it is damaged or of another build."""
    try:
        data = np.fromfile(path, np.uint8)
    except OSError:
        return None
    if len(data) < _HEADER.size + _CRC32.size:
        return None
    body, end = data[: -_CRC32.size], data[-_CRC32.size :]
    magic, own, depth, _, words, rows = _HEADER.unpack(body[: _HEADER.size].tobytes())
    if (magic, own.hex()) != (_MAGIC, key) or _CRC32.pack(zlib.crc32(body.data)) != end.tobytes():
        return None
    split = _HEADER.size + 8 * _TALLIES * rows
    if rows < 0 or words < 1 or len(body) != split + 4 * words:
        return None
    tallies = body[_HEADER.size : split].view("<i8").astype(np.int64).reshape(-1, _TALLIES)
    try:
        return Tile(Octree(depth, body[split:].view("<u4").astype(np.uint32, copy=False)), tallies)
    except ValueError:  # no octree
        return None


def add_tile(whole: Assembly | DiskAssembly, tile: Tile) -> None:
    """Join a tile to those before it; OutputError where it is not disjoint from them, or of another world."""
    try:
        whole.add(tile.octree)
    except ValueError:
        raise OutputError(_FORGED) from None


def tile_name(block: ColumnBlock) -> str:
    """Return the name of a tile.

    Examples
    --------
    >>> from voxrt.voxelize import ColumnBlock
    >>> tile_name(ColumnBlock(0, 4096, 4096))
    '0-4096'
    """
    return f"{block.x}-{block.y}"


class MemoryTiles:
    """Tiles for which there is no folder: they are joined in memory as they are made."""

    def __init__(self, depth: int) -> None:
        self._whole = Assembly(depth)

    def claim(self, _key: str, side: int) -> int:
        """Return `side`: no tile is there yet."""
        return side

    def read(self, _name: str) -> None:
        """Return None: no tile is there yet."""

    def write(self, _name: str, tile: Tile) -> None:
        """Join a tile to those before it."""
        self._whole.add(tile.octree)

    def join(self, _names: Iterable[str], _depth: int, _cache: int) -> Octree:
        """Return the octree of all tiles."""
        return self._whole.octree()


_locks: set[int] = set()
"""Descriptors of folders that this process has locked."""


def _forget_locks() -> None:
    """Leave the locks to the process that this one is a fork of: else they would outlive it."""
    for lock in _locks:
        os.close(lock)
    _locks.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget_locks)


class TileStore:
    """The folder of the tiles of one build, locked from :meth:`claim` to the end of the ``with`` block.

    The folder, ``NAME.tiles`` beside the output, goes when the block ends, or fails because the asset is unsound. It
    stays if the block is interrupted or fails otherwise. Whoever reads and writes tiles while another process has the
    folder locked gives the key of the build.
    """

    def __init__(self, folder: Path, key: str = "") -> None:
        self.folder, self.key = folder, key
        self._lock: int | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._lock is None:
            if kind is None:
                self._remove_forgotten()
            return
        self.words.unlink(missing_ok=True)  # the lock was taken: the folder is that of a build
        if kind is None or issubclass(kind, AssetError | DoesNotFitError):
            self._remove()
        else:
            for path in self._temporary_files():
                path.unlink(missing_ok=True)
        _locks.discard(self._lock)
        os.close(self._lock)
        self._lock = None

    def claim(self, key: str, side: int) -> int:
        """Make the folder, lock it, and remove the tiles of another key: 32 hexadecimal digits that tell builds apart.

        Returns the columns per side of the tiles that are there, if these take at most four times the memory; else
        `side`. OutputError if the folder cannot be made, is somebody else's, or another build uses it.
        """
        self.key = key
        try:
            if self.folder.is_symlink():
                raise self._refused("is a link to another folder")
            self.folder.mkdir(parents=True, exist_ok=True)
            lock = os.open(self.folder, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0))
        except OSError as error:
            raise self._refused(f"cannot be used: {error.strerror or error}") from error
        try:
            side = self._take(lock, side)
        except BaseException:
            os.close(lock)
            raise
        self._lock = lock
        _locks.add(lock)
        return side

    @property
    def words(self) -> Path:
        """Where the words of the whole octree go."""
        return self.folder / "words"

    def path(self, name: str) -> Path:
        """Return the file of a tile."""
        return self.folder / f"{name}.tile"

    def read(self, name: str) -> Tile | None:
        """Return a finished tile, or None."""
        return read_tile(self.path(name), self.key)

    def write(self, name: str, tile: Tile) -> None:
        """Keep a finished tile; OutputError if it cannot be written, most often because the disk is full."""
        try:
            write_tile(self.path(name), self.key, tile)
        except OSError as error:
            raise _unwritten(self.path(name), error) from error

    def missing(self, name: str) -> str:
        """Return what errors say of a tile that should be there."""
        return f"{self.path(name)}: is missing or damaged; build again, which makes it anew"

    def join(self, names: Iterable[str], depth: int, cache: int) -> Octree:
        """Join finished tiles to the octree of the world; OutputError if one is missing, or the disk is full.

        `cache` is the bytes of memory for blocks: these go to the disk, and the words to the file `words`. With 0 all
        are joined in memory.
        """
        try:
            whole: DiskAssembly | Assembly
            if cache:
                whole = DiskAssembly(depth, self.folder, cache=cache)
            else:
                names = tuple(names)
                sizes = (path.stat().st_size for path in map(self.path, names) if path.exists())
                whole = Assembly(depth, expected_blocks=min(sum(sizes) // _BYTES_OF_BLOCK, 1 << 28))
            for name in names:
                tile = self.read(name)
                if tile is None:
                    raise OutputError(self.missing(name))
                add_tile(whole, tile)
            return whole.octree() if isinstance(whole, Assembly) else whole.octree(self.words)
        except OSError as error:
            raise _unwritten(self.folder, error) from error

    def _take(self, lock: int, side: int) -> int:
        if fcntl is not None:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise self._refused("another build uses it") from None
        try:
            there = _KEY.fullmatch(_first_bytes(self._key_file, 64))
            if there and there["key"].decode() == self.key and int(there["side"]) <= 2 * side:
                return int(there["side"])
            if not there and any(self.folder.iterdir()):
                raise self._refused("has files that no build put there")
            for path in self._own_files():
                path.unlink(missing_ok=True)
            write_atomically(self._key_file, f"{self.key} {side}\n".encode())
        except OSError as error:
            raise self._refused(f"cannot be written: {error.strerror or error}") from error
        return side

    def _refused(self, why: str) -> OutputError:
        return OutputError(f"{self.folder}: {why}; name another output")

    def _remove(self) -> None:
        for path in self._own_files():
            path.unlink(missing_ok=True)
        with suppress(OSError):  # somebody else put a file there
            self.folder.rmdir()

    def _remove_forgotten(self) -> None:
        """Remove the tiles that a killed build left for an output which is complete now, made without them."""
        with suppress(OSError):
            lock = os.open(self.folder, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0))
            try:
                if fcntl is not None:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                if _KEY.fullmatch(_first_bytes(self._key_file, 64)):
                    self._remove()
            finally:
                os.close(lock)

    def _own_files(self) -> list[Path]:
        tiles = [path for path in self.folder.glob("*.tile") if _first_bytes(path, len(_MAGIC)) == _MAGIC]
        return [*tiles, *self._temporary_files(), self.words, self._key_file]

    def _temporary_files(self) -> list[Path]:
        return [path for path in self.folder.glob(".*.tmp") if _TEMPORARY.fullmatch(path.name)]

    @property
    def _key_file(self) -> Path:
        return self.folder / "key"


def _first_bytes(path: Path, count: int) -> bytes:
    """Return the first bytes of a regular file, and none of anything else."""
    if path.is_symlink() or not path.is_file():
        return b""
    with path.open("rb") as file:
        return file.read(count)


def _unwritten(path: Path, error: OSError) -> OutputError:
    return OutputError(
        f"{path}: cannot be written: {error.strerror or error}; finished tiles stay, and the same build goes on from "
        "them"
    )
