"""Connections of strangers, opened and gone without a trace."""

from __future__ import annotations

import asyncio
import contextlib


@contextlib.asynccontextmanager
async def stranger(port):
    """A TCP connection to this machine; hung up, and awaited until it is gone, at the end."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        yield reader, writer
    finally:
        writer.transport.abort()
        with contextlib.suppress(ConnectionError):
            await writer.wait_closed()


async def ended(reader):
    """Whether the other side hangs up without another word."""
    try:
        return await reader.read() == b""
    except ConnectionError:
        return True
