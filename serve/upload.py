"""An upload in progress: files that arrive in chunks."""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING

from ..board.errors import Refused

if TYPE_CHECKING:
    from .packets import Chunk
    from .requests import StartUpload

UPLOAD_LIMIT = 1 << 28
"""Bytes that the files of an upload may have together."""


class Upload:
    """The files of one upload and the bytes that have arrived.

    It allocates memory for bytes that have arrived, not for those that were announced.

    Parameters
    ----------
    number
        The number of the upload; every chunk repeats it.
    announced
        The files that were announced.

    Raises
    ------
    Refused
        The files are larger than :data:`UPLOAD_LIMIT` together.
    """

    def __init__(self, number: int, announced: StartUpload) -> None:
        self.number = number
        self.announced = announced
        self.size = sum(file.size for file in announced.files)
        if self.size > UPLOAD_LIMIT:
            raise Refused(
                f"an upload of {self.size} bytes is more than the limit of {UPLOAD_LIMIT}; make the files smaller"
            )
        self._data = bytearray()

    @property
    def received(self) -> int:
        """Bytes that have arrived."""
        return len(self._data)

    @property
    def complete(self) -> bool:
        """Whether all bytes have arrived."""
        return self.received == self.size

    def add(self, chunk: Chunk) -> None:
        """Add the next chunk.

        Raises
        ------
        Refused
            The chunk belongs to another upload, is not the next one, or is longer than announced.
        """
        if chunk.upload != self.number:
            raise Refused(f"a chunk of upload {chunk.upload} came during upload {self.number}; upload again")
        if chunk.offset != self.received or chunk.offset + len(chunk.data) > self.size:
            raise Refused(
                f"a chunk of {len(chunk.data)} bytes at byte {chunk.offset} does not continue the {self.received} of "
                f"{self.size} bytes that have arrived; upload again"
            )
        self._data += chunk.data

    def files(self) -> dict[str, bytes]:
        """Return the complete files by name.

        Raises
        ------
        Refused
            The CRC-32 of a file is not the announced one, or two files have the same name.
        """
        files: dict[str, bytes] = {}
        start = 0
        for file in self.announced.files:
            data = bytes(self._data[start : start + file.size])
            start += file.size
            if zlib.crc32(data) != file.crc32:
                raise Refused(f"{file.name} was damaged in transit (CRC-32); upload again")
            if file.name in files:
                raise Refused(f"two files have the name {file.name}; rename one of them")
            files[file.name] = data
        return files
