"""A client of the frame server: it changes the view, receives frames and uploads scenes.

It trusts no server: whatever one sends or fails to send becomes :class:`~.errors.Refused`, in one line, within a time
limit.
"""

from __future__ import annotations

import asyncio
import contextlib
import json
import zlib
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import InvalidStatus, WebSocketException

from voxrt.board.errors import Refused
from voxrt.serve.packets import (
    CHUNK_LIMIT,
    CHUNK_MAGIC,
    PROTOCOL_VERSION,
    Chunk,
    pack_chunk,
    unpack_chunk,
    unpack_frame,
)
from voxrt.serve.shown_text import shown_line

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Awaitable, Mapping
    from typing import TypeVar

    from voxrt.board.scene_memory import Progress
    from voxrt.serve.packets import FramePacket

    Result = TypeVar("Result")

_MESSAGE_LIMIT = 1 << 28
_WINDOW = 8  # chunks that may be sent before the server acknowledges the first of them
_OPEN_SECONDS = 10.0
_ANSWER_SECONDS = 60.0  # without any message for a request; while a scene is made the server repeats its progress
_UPLOAD_SECONDS = 3600.0
_SCHEMES = {"http": "ws", "ws": "ws", "https": "wss", "wss": "wss"}


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
        self._part: Chunk | None = None  # of files that are saved

    async def send(self, kind: str, **fields: object) -> int:
        """Send a request without waiting for its answer; return its number.

        Raises
        ------
        Refused
            The server closed the connection, or reads nothing.
        """
        self._requests += 1
        await self._send(json.dumps({"type": kind, "request": self._requests, **fields}))
        return self._requests

    async def request(self, kind: str, **fields: object) -> dict[str, Any]:
        """Send a request and wait for its answer.

        Raises
        ------
        Refused
            The server refused the request, does not answer, or closed the connection.
        """
        return await self._answer(await self.send(kind, **fields))

    async def take_control(self) -> None:
        """Take control.

        Raises
        ------
        Refused
            Another viewer has it.
        """
        if (await self.request("take")).get("granted") is not True:
            raise Refused("another viewer has control; wait, or ask for control in the page")

    async def next_frame(self) -> FramePacket:
        """Wait for the next frame, without time limit: a server sends one when something has changed.

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
            The server refused the scene, does not answer, or closed the connection. The present scene stays.
        """
        work = self._upload(files, progress, check_only=check_only)
        return await _in_time(work, _UPLOAD_SECONDS, "does not load the scene")

    async def edit(self, operation: Mapping[str, object], *, stroke: int = 0) -> dict[str, int]:
        """Edit the scene by an operation of ``voxrt edit`` (docs/edit.md), such as ``{"op": "undo"}``.

        Edits in a row of one stroke, 1 … 2**32 - 1, are undone together.

        Returns
        -------
        dict
            ``number`` of edits of the scene, ``undo`` and ``redo`` steps that there are, ``blocks`` that were written,
            ``words`` of the octree, and ``materials``, the number of entries of the material table.

        Raises
        ------
        Refused
            The server refused the edit, which changed nothing; or it does not answer, or closed the connection.
        """
        figures = (await self.request("edit", operation=operation, stroke=stroke)).get("edit")
        if not isinstance(figures, dict):
            raise _not_understood()
        return {name: _whole(figures, name) for name in ("number", "undo", "redo", "blocks", "words", "materials")}

    async def save(self, suffix: str = ".mem") -> dict[str, bytes]:
        """Fetch the scene as it is now: the files of a ``.mem``, ``.blob`` or ``.vox`` by their names.

        Raises
        ------
        Refused
            The server refused, does not answer, or closed the connection; or a file was damaged.
        """
        answer = await _in_time(self.request("save", suffix=suffix), _UPLOAD_SECONDS, "does not save the scene")
        files, number, data = answer.get("files"), self._requests, bytearray()
        if not isinstance(files, list) or not all(isinstance(file, dict) for file in files):
            raise _not_understood()
        size = sum(_whole(file, "size") for file in files)
        while len(data) < size:
            request = await self.send("part", offset=len(data))
            self._part = None
            while self._part is None:
                message = await _in_time(self._receive(), _ANSWER_SECONDS, "does not answer")
                if message is not None and message.get("request") == request:
                    raise Refused(shown_line(message.get("problem")))
            if (self._part.upload, self._part.offset) != (number, len(data)):
                raise _not_understood()
            data += self._part.data
        saved, at = {}, 0
        for file in files:
            name, end = shown_line(file.get("name")), at + _whole(file, "size")
            saved[name] = bytes(data[at:end])
            if zlib.crc32(saved[name]) != _whole(file, "crc32"):
                raise Refused(f"{name} was damaged in transit (CRC-32); save it again")
            at = end
        return saved

    async def _upload(self, files: Mapping[str, bytes], progress: Progress, *, check_only: bool) -> dict[str, Any]:
        announced = [{"name": name, "size": len(data), "crc32": zlib.crc32(data)} for name, data in files.items()]
        ready = await self.request("upload", files=announced, check_only=check_only)
        number, data = self._requests, b"".join(files.values())
        received = 0
        for offset in range(0, len(data), CHUNK_LIMIT):
            while offset - received >= _WINDOW * CHUNK_LIMIT:
                received = _whole(await self._answer(number), "bytes")
                progress("send", received, len(data))
            chunk = Chunk(_whole(ready, "upload"), offset, data[offset : offset + CHUNK_LIMIT])
            await self._send(pack_chunk(chunk))
        while True:
            answer = await self._answer(number)
            if answer["type"] == "done":
                return answer
            if answer["type"] == "received":
                progress("send", _whole(answer, "bytes"), len(data))
            elif answer["type"] == "progress":
                progress(shown_line(answer.get("stage"), 40), _whole(answer, "done"), _whole(answer, "total"))

    async def _answer(self, number: int) -> dict[str, Any]:
        return await _in_time(self._answer_without_limit(number), _ANSWER_SECONDS, "does not answer")

    async def _answer_without_limit(self, number: int) -> dict[str, Any]:
        while True:
            message = await self._receive()
            if message is not None and message.get("request") == number:
                if message["type"] == "refused":
                    raise Refused(shown_line(message.get("problem")))
                return message

    async def _send(self, message: str | bytes) -> None:
        try:
            await _in_time(self._connection.send(message), _ANSWER_SECONDS, "reads nothing")
        except (WebSocketException, OSError) as error:
            raise _closed(error) from None

    async def _receive(self) -> dict[str, Any] | None:
        """Receive one message: keep a frame or a state, return an answer."""
        try:
            message = await self._connection.recv()
        except (WebSocketException, OSError, UnicodeDecodeError) as error:
            raise _closed(error) from None
        if isinstance(message, bytes) and message.startswith(CHUNK_MAGIC):
            self._part = unpack_chunk(message)
            return None
        if isinstance(message, bytes):
            self._frame = unpack_frame(message)
            return None
        answer = _read_message(message)
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
    address, token, place = _read_url(url)
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    try:
        connection = await connect(
            address,
            additional_headers=headers,
            compression=None,
            max_size=_MESSAGE_LIMIT,
            open_timeout=_OPEN_SECONDS,
            close_timeout=1,
            proxy=None,
        )
    except InvalidStatus as error:
        reason = shown_line((error.response.body or b"").decode("utf-8", "replace").strip())
        raise Refused(f"{place}: {reason or error}") from None
    except (OSError, WebSocketException, ValueError) as error:
        raise Refused(f"{place}: no frame server answers ({shown_line(error)}); start one: voxrt serve") from None
    async with _closing(connection):
        try:
            text = await _in_time(connection.recv(), _OPEN_SECONDS, "does not answer")
        except (WebSocketException, OSError, UnicodeDecodeError) as error:
            raise _closed(error) from None
        hello = _read_message(text)
        if hello.get("protocol") != PROTOCOL_VERSION:
            raise Refused(
                f"{place} has protocol version {shown_line(hello.get('protocol'), 40)} and this client "
                f"{PROTOCOL_VERSION}; upgrade the older one"
            )
        device = hello.get("device")
        if not isinstance(device, dict):
            raise _not_understood()
        for field in ("capacity", "depth"):
            _whole(device, field)
        device["name"] = shown_line(device.get("name"), 100)
        yield FrameClient(connection, hello)


