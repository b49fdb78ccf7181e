"""A client of the frame server: uploads a scene, and sees frames."""

from __future__ import annotations

import json
import zlib
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake, InvalidStatus

from ..board.errors import Refused
from .packets import CHUNK_LIMIT, Chunk, pack_chunk, unpack_frame
from .show import PROTOCOL

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Mapping

    from ..board.scene_memory import Progress
    from .packets import FramePacket

_MESSAGE_LIMIT = 1 << 28
_WINDOW = 8  # chunks under way that the server has not acknowledged


class Client:
    """A viewer: made by :func:`visit`.

    Attributes
    ----------
    hello
        What the server said of itself.
    state
        What it last said of the show.
    """

    def __init__(self, connection: ClientConnection, hello: dict[str, Any]) -> None:
        self.hello = hello
        self.state: dict[str, Any] = {}
        self._connection = connection
        self._requests = 0
        self._frame: FramePacket | None = None

    async def send(self, kind: str, **fields: object) -> int:
        """Send a request without waiting for its answer; gives its number."""
        self._requests += 1
        await self._connection.send(json.dumps({"type": kind, "request": self._requests, **fields}))
        return self._requests

    async def ask(self, kind: str, **fields: object) -> dict[str, Any]:
        """Send a request and wait for its answer.

        Raises
        ------
        Refused
            The server refused it, or hung up.
        """
        return await self._answer(await self.send(kind, **fields))

    async def take(self) -> None:
        """Take control.

        Raises
        ------
        Refused
            Another viewer has it.
        """
        if not (await self.ask("take"))["granted"]:
            raise Refused("another viewer steers; wait, or ask for control in the page")

    async def frame(self) -> FramePacket:
        """Wait for the next frame.

        Raises
        ------
        Refused
            The server hung up.
        """
        while self._frame is None:
            await self._receive()
        frame, self._frame = self._frame, None
        return frame

    async def upload(
        self, files: Mapping[str, bytes], progress: Progress, *, check_only: bool = False
    ) -> dict[str, Any]:
        """Let the server run a scene made of `files`; `check_only` stops before its first word is written.

        Raises
        ------
        Refused
            The server refused it, or hung up. The old scene runs on.
        """
        announced = [{"name": name, "size": len(data), "crc32": zlib.crc32(data)} for name, data in files.items()]
        ready = await self.ask("upload", files=announced, check_only=check_only)
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
        """Take one message; frames and states are kept, answers are given."""
        try:
            message = await self._connection.recv()
        except ConnectionClosed as error:
            raise Refused(f"the server hung up ({error}); the scene that ran there still runs") from None
        if isinstance(message, bytes):
            self._frame = unpack_frame(message)
            return None
        answer: dict[str, Any] = json.loads(message)
        if answer["type"] == "state":
            self.state = answer
            return None
        return answer


@asynccontextmanager
async def visit(url: str) -> AsyncIterator[Client]:
    """Connect to the server whose page is at `url`, with its ``#token=...`` where it has one.

    Raises
    ------
    Refused
        There is no server, it does not let us in, or it speaks another version.
    """
    parts = urlsplit(url if "//" in url else f"http://{url}")
    if parts.scheme not in {"http", "ws"} or not parts.netloc:
        raise Refused(f"{url}: is no address such as http://127.0.0.1:8000/")
    token = parse_qs(parts.fragment or parts.query).get("token", [""])[0]
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    address = f"ws://{parts.netloc}/v{PROTOCOL}"
    try:
        connection = await connect(
            address, additional_headers=headers, compression=None, max_size=_MESSAGE_LIMIT, open_timeout=10, proxy=None
        )
    except InvalidStatus as error:
        said = (error.response.body or b"").decode("utf-8", "replace").strip()
        raise Refused(f"{parts.netloc}: {said or error}") from None
    except (TimeoutError, OSError, InvalidHandshake) as error:
        raise Refused(f"{parts.netloc}: no frame server answers there ({error}); start one: voxrt serve") from None
    async with connection:
        hello = json.loads(await connection.recv())
        if hello.get("protocol") != PROTOCOL:
            raise Refused(f"{parts.netloc} speaks protocol {hello.get('protocol')} and this is {PROTOCOL}; upgrade")
        yield Client(connection, hello)
