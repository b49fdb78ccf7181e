"""The server of the legacy protocol, for the desktop client of the student project that voxrt follows.

A request is 28 bytes: seven 32-bit words, little-endian. Each of the first six has eight zero bits and two signed
12-bit fields: look z, look y; look x, position z; position y, position x; right z, right y; right x, up z; up y, up x.
The last has the background: 8 bits each of blue, green, red. Positions are in units of 1/1024 of the world's side. The
answer is a picture without header: 512 rows of 512 pixels, three bytes each: red, green, blue.

Every client sees the scene through a camera of its own and changes nothing for others. The protocol has no token, so
its load is bounded: four clients, and all together one picture at a time and thirty per second.
"""

from __future__ import annotations

import asyncio
import struct
import time
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt.board.errors import DeviceError, Refused
from voxrt.board.view import Camera
from voxrt.serve.rate_limiter import RateLimiter

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from voxrt.serve.renderer import Renderer

_REQUEST = struct.Struct("<7I")
_SIZE = (512, 512)
_WORLD_BITS = 10
_CLIENTS = 4
_PICTURES_PER_SECOND = 30
_FIRST_SECONDS = 10  # until the first request
_IDLE_SECONDS = 600
_SEND_SECONDS = 20


class LegacyServer:
    """Serves pictures by the legacy protocol.

    Parameters
    ----------
    renderer
        The renderer whose scene the pictures show.
    """

    def __init__(self, renderer: Renderer) -> None:
        self._renderer = renderer
        self._clients: dict[asyncio.Task[None], asyncio.StreamWriter] = {}
        self._turn = asyncio.Lock()
        self._pictures = RateLimiter(_PICTURES_PER_SECOND, time.monotonic, burst=1)
        self.port = 0

    @asynccontextmanager
    async def listen(self, host: str, port: int) -> AsyncIterator[None]:
        """Listen while the context is entered."""
        server = await asyncio.start_server(self._serve_client, host, port, limit=1 << 12)
        self.port = int(server.sockets[0].getsockname()[1])
        try:
            yield
        finally:
            server.close()
            for writer in self._clients.values():
                writer.transport.abort()
            await asyncio.gather(*self._clients)
            await server.wait_closed()

    async def _serve_client(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.current_task()
        assert task is not None
        if len(self._clients) >= _CLIENTS:
            writer.transport.abort()
            return
        self._clients[task] = writer
        seconds = _FIRST_SECONDS
        try:
            while True:
                request = await asyncio.wait_for(reader.readexactly(_REQUEST.size), seconds)
                seconds = _IDLE_SECONDS
                writer.write(await self._render(request))
                await asyncio.wait_for(writer.drain(), _SEND_SECONDS)
        except (TimeoutError, asyncio.IncompleteReadError, ConnectionError, Refused, DeviceError):
            pass  # the protocol has no error messages: the connection is closed
        finally:
            del self._clients[task]
            writer.transport.abort()

    async def _render(self, request: bytes) -> bytes:
        camera, background = read_legacy_request(request, self._renderer.scene.depth)
        view = replace(self._renderer.view, camera=camera, size=_SIZE, background=background)
        async with self._turn:
            await asyncio.sleep(self._pictures.charge(1))
            frame = await self._renderer.render_view(view)
        return frame.colour.tobytes()


def read_legacy_request(request: bytes, depth: int) -> tuple[Camera, tuple[int, int, int]]:
    """Read a request: return the camera in a world of 2**`depth` voxels per side, and the background."""
    words = _REQUEST.unpack(request)
    lz, ly, lx, pz, py, px, rz, ry, rx, uz, uy, ux = (
        _signed(word >> shift & 0xFFF) for word in words[:6] for shift in (12, 0)
    )
    x, y, z = ((value << depth + 4) >> _WORLD_BITS for value in (px, py, pz))
    background = words[6] & 0xFF, words[6] >> 8 & 0xFF, words[6] >> 16 & 0xFF
    return Camera((x, y, z), (lx, ly, lz), (rx, ry, rz), (ux, uy, uz)), background


def _signed(field: int) -> int:
    return field - (1 << 12) if field & 0x800 else field
