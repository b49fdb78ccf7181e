"""The words that the block RAMs of a Gowin bitstream hold."""

import numpy as np


def gowin_words(board, memory, rams):
    """Words of a memory of 16,384 rows in block RAMs of 1 bit: 16 rows of the memory per row of 18 bits."""
    found = np.zeros(16384, np.int64)
    for piece in board.design.memories[memory].slices:
        assert (piece.bits, piece.row, piece.rows) == (1, 0, 16384)
        rows = rams[piece.wid].astype(np.int64)[:, None]
        found |= np.concatenate([rows >> np.arange(8) & 1, rows >> np.arange(9, 17) & 1], 1).ravel() << piece.bit
    return found
