"""The frame server: one port serves the page over HTTP, and frames and requests over WebSocket."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import socket
import time
from functools import partial
from typing import TYPE_CHECKING, Any, Self, cast
from urllib.parse import quote

from websockets.asyncio.server import Server, ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Response

from voxrt.board.errors import Refused
from voxrt.serve.access_control import AccessControl, is_loopback
from voxrt.serve.addresses import accepted_hosts, reachable_hosts
from voxrt.serve.legacy_server import LegacyServer
from voxrt.serve.limited_connection import ConnectionGuard, LimitedConnection
from voxrt.serve.log_limit import LogLimit
from voxrt.serve.packets import CHUNK_HEADER, CHUNK_LIMIT, PROTOCOL_VERSION
from voxrt.serve.page_files import HEADERS, load_page_files
from voxrt.serve.rate_limiter import RateLimiter
from voxrt.serve.request_handler import RequestHandler
from voxrt.serve.session import Session
from voxrt.serve.strangers import Strangers
from voxrt.serve.token import check_token

if TYPE_CHECKING:
    from collections.abc import Coroutine

    from websockets.http11 import Request

    from voxrt.board.device import Device
    from voxrt.serve.clients import Client
    from voxrt.serve.scene_library import SceneLibrary
    from voxrt.serve.server_options import ServerOptions

WEBSOCKET_PATH = f"/v{PROTOCOL_VERSION}"
_SEND_BUFFER = 1 << 19  # bytes per connection, about half a frame: a slow client then gets new frames, not queued ones
_CLOSE_SECONDS = 1.0  # that a closing handshake may take
_LOG = logging.getLogger("voxrt.serve")
_LOG.addFilter(LogLimit())


class FrameServer:
    """Serves one device; an asynchronous context manager that listens while it is entered.

    Parameters
    ----------
    device
        The ray tracer; closed at the end.
    library
        The scenes that can be loaded.
    options
        Where it listens, and who may connect.

    Raises
    ------
    Refused
        The address is not loopback and there is no token.
    """

    def __init__(self, device: Device, library: SceneLibrary, options: ServerOptions) -> None:
        if options.token is not None:
            check_token(options.token)
        elif not is_loopback(options.host):
            raise Refused(f"{options.host} can be reached from other machines; give a token, or listen on 127.0.0.1")
        self._hosts = reachable_hosts(options.host)
        self.session = Session(device, library, options.limits)
        self.refused = 0
        self._options = options
        self._access = AccessControl(options.token, options.origins, accepted_hosts(options.host))
        self._guard = ConnectionGuard(options.limits, Strangers(options.limits))
        self._new_clients = RateLimiter(options.limits.new_clients_per_second, time.monotonic)
        self._tasks: set[asyncio.Task[None]] = set()
        self._exit_stack = contextlib.AsyncExitStack()
        self._server: Server | None = None
        self._legacy: LegacyServer | None = None

    @property
    def connections(self) -> int:
        """Open connections, those without a complete handshake included."""
        return len(self._guard.connections)

    @property
    def port(self) -> int:
        """The TCP port on which it listens."""
        assert self._server is not None
        return int(next(iter(self._server.sockets)).getsockname()[1])

    @property
    def legacy_port(self) -> int | None:
        """The TCP port of the legacy protocol; None where it is off."""
        return None if self._legacy is None else self._legacy.port

    @property
    def urls(self) -> tuple[str, ...]:
        """The addresses of the page, with the token where there is one; the best one for other machines is first."""
        token = f"#token={quote(self._options.token, safe='')}" if self._options.token else ""
        hosts = [f"[{host}]" if ":" in host else host for host in self._hosts]
        return tuple(f"http://{host}:{self.port}/{token}" for host in hosts)

    @property
    def url(self) -> str:
        """The first of :attr:`urls`."""
        return self.urls[0]

    async def __aenter__(self) -> Self:
        async with contextlib.AsyncExitStack() as stack:
            stack.callback(self.session.close)
            stack.push_async_callback(self._cancel_tasks)
            if self._options.legacy_port is not None:
                self._legacy = LegacyServer(self.session.renderer)
                await stack.enter_async_context(self._legacy.listen(self._options.host, self._options.legacy_port))
            self._server = await stack.enter_async_context(
                serve(
                    self._serve_client,
                    self._options.host,
                    self._options.port,
                    process_request=self._answer_http,
                    create_connection=cast("type[ServerConnection]", partial(LimitedConnection, self._guard)),
                    compression=None,
                    server_header=None,
                    open_timeout=self._options.limits.handshake_seconds,
                    close_timeout=_CLOSE_SECONDS,
                    ping_interval=10,
                    ping_timeout=20,
                    max_size=CHUNK_HEADER + CHUNK_LIMIT,
                    max_queue=4,
                    logger=_quiet_logger(),
                )
            )
            self._start_task(self.session.run())
            self._start_task(self.session.watch())
            stack.callback(self._end_soon)
            self._exit_stack = stack.pop_all()
        return self

    async def __aexit__(self, *_exception: object) -> None:
        await self._exit_stack.aclose()

    def _end_soon(self) -> None:
        """End the frame in progress, and abort the connections that do not close soon."""
        self.session.stop()
        asyncio.get_running_loop().call_later(_CLOSE_SECONDS, self._abort_connections)

    def _abort_connections(self) -> None:
        for connection in tuple(self._guard.connections):
            connection.transport.abort()

    def _start_task(self, coroutine: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(coroutine)
        self._tasks.add(task)
        task.add_done_callback(self._finish_task)

    def _finish_task(self, task: asyncio.Task[None]) -> None:
        self._tasks.discard(task)
        if not task.cancelled() and task.exception() is not None:
            _LOG.error("a task of the frame server failed; please report this", exc_info=task.exception())

    async def _cancel_tasks(self) -> None:
        tasks = tuple(self._tasks)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def _answer_http(self, connection: ServerConnection, request: Request) -> Response | None:
        path = request.path.partition("?")[0]
        if path != WEBSOCKET_PATH:
            file = load_page_files().get(path)
            if file is None:
                return connection.respond(404, "there is no such page; open /\n")
            headers = Headers(HEADERS)
            headers["Content-Type"] = file.media_type
            headers["Content-Length"] = str(len(file.data))
            headers["Connection"] = "close"
            return Response(200, "OK", headers, file.data)
        for name in ("Host", "Origin", "Authorization"):
            if len(request.headers.get_all(name)) > 1:
                self.refused += 1
                return connection.respond(400, f"the header {name} comes more than once\n")
        origin = request.headers.get("Origin")
        if "Upgrade" not in request.headers and "Host" in request.headers:
            # The page asks why it was refused, which browsers do not tell it.
            host = request.headers["Host"]
            origin = f"https://{host}" if f"https://{host}" in self._access.origins else f"http://{host}"
        refusal = self._access.check(
            request.path, request.headers.get("Authorization"), origin, connection.local_address
        )
        if refusal is not None:
            self.refused += 1
            return connection.respond(refusal.status, refusal.text)
        if len(self.session.clients) >= self._options.limits.clients or not self._new_clients.acquire():
            self.refused += 1
            response = connection.respond(503, "too many viewers; try again in a moment\n")
            response.headers["Retry-After"] = "2"
            return response
        return None

    async def _serve_client(self, connection: ServerConnection) -> None:
        assert isinstance(connection, LimitedConnection)
        if len(self.session.clients) >= self._options.limits.clients:
            await connection.close(1013, "too many viewers")
            return
        raw: socket.socket | None = connection.transport.get_extra_info("socket")
        if raw is not None:
            raw.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _SEND_BUFFER)
        connection.accept()
        client = self.session.clients.add(connection.transport.abort)
        handler = RequestHandler(self.session, client, self._start_task)
        client.queue_answer(self.session.hello(client.number))
        tasks = {
            asyncio.ensure_future(client.send_all(connection)),
            asyncio.ensure_future(self._handle_requests(connection, client, handler)),
        }
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
            if client.backlog_exceeded:
                await connection.close(1008, "answers are not read")
        finally:
            handler.close()
            self.session.clients.remove(client)
            for task in tasks:
                task.cancel()
            for result in await asyncio.gather(*tasks, return_exceptions=True):
                if isinstance(result, Exception) and not isinstance(result, ConnectionClosed):
                    _LOG.error("a connection of the frame server failed; please report this", exc_info=result)

    async def _handle_requests(self, connection: ServerConnection, client: Client, handler: RequestHandler) -> None:
        async for message in connection:
            await handler.handle(message)
            if client.backlog_exceeded:
                return


def _quiet_logger() -> logging.Logger:
    # A malformed request is no fault of the server. Faults of the server are logged above.
    logger = logging.getLogger("voxrt.serve.websockets")
    logger.setLevel(logging.CRITICAL)
    return logger
