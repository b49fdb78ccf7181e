"""The block RAMs of a placed design: what a base design holds in them, and how a scene replaces it.

A memory is cut into slices, a block RAM each. A ``.config`` of nextpnr-ecp5 has a section ``.bram_init WID`` per block
RAM: 256 lines of 8 values of 9 bits, the low and the high half of each of 1,024 rows of 18 bits.
"""

from __future__ import annotations

import hashlib
import re
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

_ROWS, _HALF_BITS = 1024, 9
_STEP = 512  # rows of a memory that are in the same block RAMs
_SECTION = re.compile(r"^\.bram_init (\d+)\n((?:(?:[0-9a-f]{3} ?){8}\n)+)", re.MULTILINE)
# Bits per word of a block RAM: where a word's bits are in a row of 18 bits, by the word's number in the row.
_PLACES = {bits: [9 * (word * bits // 8) + word * bits % 8 for word in range(16 // bits)] for bits in (1, 2, 4, 8)}
_PLACES[9] = [0, 9]
_PLACES[18] = [0]
ECP5_WIDTHS = (1, 2, 4, 9, 18, 36)
"""Widths at which a block RAM of an ECP5 is used."""
GOWIN_WIDTHS = (1, 2, 4, 8, 9, 16, 18, 32, 36)
"""The same of a GW2A: 8, 16 and 32 leave out every ninth bit."""


class Slice(Value, frozen=True):
    """The part of a memory that a block RAM holds.

    Attributes
    ----------
    wid
        Number of the section ``.bram_init``.
    row, rows
        First row of the memory, and how many.
    bit, bits
        First bit of each row, and how many: the width at which the block RAM is used. Bits beyond those of the memory
        are 0.
    """

    wid: int
    row: int
    rows: int
    bit: int
    bits: int


def base_contents(memory: str, rows: int, bits: int) -> NDArray[np.uint32]:
    """Give what a memory of a base design holds: contents that occur nowhere twice.

    Parameters
    ----------
    memory
        Its name: other names, other contents.
    rows, bits
        Its size; at most 32 bits.

    Returns
    -------
    ndarray
        uint32, shape (rows,).

    Examples
    --------
    >>> [f"{row:03x}" for row in base_contents("octree", 4, 12)]
    ['db6', '805', '44a', 'cd8']
    """
    stream = hashlib.shake_256(f"voxrt base design: {memory}".encode()).digest(4 * rows)
    contents: NDArray[np.uint32] = np.frombuffer(stream, dtype="<u4").astype(np.uint32) & np.uint32((1 << bits) - 1)
    return contents


def read_block_rams(config: str) -> dict[int, NDArray[np.uint32]]:
    """Read what the block RAMs of a ``.config`` hold: 1,024 rows of 18 bits, uint32, by ``WID``."""
    return {int(wid): _read_section(text) for wid, text in _SECTION.findall(config)}


def find_slices(config: str, memories: Mapping[str, tuple[int, int]]) -> dict[str, list[Slice]]:
    """Find where nextpnr put the memories of a base design, by what they hold.

    Parameters
    ----------
    config
        Text of the ``.config``.
    memories
        Rows and bits of each memory, by name.

    Returns
    -------
    dict
        The slices of each memory, in the order of the text.

    Raises
    ------
    ValueError
        A part of a memory is in no block RAM.
    """
    return match_slices(read_block_rams(config), memories, ECP5_WIDTHS)


def match_slices(
    sections: Mapping[int, NDArray[np.uint32]], memories: Mapping[str, tuple[int, int]], widths: Sequence[int]
) -> dict[str, list[Slice]]:
    """Find memories among block RAMs, as `find_slices` does.

    Parameters
    ----------
    sections
        Rows of 18 bits, uint32, shape (1024,), by number.
    memories
        Rows and bits of each memory, by name.
    widths
        At which the part's block RAMs are used.

    Returns
    -------
    dict
        The slices of each memory.

    Raises
    ------
    ValueError
        A part of a memory is in no block RAM.
    """
    found: dict[str, list[Slice]] = {}
    for name, (rows, bits) in memories.items():
        contents = base_contents(name, rows, bits)
        candidates = {
            encode_slice(contents, piece).tobytes(): piece
            for width in widths
            for row in range(0, rows, _words(width))
            for bit in range(0, bits, width)
            for piece in [Slice(0, row, _words(width), bit, width)]
        }
        slices = []
        for wid, section in sections.items():
            piece = candidates.get(section.tobytes())
            if piece is not None:
                slices.append(Slice(wid, piece.row, piece.rows, piece.bit, piece.bits))
        held = {
            (row, bit)
            for piece in slices
            for row in range(piece.row, min(piece.row + piece.rows, rows), _STEP)
            for bit in range(piece.bit, min(piece.bit + piece.bits, bits))
        }
        if len(held) != -(-rows // _STEP) * bits:
            raise ValueError(f"memory {name}: a part of it is in no block RAM of the placed design")
        found[name] = slices
    return found


def patch_config(
    config: str, memories: Mapping[str, Sequence[Slice]], contents: Mapping[str, NDArray[np.uint32]]
) -> str:
    """Replace what memories hold in a placed design.

    Parameters
    ----------
    config
        Text of the ``.config``.
    memories
        Slices of each memory, by name.
    contents
        uint32, the rows of each memory.

    Returns
    -------
    str
        The text; nothing else differs.
    """
    sections = {
        piece.wid: _write_section(encode_slice(contents[name], piece))
        for name, slices in memories.items()
        for piece in slices
    }

    def replace(match: re.Match[str]) -> str:
        wid = int(match[1])
        return f".bram_init {wid}\n{sections[wid]}" if wid in sections else match[0]

    return _SECTION.sub(replace, config)


def places(bits: int) -> list[int]:
    """Give where words of a slice begin in the rows of 18 bits that follow each other: those of one or two rows.

    Examples
    --------
    >>> places(9), places(36)
    ([0, 9], [0])
    """
    return _PLACES.get(bits, [0])


def _words(bits: int) -> int:
    return _ROWS * (18 if bits % 9 == 0 else 16) // bits


def encode_slice(contents: NDArray[np.uint32], piece: Slice) -> NDArray[np.uint32]:
    """Give the rows of 18 bits of the block RAM that holds a slice, shape (1024,)."""
    words = np.zeros(piece.rows, dtype=np.uint64)
    held = contents[piece.row : piece.row + piece.rows].astype(np.uint64)
    words[: len(held)] = held >> np.uint64(piece.bit) & np.uint64((1 << piece.bits) - 1)
    # The part of a word that is in a row.
    row_bits = piece.bits if piece.bits < 32 else piece.bits // 2
    if piece.bits >= 32:
        words = np.stack([words & np.uint64((1 << row_bits) - 1), words >> np.uint64(row_bits)], axis=1).ravel()
    if row_bits == 16:
        words = words & np.uint64(0xFF) | words >> np.uint64(8) << np.uint64(_HALF_BITS)
    rows = np.zeros(_ROWS, dtype=np.uint32)
    places = _PLACES.get(row_bits, [0])
    for number, place in enumerate(places):
        rows |= words[number :: len(places)].astype(np.uint32) << np.uint32(place)
    return rows


def _read_section(text: str) -> NDArray[np.uint32]:
    halves = np.array([int(value, 16) for value in text.split()], dtype=np.uint32)
    return halves[0::2] | halves[1::2] << np.uint32(_HALF_BITS)


def _write_section(rows: NDArray[np.uint32]) -> str:
    halves = np.stack([rows & np.uint32(0x1FF), rows >> np.uint32(_HALF_BITS)], axis=1).reshape(-1, 8)
    return "".join(" ".join(f"{value:03x}" for value in line) + "\n" for line in halves)
