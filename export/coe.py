"""``.coe`` files: memory words for the AMD (Xilinx) block memory generator.

Written: radix 16, one word per line. Read: radix 2, 10 or 16; words parted by commas or white space; lines that begin
with ``;`` are comments (AMD PG058, "Specifying initial memory contents").
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from voxrt.export.atomic import write_atomically
from voxrt.export.word_file import WordFile, read_bytes, word_file
from voxrt.octree import RomError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

_DIGITS = {2: rb"[01]{1,32}", 10: rb"[0-9]{1,10}", 16: rb"[0-9A-Fa-f]{1,8}"}
_RADIX = re.compile(rb"\s*memory_initialization_radix\s*=\s*([0-9]+)\s*;", re.IGNORECASE)
_VECTOR = re.compile(rb"\s*memory_initialization_vector\s*=", re.IGNORECASE)
_COMMENT = re.compile(rb"^[ \t]*;[^\n]*", re.MULTILINE)


def coe_bytes(words: NDArray[np.uint32]) -> bytes:
    """Return words (uint32, shape (N,), N at least 1) as the bytes of a ``.coe`` file."""
    lines = b",\n".join(b"%08X" % word for word in words.tolist())
    return b"memory_initialization_radix=16;\nmemory_initialization_vector=\n" + lines + b";\n"


def write_coe(path: Path, words: NDArray[np.uint32]) -> None:
    """Write words as a ``.coe`` file; parameters and errors are those of :func:`write_mem`.

    Examples
    --------
    >>> from pathlib import Path
    >>> write_coe(Path("dot.coe"), np.array([1, *[0xFFFFFF07] * 8], np.uint32))
    """
    write_atomically(path, coe_bytes(words))


def read_coe(path: Path) -> WordFile:
    """Read a ``.coe`` file.

    Raises
    ------
    RomError
        The file cannot be read or breaks the syntax. The message names the line.

    Examples
    --------
    >>> from pathlib import Path
    >>> write_coe(Path("dot.coe"), np.array([1, *[0xFFFFFF07] * 8], np.uint32))
    >>> len(read_coe(Path("dot.coe")).words)
    9
    """
    text = _COMMENT.sub(b"", read_bytes(path))
    radix_statement = _RADIX.match(text)
    vector_statement = radix_statement and _VECTOR.match(text, radix_statement.end())
    if not radix_statement or not vector_statement:
        raise RomError(
            f"{path}: memory_initialization_radix and memory_initialization_vector do not stand first; name a .coe file"
        )
    radix = int(radix_statement[1][:9])
    if radix not in _DIGITS:
        raise RomError(f"{path}: radix {radix} is none of 2, 10 and 16; write it with radix 16")
    vector, end, rest = text[vector_statement.end() :].partition(b";")
    if not end or rest.strip():
        raise RomError(f"{path}: the vector does not end the file with ';'; the file is cut short or damaged")
    words, lines = [], []
    word = re.compile(_DIGITS[radix])
    first_line = text[: vector_statement.end()].count(b"\n") + 1
    for number, line in enumerate(vector.split(b"\n"), start=first_line):
        for token in line.replace(b",", b" ").split():
            if not word.fullmatch(token) or int(token, radix) >= 1 << 32:
                raise RomError(f"{path}: line {number}: {repr(token[:20])[1:]} is no word of 32 bits in radix {radix}; "
                               "write it with radix 16")  # fmt: skip
            words.append(int(token, radix))
            lines.append(number)
    return word_file(np.array(words, dtype=np.uint32), np.array(lines, dtype=np.int64))
