"""The handler of one client's messages."""

from __future__ import annotations

import asyncio
import time
from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any

from ..board.errors import DeviceError, Refused
from .packets import unpack_chunk
from .ray_cast import cast_ray
from .requests import (
    CancelUpload,
    CastRay,
    ChangeView,
    LoadScene,
    ReadCounters,
    ReadRegisters,
    ReleaseControl,
    StartUpload,
    TakeControl,
    read_request,
    request_number,
)
from .upload import Upload

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from ..board.scene import Scene
    from ..board.scene_memory import Progress
    from .clients import Client
    from .requests import Request
    from .session import Session

_PROGRESS_SECONDS = 0.05


class RequestHandler:
    """Handles the requests of one client.

    Parameters
    ----------
    session
        The session of the server.
    client
        The client; it gets the answers.
    start_task
        Starts a task that goes on after the client has disconnected.
    """

    def __init__(
        self, session: Session, client: Client, start_task: Callable[[Coroutine[Any, Any, None]], None]
    ) -> None:
        self._session = session
        self._client = client
        self._start_task = start_task
        self._upload: Upload | None = None

    async def handle(self, message: str | bytes) -> None:
        """Do what a message requests, and answer it. No message makes this raise an error."""
        number = 0
        try:
            if isinstance(message, bytes):
                number = self._upload.number if self._upload else 0
                self._handle_chunk(message)
            else:
                number = request_number(message)
                number, request = read_request(message)
                await self._handle_request(number, request)
        except (Refused, DeviceError) as error:
            self._client.queue_answer({"type": "refused", "request": number, "problem": str(error)})

    def close(self) -> None:
        """Discard an incomplete upload, and release control."""
        self._upload = None
        self._session.control.release(self._client.number)

    async def _handle_request(self, number: int, request: Request) -> None:
        session, client = self._session, self._client
        answer: dict[str, Any] = {"type": "done", "request": number}
        match request:
            case TakeControl():
                answer["granted"] = session.control.request(client.number)
                session.clients.queue_state()
            case ReleaseControl():
                session.control.release(client.number)
                session.clients.queue_state()
            case ReadRegisters():
                answer["registers"] = dict(await session.renderer.read_registers())
            case CastRay():
                self._require_control()
                cast = partial(cast_ray, session.renderer.scene, request.origin, request.direction)
                hit = await asyncio.get_running_loop().run_in_executor(None, cast)
                answer["hit"] = None if hit is None else asdict(hit)
            case ReadCounters():
                answer["counters"] = session.counters()
            case CancelUpload():
                self._upload = None
            case ChangeView():
                self._require_control()
                session.renderer.change_view(request, client.number, number)
                session.clients.queue_state()
            case LoadScene():
                self._require_control()
                self._start_task(self._load(number, partial(session.load_named, request.scene)))
                return
            case StartUpload():
                self._require_control()
                self._upload = Upload(number, request)
                answer = {"type": "ready", "request": number, "upload": number}
        client.queue_answer(answer)

    def _handle_chunk(self, message: bytes) -> None:
        upload = self._upload
        if upload is None:
            raise Refused("a chunk came without an upload; announce the upload first")
        try:
            self._require_control()
            upload.add(unpack_chunk(message))
            files = upload.files() if upload.complete else None
        except Refused:
            self._upload = None
            raise
        self._client.queue_answer({"type": "received", "request": upload.number, "bytes": upload.received})
        if files is not None:
            self._upload = None
            load = partial(self._session.load_files, files, check_only=upload.announced.check_only)
            self._start_task(self._load(upload.number, load))

    def _require_control(self) -> None:
        if not self._session.control.use(self._client.number):
            raise Refused("this viewer does not have control; take control first")

    async def _load(self, number: int, load: Callable[..., Coroutine[Any, Any, Scene]]) -> None:
        has_control = partial(self._session.control.use, self._client.number)
        try:
            scene = await load(progress=self._progress(number), allowed=has_control)
        except (Refused, DeviceError) as error:
            self._client.queue_answer({"type": "refused", "request": number, "problem": str(error)})
            return
        described = {"name": scene.name, "depth": scene.depth, "words": len(scene.words), "crc32": scene.crc32}
        self._client.queue_answer({"type": "done", "request": number, "scene": described})

    def _progress(self, number: int) -> Progress:
        """Make a function that other threads call, and that sends progress to the client from time to time."""
        loop = asyncio.get_running_loop()
        last_stage, last_time = "", 0.0

        def send_progress(stage: str, done: int, total: int) -> None:
            nonlocal last_stage, last_time
            now = time.monotonic()
            if stage != last_stage or done == total or now - last_time >= _PROGRESS_SECONDS:
                last_stage, last_time = stage, now
                message = {"type": "progress", "request": number, "stage": stage, "done": done, "total": total}
                loop.call_soon_threadsafe(self._client.queue_answer, message)

        return send_progress
