"""A board at a serial port of the operating system: programs open it by its path."""

from __future__ import annotations

import os
import threading
import tty
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fakes.ecp5_board import Board

_HEADER = 7
_WRITE = 2


@contextmanager
def serial_line(board: Board) -> Iterator[str]:
    """Let a board answer at a pseudo-terminal; give the address of the port."""
    ours, theirs = os.openpty()
    tty.setraw(theirs)
    answering = threading.Thread(target=_answer, args=(board, ours), daemon=True)
    answering.start()
    try:
        yield f"serial:{os.ttyname(theirs)}"
    finally:
        os.write(theirs, b"\0")  # ends the thread: boards are asked by hosts alone
        answering.join()
        os.close(theirs)
        os.close(ours)


def _answer(board: Board, line: int) -> None:
    """Hand on whole requests, and their answers, until a byte comes that begins none."""
    waiting = b""
    while True:
        while len(waiting) >= _HEADER:
            length = _HEADER + 4 + 4 * waiting[3] * (waiting[1] == _WRITE)
            if len(waiting) < length:
                break
            board.write(waiting[:length])
            waiting = waiting[length:]
            answer = board.read(1 << 16)
            while answer:
                answer = answer[os.write(line, answer) :]
        came = os.read(line, 4096)
        if came == b"\0":
            return
        waiting += came
