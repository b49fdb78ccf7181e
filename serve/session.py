"""One viewer's visit: what it asks, and what it is told."""

from __future__ import annotations

import asyncio
import time
from functools import partial
from typing import TYPE_CHECKING, Any

from ..board.errors import DeviceError, Refused
from .packets import unpack_chunk
from .receiving import Receiving
from .requests import (
    Cancel,
    ReadCounters,
    ReadRegisters,
    Release,
    ShowScene,
    Take,
    Upload,
    ViewChange,
    read_request,
    request_number,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from ..board.scene import Scene
    from ..board.scene_memory import Progress
    from .clients import Viewer
    from .requests import Request
    from .show import Show

_PROGRESS_SECONDS = 0.05


class Session:
    """Answers one viewer.

    Parameters
    ----------
    show
        What it watches.
    viewer
        The viewer, as the audience knows it.
    start
        Starts a task that outlives the visit.
    """

    def __init__(self, show: Show, viewer: Viewer, start: Callable[[Coroutine[Any, Any, None]], None]) -> None:
        self._show = show
        self._viewer = viewer
        self._start = start
        self._receiving: Receiving | None = None

    async def hear(self, message: str | bytes) -> None:
        """Do what a message asks and answer it; nothing that it may hold raises."""
        number = 0
        try:
            if isinstance(message, bytes):
                number = self._receiving.number if self._receiving else 0
                self._hear_chunk(message)
            else:
                number = request_number(message)
                number, request = read_request(message)
                await self._do(number, request)
        except (Refused, DeviceError) as error:
            self._viewer.answer({"type": "refused", "request": number, "problem": str(error)})

    def leave(self) -> None:
        """End the visit: an unfinished upload is forgotten, control passes on."""
        self._receiving = None
        self._show.handover.leave(self._viewer.number)

    async def _do(self, number: int, request: Request) -> None:
        show, viewer = self._show, self._viewer
        answer: dict[str, Any] = {"type": "done", "request": number}
        match request:
            case Take():
                answer["granted"] = show.handover.take(viewer.number)
                show.audience.refresh()
            case Release():
                show.handover.leave(viewer.number)
                show.audience.refresh()
            case ReadRegisters():
                answer["registers"] = dict(await show.stage.read_registers())
            case ReadCounters():
                answer["counters"] = show.counters()
            case Cancel():
                self._receiving = None
            case ViewChange():
                self._steer()
                show.stage.change(request, viewer.number, number)
                show.audience.refresh()
            case ShowScene():
                self._steer()
                self._start(self._put_on(number, partial(show.put_on_listed, request.scene)))
                return
            case Upload():
                self._steer()
                self._receiving = Receiving(number, request)
                answer = {"type": "ready", "request": number, "upload": number}
        viewer.answer(answer)

    def _hear_chunk(self, message: bytes) -> None:
        receiving = self._receiving
        if receiving is None:
            raise Refused("a chunk came and no upload is under way; announce it first")
        try:
            self._steer()
            receiving.add(unpack_chunk(message))
            files = receiving.files() if receiving.complete else None
        except Refused:
            self._receiving = None
            raise
        self._viewer.answer({"type": "received", "request": receiving.number, "bytes": receiving.received})
        if files is not None:
            self._receiving = None
            put_on = partial(self._show.put_on_files, files, check_only=receiving.upload.check_only)
            self._start(self._put_on(receiving.number, put_on))

    def _steer(self) -> None:
        if not self._show.handover.use(self._viewer.number):
            raise Refused("another viewer steers, or nobody; take control first")

    async def _put_on(self, number: int, put_on: Callable[..., Coroutine[Any, Any, Scene]]) -> None:
        steers = partial(self._show.handover.use, self._viewer.number)
        try:
            scene = await put_on(progress=self._progress(number), allowed=steers)
        except (Refused, DeviceError) as error:
            self._viewer.answer({"type": "refused", "request": number, "problem": str(error)})
            return
        described = {"name": scene.name, "depth": scene.depth, "words": len(scene.words), "crc32": scene.crc32}
        self._viewer.answer({"type": "done", "request": number, "scene": described})

    def _progress(self, number: int) -> Progress:
        """Make what the threads that read and write call: tells the viewer, now and then and each new stage."""
        loop = asyncio.get_running_loop()
        last_stage, last_time = "", 0.0

        def tell(stage: str, done: int, total: int) -> None:
            nonlocal last_stage, last_time
            now = time.monotonic()
            if stage != last_stage or done == total or now - last_time >= _PROGRESS_SECONDS:
                last_stage, last_time = stage, now
                message = {"type": "progress", "request": number, "stage": stage, "done": done, "total": total}
                loop.call_soon_threadsafe(self._viewer.answer, message)

        return tell
