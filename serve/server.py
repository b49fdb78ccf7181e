"""The frame server: the page over HTTP, and frames and requests over WebSocket, on one port."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import socket
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Response

from ..board.errors import Refused
from .admission import Bucket, Gate, Limits, is_loopback
from .original import LegacyServer
from .packets import CHUNK_HEADER, CHUNK_LIMIT
from .page_files import HEADERS, page_files
from .session import Session
from .show import PROTOCOL, Program, Show

if TYPE_CHECKING:
    from collections.abc import Coroutine

    from websockets.http11 import Request

    from ..board.device import Device
    from .clients import Viewer

WEBSOCKET_PATH = f"/v{PROTOCOL}"
_SEND_BUFFER = 1 << 19  # bytes that the system keeps for a viewer: half a frame, so that slow viewers see new ones
_LOG = logging.getLogger("voxrt.board")


@dataclass(frozen=True, slots=True)
class Listening:
    """Where a server listens, and to whom.

    Attributes
    ----------
    host, port
        Address and TCP port; 0 takes a free one.
    token
        What viewers must know; needed on every address that is not loopback.
    origins
        Origins of pages besides the server's own that may connect.
    legacy_port
        Port of the adapter for the original's desktop client; None leaves it out.
    limits
        What the server bears.
    """

    host: str = "127.0.0.1"
    port: int = 0
    token: str | None = None
    origins: tuple[str, ...] = ()
    legacy_port: int | None = None
    limits: Limits = field(default_factory=Limits)


class FrameServer:
    """Serves one device; an asynchronous context manager that listens while it is entered.

    Parameters
    ----------
    device
        The ray tracer; closed at the end.
    program
        What can be put on.
    listening
        Where.

    Raises
    ------
    Refused
        The address is not loopback and there is no token.
    """

    def __init__(self, device: Device, program: Program, listening: Listening) -> None:
        if listening.token is None and not is_loopback(listening.host):
            raise Refused(f"{listening.host} can be reached from other machines; give a token, or listen on 127.0.0.1")
        self.show = Show(device, program)
        self.refused = 0
        self.sockets: set[ServerConnection] = set()
        self._listening = listening
        self._gate = Gate(listening.token, listening.origins)
        self._arrivals = Bucket(listening.limits.arrivals, time.monotonic)
        self._tasks: set[asyncio.Task[None]] = set()
        self._exit = contextlib.AsyncExitStack()
        self._server: Server | None = None
        self._legacy: LegacyServer | None = None

    @property
    def port(self) -> int:
        """The port that it listens on."""
        assert self._server is not None
        return int(next(iter(self._server.sockets)).getsockname()[1])

    @property
    def legacy_port(self) -> int | None:
        """The port of the adapter for the original's desktop client."""
        return None if self._legacy is None else self._legacy.port

    @property
    def url(self) -> str:
        """The page's address, with the token where there is one."""
        host = f"[{self._listening.host}]" if ":" in self._listening.host else self._listening.host
        token = f"#token={self._listening.token}" if self._listening.token else ""
        return f"http://{host}:{self.port}/{token}"

    async def __aenter__(self) -> FrameServer:  # noqa: PYI034 - Self needs Python 3.11
        async with contextlib.AsyncExitStack() as stack:
            stack.callback(self.show.close)
            stack.push_async_callback(self._end_tasks)
            if self._listening.legacy_port is not None:
                self._legacy = LegacyServer(self.show.stage)
                await stack.enter_async_context(self._legacy.listen(self._listening.host, self._listening.legacy_port))
            self._server = await stack.enter_async_context(
                serve(
                    self._receive,
                    self._listening.host,
                    self._listening.port,
                    process_request=self._answer_http,
                    create_connection=self._connection_class(),
                    compression=None,
                    server_header=None,
                    open_timeout=self._listening.limits.patience,
                    close_timeout=1,
                    ping_interval=10,
                    ping_timeout=20,
                    max_size=CHUNK_HEADER + CHUNK_LIMIT,
                    max_queue=4,
                    logger=_quiet_logger(),
                )
            )
            self._start(self.show.run())
            self._exit = stack.pop_all()
        return self

    async def __aexit__(self, *_exception: object) -> None:
        await self._exit.aclose()

    def _start(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._ended)

    def _ended(self, task: asyncio.Task[None]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and task.exception() is not None:
            _LOG.error("a task of the frame server failed; please report this", exc_info=task.exception())

    async def _end_tasks(self) -> None:
        tasks = tuple(self._tasks)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def _connection_class(self) -> type[ServerConnection]:
        limit, alive = self._listening.limits.sockets, self.sockets

        class Connection(ServerConnection):
            """One that is cut off at once when there are too many, so that unfinished ones cannot pile up."""

            def connection_made(self, transport: asyncio.BaseTransport) -> None:
                super().connection_made(transport)
                alive.add(self)
                if len(alive) > limit:
                    self.transport.abort()

            def connection_lost(self, exc: Exception | None) -> None:
                alive.discard(self)
                super().connection_lost(exc)

        return Connection

    def _answer_http(self, connection: ServerConnection, request: Request) -> Response | None:
        path = request.path.partition("?")[0]
        if path != WEBSOCKET_PATH:
            file = page_files().get(path)
            if file is None:
                return connection.respond(404, "there is no such page; the picture is at /\n")
            headers = Headers(HEADERS)
            headers["Content-Type"] = file.media_type
            headers["Content-Length"] = str(len(file.data))
            headers["Connection"] = "close"
            return Response(200, "OK", headers, file.data)
        refusal = self._gate.judge(
            request.path, request.headers.get("Authorization"), request.headers.get("Origin"), connection.local_address
        )
        if refusal is not None:
            self.refused += 1
            return connection.respond(refusal.status, refusal.text)
        if len(self.show.audience) >= self._listening.limits.viewers or self._arrivals.take() > 0:
            self.refused += 1
            response = connection.respond(503, "too many viewers; try again in a moment\n")
            response.headers["Retry-After"] = "2"
            return response
        return None

    async def _receive(self, connection: ServerConnection) -> None:
        if len(self.show.audience) >= self._listening.limits.viewers:
            await connection.close(1013, "too many viewers")
            return
        raw: socket.socket | None = connection.transport.get_extra_info("socket")
        if raw is not None:
            raw.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER)
        viewer = self.show.audience.join()
        session = Session(self.show, viewer, self._start)
        viewer.answer(self.show.hello(viewer.number))
        tasks = {
            asyncio.ensure_future(viewer.send_all(connection)),
            asyncio.ensure_future(self._hear_all(connection, viewer, session)),
        }
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            if viewer.overrun:
                await connection.close(1008, "answers are not read")
        finally:
            session.leave()
            self.show.audience.leave(viewer)
            for task in tasks:
                task.cancel()
            for result in await asyncio.gather(*tasks, return_exceptions=True):
                if isinstance(result, Exception) and not isinstance(result, ConnectionClosed):
                    _LOG.error("a visit of the frame server failed; please report this", exc_info=result)

    async def _hear_all(self, connection: ServerConnection, viewer: Viewer, session: Session) -> None:
        bucket = Bucket(self._listening.limits.requests, time.monotonic)
        async for message in connection:
            if (wait := bucket.take()) > 0:
                await asyncio.sleep(wait)  # the line fills up behind, and the client must wait too
                bucket.take()
            await session.hear(message)
            if viewer.overrun:
                return


def _quiet_logger() -> logging.Logger:
    # What strangers send is no fault of the server; its own faults are reported above.
    logger = logging.getLogger("voxrt.board.websockets")
    logger.setLevel(logging.CRITICAL)
    return logger
