"""Files that arrive in chunks."""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING

from ..board.errors import Refused

if TYPE_CHECKING:
    from .packets import Chunk
    from .requests import Upload

UPLOAD_LIMIT = 1 << 28
"""Bytes that the files of an upload may have together."""


class Receiving:
    """The files of one upload, growing as its chunks come.

    Memory grows with what has arrived, not with what was announced.

    Parameters
    ----------
    number
        The upload's number, which its chunks carry.
    upload
        What was announced.

    Raises
    ------
    Refused
        More bytes are announced than are taken.
    """

    def __init__(self, number: int, upload: Upload) -> None:
        self.number = number
        self.upload = upload
        self.size = sum(file.size for file in upload.files)
        if self.size > UPLOAD_LIMIT:
            raise Refused(f"an upload of {self.size} bytes is more than the {UPLOAD_LIMIT} that are taken")
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
        """Take the next chunk.

        Raises
        ------
        Refused
            It is of another upload, not the next one, or more than was announced.
        """
        if chunk.upload != self.number:
            raise Refused(f"a chunk of upload {chunk.upload} came while upload {self.number} is under way")
        if chunk.offset != self.received or chunk.offset + len(chunk.data) > self.size:
            raise Refused(
                f"a chunk of {len(chunk.data)} bytes at byte {chunk.offset} does not continue the {self.received} of "
                f"{self.size} bytes that have come; upload again"
            )
        self._data += chunk.data

    def files(self) -> dict[str, bytes]:
        """Give the complete files by name.

        Raises
        ------
        Refused
            A file's CRC-32 is not the announced one, or two have the same name.
        """
        files: dict[str, bytes] = {}
        start = 0
        for file in self.upload.files:
            data = bytes(self._data[start : start + file.size])
            start += file.size
            if zlib.crc32(data) != file.crc32:
                raise Refused(f"{file.name} was damaged on its way (CRC-32); upload again")
            if file.name in files:
                raise Refused(f"two files are called {file.name}; give each a name of its own")
            files[file.name] = data
        return files
