"""A client of the frame server: it changes the view, receives frames and uploads scenes."""

from __future__ import annotations

import json
import zlib
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidStatus

from ..board.errors import Refused
from .packets import CHUNK_LIMIT, PROTOCOL_VERSION, Chunk, pack_chunk, unpack_frame

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Mapping

    from ..board.scene_memory import Progress
    from .packets import FramePacket

_MESSAGE_LIMIT = 1 << 28
_WINDOW = 8  # chunks that may be sent before the server acknowledges the first of them


class FrameClient:
    """A connected client; :func:`open_client` makes it.

    Attributes
    ----------
    hello
        The first message of the server.
    state
        The newest state that the server sent; empty before the first.
    """

    def __init__(self, connection: ClientConnection, hello: dict[str, Any]) -> None:
        self.hello = hello
        self.state: dict[str, Any] = {}
        self._connection = connection
        self._requests = 0
        self._frame: FramePacket | None = None

    async def send(self, kind: str, **fields: object) -> int:
        """Send a request without waiting for its answer; return its number."""
        self._requests += 1
        await self._connection.send(json.dumps({"type": kind, "request": self._requests, **fields}))
        return self._requests

    async def request(self, kind: str, **fields: object) -> dict[str, Any]:
        """Send a request and wait for its answer.

        Raises
        ------
        Refused
            The server refused the request, or closed the connection.
        """
        return await self._answer(await self.send(kind, **fields))

    async def take_control(self) -> None:
        """Take control.

        Raises
        ------
        Refused
            Another viewer has it.
        """
        if not (await self.request("take"))["granted"]:
            raise Refused("another viewer has control; wait, or ask for control in the page")

    async def next_frame(self) -> FramePacket:
        """Wait for the next frame.

        Raises
        ------
        Refused
            The server closed the connection.
        """
        while self._frame is None:
            await self._receive()
        frame, self._frame = self._frame, None
        return frame

    async def upload(
        self, files: Mapping[str, bytes], progress: Progress, *, check_only: bool = False
    ) -> dict[str, Any]:
        """Upload files and let the server show their scene; with `check_only` nothing is written to the device.

        Raises
        ------
        Refused
            The server refused the scene, or closed the connection. The present scene stays.
        """
        announced = [{"name": name, "size": len(data), "crc32": zlib.crc32(data)} for name, data in files.items()]
        ready = await self.request("upload", files=announced, check_only=check_only)
        number, data = ready["request"], b"".join(files.values())
        received = 0
        for offset in range(0, len(data), CHUNK_LIMIT):
            while offset - received >= _WINDOW * CHUNK_LIMIT:
                received = (await self._answer(number))["bytes"]
                progress("send", received, len(data))
            await self._connection.send(pack_chunk(Chunk(ready["upload"], offset, data[offset : offset + CHUNK_LIMIT])))
        while True:
            answer = await self._answer(number)
            if answer["type"] == "done":
                return answer
            if answer["type"] == "received":
                progress("send", answer["bytes"], len(data))
            elif answer["type"] == "progress":
                progress(answer["stage"], answer["done"], answer["total"])

    async def _answer(self, number: int) -> dict[str, Any]:
        while True:
            message = await self._receive()
            if message is not None and message.get("request") == number:
                if message["type"] == "refused":
                    raise Refused(message["problem"])
                return message

    async def _receive(self) -> dict[str, Any] | None:
        """Receive one message: keep a frame or a state, return an answer."""
        try:
            message = await self._connection.recv()
        except ConnectionClosed as error:
            raise Refused(f"the server closed the connection ({error}); it still shows its present scene") from None
        if isinstance(message, bytes):
            self._frame = unpack_frame(message)
            return None
        answer: dict[str, Any] = json.loads(message)
        if answer["type"] == "state":
            self.state = answer
            return None
        return answer


@asynccontextmanager
async def open_client(url: str) -> AsyncIterator[FrameClient]:
    """Connect to the server whose page is at `url`, with its ``#token=...`` where it has one.

    Raises
    ------
    Refused
        No server answers, it refuses the connection, or it has another version of the protocol.
    """
    parts = urlsplit(url if "//" in url else f"http://{url}")
    if parts.scheme not in {"http", "ws"} or not parts.netloc:
        raise Refused(f"{url}: is no address such as http://127.0.0.1:8000/")
    token = parse_qs(parts.fragment or parts.query).get("token", [""])[0]
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    address = f"ws://{parts.netloc}/v{PROTOCOL_VERSION}"
    try:
        connection = await connect(
            address, additional_headers=headers, compression=None, max_size=_MESSAGE_LIMIT, open_timeout=10, proxy=None
        )
    except InvalidStatus as error:
        reason = (error.response.body or b"").decode("utf-8", "replace").strip()
        raise Refused(f"{parts.netloc}: {reason or error}") from None
    except (TimeoutError, OSError, InvalidHandshake) as error:
        raise Refused(f"{parts.netloc}: no frame server answers ({error}); start one: voxrt serve") from None
    async with connection:
        hello = json.loads(await connection.recv())
        if hello.get("protocol") != PROTOCOL_VERSION:
            raise Refused(
                f"{parts.netloc} has protocol version {hello.get('protocol')} and this client {PROTOCOL_VERSION}; "
                "upgrade the older one"
            )
        yield FrameClient(connection, hello)
