"""A pseudo-terminal with a board of fakes/ecp5_board.py behind it, for commands that open a serial line."""

from __future__ import annotations

import os
import pty
import threading
import tty
from contextlib import contextmanager


@contextmanager
def terminal(board):
    """Serve a board at a pseudo-terminal, and give the name of its other end."""
    host, other = pty.openpty()
    tty.setraw(host)
    tty.setraw(other)
    name = os.ttyname(other)

    def serve():
        data = b""
        while True:
            try:
                data += os.read(host, 4096)
            except OSError:
                return
            while len(data) >= 7:
                length = 11 + 4 * data[3] * (data[1] == 2)
                if len(data) < length:
                    break
                request, data = data[:length], data[length:]
                board.write(request)
                os.write(host, board.read(4096))

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    try:
        yield name
    finally:
        os.close(other)
        thread.join(timeout=30)
        os.close(host)
