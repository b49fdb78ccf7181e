"""What octree says of a memory that is not one."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray


class RomError(Exception):
    """A malformed octree memory, in one line: file or value, the word's address, what is wrong, how to fix it."""


def place(address: int, source: str = "", lines: Sequence[int] | NDArray[np.int64] | None = None) -> str:
    """Name the word at `address`: the file that it comes from, the line (counted from 1), the address in hex."""
    where = f"word 0x{address:X}"
    if lines is not None and address < len(lines):
        where = f"line {int(lines[address])}, {where}"
    return f"{source}: {where}" if source else where
