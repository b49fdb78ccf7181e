"""The agent of a PYNQ board in a thread of this process, around the fake of pynq, and clients of it on loopback."""

from __future__ import annotations

import socket
import sys
import threading
from contextlib import contextmanager, suppress

from voxrt.board.agent import voxrt_board
from voxrt.board.tcp_device import open_tcp


@contextmanager
def running_agent(token: str = "", bitstream: str = "voxrt.bit"):
    """An agent for the ray tracer that `import pynq` finds; gives its address and its board."""
    board = voxrt_board.Board(bitstream)
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def serve() -> None:
            with suppress(OSError):
                voxrt_board.serve(listener, board, token)

        thread = threading.Thread(target=serve)
        thread.start()
        try:
            yield f"tcp://127.0.0.1:{listener.getsockname()[1]}", board
        finally:
            listener.shutdown(socket.SHUT_RDWR)
            thread.join(30)


class Boards:
    """Opens the ray tracer that `import pynq` finds, by an agent; again after the client before has left."""

    def __init__(self, stack) -> None:
        self._stack = stack
        self._pynq, self._address = None, ""
        self._device = None

    def __call__(self):
        self.close()
        if self._pynq is None or self._pynq is not sys.modules["pynq"]:
            self._address, _ = self._stack.enter_context(running_agent())
            self._pynq = sys.modules["pynq"]
        self._device = open_tcp(self._address, "")
        return self._device

    def close(self) -> None:
        """Leave the board as a client does that dies."""
        if self._device is not None:
            self._device._video.close()
            self._device = None
