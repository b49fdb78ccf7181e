"""An upload in progress: files that arrive in chunks, and are kept in a temporary folder."""

from __future__ import annotations

import zlib
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.board.errors import Refused
from voxrt.serve.temporary_folder import storing, temporary_folder

if TYPE_CHECKING:
    from typing import BinaryIO

    from voxrt.serve.packets import Chunk
    from voxrt.serve.requests import StartUpload

UPLOAD_LIMIT = 1 << 28
"""Bytes that the files of an upload may have together."""

_BYTES_PER_WORD = 16
_MANIFEST_BYTES = 1 << 20


def memory_bytes(capacity: int) -> int:
    """Return how many bytes the files of an octree memory of `capacity` words may have.

    A word takes 4 bytes in a blob, 9 or 10 in a .mem, and more where comments are written between them.
    """
    return min(UPLOAD_LIMIT, _BYTES_PER_WORD * capacity + _MANIFEST_BYTES)


class Upload:
    """The files of one upload, as far as they have arrived; a context manager's end or :meth:`close` removes them.

    Parameters
    ----------
    number
        The number of the upload; every chunk repeats it.
    announced
        The files that were announced.

    Raises
    ------
    Refused
        The temporary folder cannot be written.
    """

    def __init__(self, number: int, announced: StartUpload) -> None:
        self.number = number
        self.announced = announced
        self.size = sum(file.size for file in announced.files)
        self.received = 0
        self._folder = temporary_folder()
        self._waiting = list(announced.files)
        self._file: BinaryIO | None = None
        self._left = self._crc32 = 0

    @property
    def complete(self) -> bool:
        """Whether all bytes have arrived."""
        return self.received == self.size

    @property
    def paths(self) -> list[Path]:
        """The files, in the order of their announcement."""
        return [Path(self._folder.name, file.name) for file in self.announced.files]

    def add(self, chunk: Chunk) -> None:
        """Add the next chunk.

        Raises
        ------
        Refused
            The chunk belongs to another upload, is not the next one, or is longer than announced. The CRC-32 of a file
            is not the announced one. The temporary folder is full.
        """
        if chunk.upload != self.number:
            raise Refused(f"a chunk of upload {chunk.upload} came during upload {self.number}; upload again")
        if chunk.offset != self.received or chunk.offset + len(chunk.data) > self.size:
            raise Refused(
                f"a chunk of {len(chunk.data)} bytes at byte {chunk.offset} does not continue the {self.received} of "
                f"{self.size} bytes that have arrived; upload again"
            )
        with storing():
            self._write(memoryview(chunk.data))

    def close(self) -> None:
        """Remove the files."""
        if self._file is not None:
            self._file.close()
            self._file = None
        self._folder.cleanup()

    def _write(self, data: memoryview) -> None:
        while len(data):
            if self._file is None:
                path = self.paths[-len(self._waiting)]
                self._left, self._crc32 = self._waiting[0].size, 0
                self._file = path.open("xb", buffering=0)
            part = data[: self._left]
            self._file.write(part)
            self._crc32 = zlib.crc32(part, self._crc32)
            self._left -= len(part)
            self.received += len(part)
            data = data[len(part) :]
            if self._left == 0:
                self._file.close()
                self._file = None
                announced = self._waiting.pop(0)
                if announced.crc32 != self._crc32:
                    raise Refused(f"{announced.name} was damaged in transit (CRC-32); upload again")
