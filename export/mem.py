"""``.mem`` files: memory words as text for ``$readmemh``.

Written: one word per line, eight upper-case hex digits, a newline after every word, the last included. Read: all that
``$readmemh`` takes (IEEE 1800-2017, 21.4) and an octree memory can mean: any white space between words, ``//`` and
``/* */`` comments, underscores, ``@`` addresses where they name the next word; the last word with or without newline.
"""

from __future__ import annotations

import re
import zlib
from typing import TYPE_CHECKING

import numpy as np

from voxrt.export.atomic import write_atomically
from voxrt.export.word_file import WordFile, mem_pieces, read_bytes
from voxrt.octree import RomError, _native

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

_COMMENT = re.compile(rb"//[^\n]*|/\*.*?\*/", re.DOTALL)
_WORD = re.compile(rb"[0-9A-Fa-f_]+")


def write_mem(path: Path, words: NDArray[np.uint32]) -> None:
    """Write words as a ``.mem`` file. An interruption leaves the old file or the new one.

    Parameters
    ----------
    path
        The file.
    words
        uint32, shape (N,), in the dialect of their reader: :func:`voxrt.octree.encode`.

    Raises
    ------
    OSError
        The file cannot be written.

    Examples
    --------
    >>> from pathlib import Path
    >>> from voxrt.octree import from_points
    >>> write_mem(Path("dot.mem"), from_points([[1, 2, 3]], [7], depth=2).words)
    """
    write_atomically(path, mem_pieces(words))


def read_mem(path: Path) -> WordFile:
    """Read a ``.mem`` file; what the words mean is for :func:`voxrt.octree.decode` to say.

    Raises
    ------
    RomError
        The file cannot be read or holds something that is no word. The message names the line.

    Examples
    --------
    >>> from pathlib import Path
    >>> from voxrt.octree import from_points
    >>> write_mem(Path("dot.mem"), from_points([[1, 2, 3]], [7], depth=2).words)
    >>> len(read_mem(Path("dot.mem")).words)
    17
    """
    data = read_bytes(path)
    crc32 = zlib.crc32(data)
    words = _native.read_mem_text(data)  # None where the file is not laid out as written here
    if words is not None:
        return WordFile(words, np.arange(1, len(words) + 1), crc32)
    return WordFile(*_parse(path, data), crc32)


def _parse(path: Path, data: bytes) -> tuple[NDArray[np.uint32], NDArray[np.int64]]:
    words: list[int] = []
    lines: list[int] = []
    text = _COMMENT.sub(lambda comment: b"\n" * comment[0].count(b"\n") or b" ", data)
    for number, line in enumerate(text.split(b"\n"), start=1):
        for token in line.split():
            if token.startswith(b"@"):
                _check_address(path, number, token, len(words))
                continue
            digits = token.replace(b"_", b"")
            if not _WORD.fullmatch(token) or not 1 <= len(digits) <= 8:
                shown = repr(token[:20])[1:]
                raise RomError(f"{path}: line {number}: {shown} is not a word of up to 8 hex digits; name a .mem file")
            words.append(int(digits, 16))
            lines.append(number)
    return np.array(words, dtype=np.uint32), np.array(lines, dtype=np.int64)


def _check_address(path: Path, line: int, token: bytes, expected: int) -> None:
    if re.fullmatch(rb"@[0-9A-Fa-f]{1,8}", token) is None or int(token[1:], 16) != expected:
        shown = repr(token[:20])[1:]
        raise RomError(
            f"{path}: line {line}: address {shown} does not name the next word (@{expected:X}); "
            "write the words one after another"
        )