@asynccontextmanager
async def _closing(connection: ClientConnection) -> AsyncIterator[None]:
    """Close a connection at the end; what goes wrong then is no error."""
    try:
        yield
    finally:
        with contextlib.suppress(WebSocketException, OSError):
            await connection.close()


def _read_url(url: str) -> tuple[str, str, str]:
    """Return the address of the WebSocket, the token and the host with its port."""
    try:
        parts = urlsplit(url if "//" in url else f"http://{url}")
        usable = parts.scheme in _SCHEMES and bool(parts.hostname) and (parts.port is None or parts.port > 0)
    except ValueError:
        usable = False
    if not usable:
        raise Refused(f"{shown_line(url, 200)}: is no address such as http://127.0.0.1:8000/")
    token = parse_qs(parts.fragment or parts.query).get("token", [""])[0]
    if not token.isascii() or not token.isprintable():
        raise Refused("the token has characters that no token has; copy the address that the server printed")
    return f"{_SCHEMES[parts.scheme]}://{parts.netloc}/v{PROTOCOL_VERSION}", token, parts.netloc


async def _in_time(work: Awaitable[Result], seconds: float, problem: str) -> Result:
    try:
        return await asyncio.wait_for(work, seconds)
    except TimeoutError:
        raise Refused(f"the server {problem} within {seconds:.0f} s; it may be gone, or be no frame server") from None


def _read_message(text: object) -> dict[str, Any]:
    try:
        message = json.loads(text) if isinstance(text, str) else None
    except (ValueError, RecursionError):
        message = None
    if not isinstance(message, dict) or not isinstance(message.get("type"), str):
        raise _not_understood()
    return message


def _whole(message: dict[str, Any], field: str) -> int:
    value = message.get(field)
    if type(value) is not int or not 0 <= value < 1 << 32:
        raise _not_understood()
    return value


def _not_understood() -> Refused:
    return Refused("the server sent what this client does not understand; check that it is a frame server of voxrt")


def _closed(error: Exception) -> Refused:
    return Refused(f"the server closed the connection ({shown_line(error)}); it still shows its present scene")
