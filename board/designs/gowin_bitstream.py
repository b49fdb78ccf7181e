"""The block RAMs in a bitstream of a Gowin GW2A, ``.fs``: what they hold, and how a scene replaces it.

A ``.fs`` has a line of zeros and ones per frame. Its last frames are what block RAMs hold, 256 per row of block RAMs.
Each frame ends with a checksum of its own, low byte first, and six bytes of ones. It is CRC-16/ARC of six bytes of ones
and the frame. Nothing else depends on what block RAMs hold, so that neither place and route nor a packer is needed.

A block RAM has 1,024 rows of 18 bits, as in `base_design`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.board.designs.base_design import encode_slice
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from voxrt.board.designs.base_design import Slice

_ROWS, _BITS = 1024, 18
_CHECK_BITS = 64  # the checksum and ones
_FRAMES = 256  # of a row of block RAMs
_ZERO = ord("0")


class BlockRams(Value, frozen=True):
    """Where the block RAMs of a design are in its ``.fs``.

    Attributes
    ----------
    columns
        Of a block RAM: the column of bit b in the quarter q of its rows is `columns[4 * b + q]`.
    places
        First frame and first column of each block RAM, by `Slice.wid`; columns count from the end of a frame.
    """

    columns: tuple[int, ...]
    places: tuple[tuple[int, int], ...]


def read_block_rams(fs: str, rams: BlockRams) -> dict[int, NDArray[np.uint32]]:
    """Read what the block RAMs of a ``.fs`` hold: 1,024 rows of 18 bits, uint32, by their number."""
    _, frames = _frames(fs)
    weights = np.uint32(1) << np.arange(_BITS, dtype=np.uint32)
    return {wid: frames[_where(rams, wid, frames)].astype(np.uint32) @ weights for wid in range(len(rams.places))}


def patch_fs(
    fs: str, rams: BlockRams, memories: Mapping[str, Sequence[Slice]], contents: Mapping[str, NDArray[np.uint32]]
) -> str:
    """Replace what memories hold in a bitstream.

    Parameters
    ----------
    fs
        Text of the ``.fs``, not compressed.
    rams
        Where its block RAMs are.
    memories
        Slices of each memory, by name.
    contents
        uint32, the rows of each memory.

    Returns
    -------
    str
        The text; beside the contents, only the checksums of their frames differ.
    """
    lines, frames = _frames(fs)
    changed = np.zeros(len(frames), dtype=bool)
    shifts = np.arange(_BITS, dtype=np.uint32)
    for name, slices in memories.items():
        for piece in slices:
            rows = encode_slice(contents[name], piece)
            where = _where(rams, piece.wid, frames)
            frames[where] = rows[:, None] >> shifts & np.uint32(1)
            changed[where[0].ravel()] = True
    _write_checksums(frames, changed)
    text = frames + np.uint8(_ZERO)
    numbers = [number for number, line in enumerate(lines) if len(line) == frames.shape[1]]
    for number, row in zip(numbers, text, strict=True):
        lines[number] = row.tobytes().decode()
    return "\n".join(lines) + "\n"


def _frames(fs: str) -> tuple[list[str], NDArray[np.uint8]]:
    """Give all lines, and the bits of the frames, which are the longest lines."""
    lines = fs.splitlines()
    length = max(len(line) for line in lines)
    text = "".join(line for line in lines if len(line) == length)
    return lines, np.frombuffer(text.encode(), dtype=np.uint8).reshape(-1, length) - np.uint8(_ZERO)


def _where(rams: BlockRams, wid: int, frames: NDArray[np.uint8]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Give frame and place in it of each bit of a block RAM, shape (1024, 18)."""
    frame, column = rams.places[wid]
    row, bit = np.arange(_ROWS)[:, None], np.arange(_BITS)
    # The two lowest bits of a row's number, exchanged, are the highest of the frame's.
    number = (row & 1) << 7 | (row & 2) << 5 | row >> 2 & 0x3F
    columns = column + np.array(rams.columns)[4 * bit + (row >> 8)]
    return (frame + _FRAMES - 1 - number) * np.ones_like(bit), frames.shape[1] - _CHECK_BITS - 1 - columns


def _write_checksums(frames: NDArray[np.uint8], changed: NDArray[np.bool_]) -> None:
    table = np.arange(256, dtype=np.uint16)
    for _ in range(8):
        table = table >> np.uint16(1) ^ np.where(table & np.uint16(1), np.uint16(0xA001), np.uint16(0))
    content = np.packbits(frames[changed, :-_CHECK_BITS], axis=1)
    check = np.zeros(len(content), dtype=np.uint16)
    for column in [np.full(len(content), 0xFF, np.uint8)] * 6 + list(content.T):
        check = check >> np.uint16(8) ^ table[(check ^ column) & np.uint16(0xFF)]
    both = np.stack([check & np.uint16(0xFF), check >> np.uint16(8)], axis=1).astype(np.uint8)
    frames[changed, -_CHECK_BITS : -_CHECK_BITS + 16] = np.unpackbits(both, axis=1)
