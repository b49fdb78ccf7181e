"""A client of the agent that sends what it likes."""

from __future__ import annotations

import hmac
import socket
import struct
from contextlib import contextmanager

TOKEN = "as secret as tests can be"


class Client:
    """A client that sends what it likes."""

    def __init__(self, line):
        self.line = line
        self.greeting = self.receive(28)

    def receive(self, count):
        data = b""
        while len(data) < count:
            part = self.line.recv(count - len(data))
            if not part:
                return None
            data += part
        return data

    def prove(self, token=TOKEN):
        self.line.sendall(hmac.digest(token.encode(), self.greeting[12:], "sha256"))
        return self.answer()

    def answer(self):
        """The status and the result; None if the agent has closed the line."""
        head = self.receive(8)
        if head is None:
            return None
        status, count = struct.unpack("<2I", head)
        return status, self.receive(count)

    def ask(self, operation, a=0, b=0, data=b""):
        self.line.sendall(struct.pack("<3I", operation, a, b) + data)
        return self.answer()


@contextmanager
def client(address):
    host, port = address.removeprefix("tcp://").split(":")
    with socket.create_connection((host, int(port)), 30) as line:
        yield Client(line)
