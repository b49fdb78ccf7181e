"""TCP connections without a protocol."""

from __future__ import annotations

import asyncio
import contextlib
import socket


@contextlib.asynccontextmanager
async def raw_connection(port):
    """A TCP connection to this machine; at the end it is aborted, and awaited until it is closed."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        yield reader, writer
    finally:
        writer.transport.abort()
        with contextlib.suppress(ConnectionError):
            await writer.wait_closed()


async def ended(reader):
    """Whether the other side closes the connection without sending anything."""
    try:
        return await reader.read() == b""
    except ConnectionError:
        return True


def free_port():
    """A TCP port on which nobody listens."""
    with socket.create_server(("127.0.0.1", 0)) as listening:
        return listening.getsockname()[1]
