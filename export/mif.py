"""``.mif`` files: memory words for Intel (Altera) tools, and AMD (Xilinx) ones under the same suffix.

Written: the Intel form, hexadecimal, one word per line. Read: the Intel form (Quartus Prime, "Memory Initialization
File definition": any radix, ``--`` and ``% %`` comments, ``[a..b]`` ranges, several words behind one address) if every
word has a value, and the AMD form (32 binary digits per line).
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

_RADIX = {b"BIN": 2, b"OCT": 8, b"DEC": 10, b"UNS": 10, b"HEX": 16}
_COMMENT = re.compile(rb"--[^\n]*|%[^%]*%")
_SETTING = re.compile(rb"(WIDTH|DEPTH|ADDRESS_RADIX|DATA_RADIX)\s*=\s*(\w+)\s*;", re.IGNORECASE)
_CONTENT = re.compile(rb"CONTENT\s+BEGIN\b(.*)\bEND\s*;\s*\Z", re.IGNORECASE | re.DOTALL)
_ENTRY = re.compile(rb"\s*(?:\[\s*(\w+)\s*\.\.\s*(\w+)\s*\]|(\w+))\s*:(.*)", re.DOTALL)
_BINARY_LINES = re.compile(rb"\s*[01]{32}(?:\s+[01]{32})*\s*\Z")
_WORD_LIMIT = 1 << 26


def mif_bytes(words: NDArray[np.uint32]) -> bytes:
    """Return words (uint32, shape (N,)) as the bytes of a ``.mif`` file, Intel form."""
    head = b"WIDTH=32;\nDEPTH=%d;\nADDRESS_RADIX=HEX;\nDATA_RADIX=HEX;\nCONTENT BEGIN\n" % len(words)
    return head + b"".join(b"%X : %08X;\n" % entry for entry in enumerate(words.tolist())) + b"END;\n"


def write_mif(path: Path, words: NDArray[np.uint32]) -> None:
    """Write words as a ``.mif`` file; parameters and errors are those of :func:`write_mem`.

    Examples
    --------
    >>> from pathlib import Path
    >>> write_mif(Path("dot.mif"), np.array([1, *[0xFFFFFF07] * 8], np.uint32))
    """
    write_atomically(path, mif_bytes(words))


def read_mif(path: Path) -> WordFile:
    """Read a ``.mif`` file of either form.

    Raises
    ------
    RomError
        The file cannot be read, breaks the syntax, or leaves a word out: The message names the line or the word.

    Examples
    --------
    >>> from pathlib import Path
    >>> write_mif(Path("dot.mif"), np.array([1, *[0xFFFFFF07] * 8], np.uint32))
    >>> len(read_mif(Path("dot.mif")).words)
    9
    """
    data = read_bytes(path)
    if _BINARY_LINES.match(data):
        words = [int(word, 2) for word in data.split()]
        return word_file(np.array(words, dtype=np.uint32), None)
    text = _COMMENT.sub(lambda comment: b"\n" * comment[0].count(b"\n"), data)
    content = _CONTENT.search(text)
    if content is None:
        raise RomError(f"{path}: has no CONTENT BEGIN ... END; name a .mif file, or one of 32 binary digits per line")
    settings = {name.upper(): value.upper() for name, value in _SETTING.findall(text[: content.start()])}
    if settings.get(b"WIDTH") != b"32":
        raise RomError(f"{path}: WIDTH is not 32; write the memory as words of 32 bits")
    depth = settings.get(b"DEPTH", b"")
    if not depth.isdigit() or len(depth) > 9 or not 1 <= int(depth) <= _WORD_LIMIT:
        raise RomError(f"{path}: DEPTH is not 1 ... {_WORD_LIMIT}; write the number of words there")
    radices = [_RADIX.get(settings.get(key, b"HEX"), 0) for key in (b"ADDRESS_RADIX", b"DATA_RADIX")]
    if 0 in radices:
        raise RomError(f"{path}: ADDRESS_RADIX or DATA_RADIX is none of BIN, OCT, DEC, UNS and HEX; write HEX")
    first_line = text[: content.start(1)].count(b"\n") + 1
    return _read_content(path, content[1], first_line, int(depth), radices)


def _read_content(path: Path, content: bytes, line: int, depth: int, radices: list[int]) -> WordFile:
    words = np.zeros(depth, dtype=np.uint32)
    lines = np.zeros(depth, dtype=np.int64)
    *entries, rest = content.split(b";")
    if rest.strip():
        raise RomError(f"{path}: the last entry does not end with ';'; the file is cut short or damaged")
    for entry in entries:
        here = line + entry[: len(entry) - len(entry.lstrip())].count(b"\n")
        line += entry.count(b"\n")
        low, high, values = _read_entry(path, here, entry, radices)
        end = low + len(values) if high is None else high + 1
        if end > depth or end <= low:
            raise RomError(f"{path}: line {here}: an entry reaches word {end - 1:X} of {depth:X}; write DEPTH words")
        words[low:end] = np.resize(np.array(values, dtype=np.uint32), end - low)
        lines[low:end] = here
    if not lines.all():
        raise RomError(f"{path}: word 0x{int(np.argmin(lines)):X} has no value; write every word")
    return word_file(words, lines)


def _read_entry(path: Path, line: int, entry: bytes, radices: list[int]) -> tuple[int, int | None, list[int]]:
    """Read ``address : words`` or ``[low..high] : words``; the words repeat over a range."""
    match = _ENTRY.match(entry)
    try:
        low = int(match[1] or match[3], radices[0]) if match else -1
        high = None if match is None or match[2] is None else int(match[2], radices[0])
        values = [int(value, radices[1]) for value in match[4].split()] if match else []
    except ValueError:
        values = []
    if not values or min(values) < 0 or max(values) >= 1 << 32:
        shown = repr(entry.strip()[:30])[1:]
        raise RomError(f"{path}: line {line}: {shown} is no 'address : word'; the file is damaged")
    return low, high, values
