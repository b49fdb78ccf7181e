"""Floods of a frame server in a process of their own: ``python floods.py PORT``; it ends when its input does."""

from __future__ import annotations

import base64
import os
import socket
import sys
import threading
import time

MASK = bytes(4)
PING = b"\x89\x80" + MASK
FRAGMENT = b"\x00\x80" + MASK
BEGIN = b"\x02\x80" + MASK


def text(message: bytes) -> bytes:
    size = bytes([0x80 | len(message)]) if len(message) < 126 else b"\xff" + len(message).to_bytes(8, "big")
    return b"\x81" + size + MASK + message


HEADERS = b"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
TAKE_AND_RELEASE = text(b'{"type": "take"}') + text(b'{"type": "release"}')
NUMBERS = text(b'{"type": "view", "camera": [' + b"1," * 32_000 + b"1]}")
MORE_NUMBERS = text(b'{"type": "view", "camera": [' + b"1," * 130_000 + b"1]}")
CHUNK = b"\x82\xfe\xff\xff" + MASK + bytes(0xFFFF)


def viewer(port: int) -> socket.socket:
    """A connection after its handshake."""
    connection = socket.create_connection(("127.0.0.1", port))
    key = base64.b64encode(bytes(16))
    connection.sendall(b"GET /v2 HTTP/1.1\r\nHost: x\r\n" + HEADERS + key + b"\r\n\r\n")
    answer = b""
    while b"\r\n\r\n" not in answer:
        part = connection.recv(1)
        if not part:
            raise ConnectionError
        answer += part
    if b" 101 " not in answer:
        raise ConnectionError(answer)
    return connection


def read_all(connection: socket.socket) -> None:
    try:
        while connection.recv(1 << 16):
            pass
    except OSError:
        pass


def send_for_ever(port: int, data: bytes, begin: bytes = b"", reads: bool = True) -> None:
    """Send the same without end; connect again when the server closes the connection."""
    block = data * max(1, 65536 // len(data))
    while True:
        try:
            with viewer(port) as connection:
                if reads:
                    threading.Thread(target=read_all, args=(connection,), daemon=True).start()
                connection.sendall(begin)
                while True:
                    connection.sendall(block)
        except OSError:
            time.sleep(0.02)


def connect_for_ever(port: int) -> None:
    """Open connections, send half a request, and leave."""
    while True:
        try:
            with socket.create_connection(("127.0.0.1", port)) as connection:
                connection.sendall(b"GET /v2 HTTP/1.1\r\nHost:")
        except OSError:
            pass
        time.sleep(0.001)


def floods(port: int) -> list[threading.Thread]:
    """Floods of different kinds."""
    sent = [
        (PING, b"", True),
        (PING, b"", False),
        (text(b"{}"), b"", True),
        (text(b"{}"), b"", False),
        (text(b'{"type": "view", "camera": 3}'), b"", True),
        (NUMBERS, b"", True),
        (MORE_NUMBERS, b"", True),
        (TAKE_AND_RELEASE, b"", True),
        (FRAGMENT, BEGIN, True),
        (CHUNK, b"", True),
        (text(b'{"type": "registers"}'), b"", True),
    ]
    threads = [threading.Thread(target=send_for_ever, args=(port, *kind), daemon=True) for kind in sent]
    return [*threads, threading.Thread(target=connect_for_ever, args=(port,), daemon=True)]


if __name__ == "__main__":
    for thread in floods(int(sys.argv[1])):
        thread.start()
    sys.stdin.read()
    os._exit(0)
