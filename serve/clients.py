"""The viewers: each gets the newest of everything as fast as it takes it, and none waits for another."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from typing import TYPE_CHECKING, Any, Protocol

from .packets import pack_frame

if TYPE_CHECKING:
    from collections.abc import Callable

    from .packets import FramePacket

_ANSWERS = 256  # that a viewer may leave unread


class Line(Protocol):
    """The connection to a viewer."""

    async def send(self, message: str | bytes) -> None:
        """Send a message and wait until the line takes more."""


class Viewer:
    """What waits to be sent to one viewer: its answers, the state of the show, the newest frame.

    Parameters
    ----------
    number
        Which viewer of the server it is, from 1.
    took_frame
        Called when it begins to send a frame and could take another.
    describe
        Gives the state of the show as it is now.
    """

    def __init__(self, number: int, took_frame: Callable[[], None], describe: Callable[[], dict[str, Any]]) -> None:
        self.number = number
        self.dropped = 0
        self.overrun = False
        self._took_frame = took_frame
        self._describe = describe
        self._answers: deque[str] = deque()
        self._state_is_old = False
        self._frame: bytes | None = None
        self._news = asyncio.Event()

    @property
    def wants_frame(self) -> bool:
        """Whether no frame waits for it."""
        return self._frame is None

    def show(self, frame: bytes) -> None:
        """Let it see this frame next, and no older one."""
        if self._frame is not None:
            self.dropped += 1
        self._frame = frame
        self._news.set()

    def answer(self, message: dict[str, Any]) -> None:
        """Let it read a message, in order with other answers."""
        if len(self._answers) >= _ANSWERS:
            self.overrun = True
        else:
            self._answers.append(json.dumps(message, separators=(",", ":")))
        self._news.set()

    def refresh(self) -> None:
        """Let it know that the state of the show has changed."""
        self._state_is_old = True
        self._news.set()

    async def send_all(self, line: Line) -> None:
        """Send what there is, for ever; returns when the viewer has left too many answers unread."""
        while not self.overrun:
            if self._answers:
                await line.send(self._answers.popleft())
            elif self._state_is_old:
                self._state_is_old = False
                await line.send(json.dumps(self._describe(), separators=(",", ":")))
            elif self._frame is not None:
                frame, self._frame = self._frame, None
                self._took_frame()
                await line.send(frame)
            else:
                self._news.clear()
                await self._news.wait()


class Audience:
    """All viewers of a server.

    Parameters
    ----------
    describe
        Gives the state of the show as it is now.
    """

    def __init__(self, describe: Callable[[], dict[str, Any]]) -> None:
        self._describe = describe
        self._viewers: dict[int, Viewer] = {}
        self._joined = 0
        self._newest: bytes | None = None
        self._hungry = asyncio.Event()
        self.dropped_by_leavers = 0

    def __len__(self) -> int:
        return len(self._viewers)

    @property
    def dropped(self) -> int:
        """Frames that viewers were too slow for."""
        return self.dropped_by_leavers + sum(viewer.dropped for viewer in self._viewers.values())

    def join(self) -> Viewer:
        """Admit a viewer; it gets the state and the newest frame at once."""
        self._joined += 1
        viewer = Viewer(self._joined, self._hungry.set, self._describe)
        self._viewers[viewer.number] = viewer
        if self._newest is not None:
            viewer.show(self._newest)
        else:
            self._hungry.set()
        self.refresh()
        return viewer

    def leave(self, viewer: Viewer) -> None:
        """Forget a viewer."""
        del self._viewers[viewer.number]
        self.dropped_by_leavers += viewer.dropped
        self.refresh()

    def refresh(self) -> None:
        """Let all know that the state of the show has changed."""
        for viewer in self._viewers.values():
            viewer.refresh()

    def show(self, packet: FramePacket) -> None:
        """Let all see a frame."""
        self._newest = pack_frame(packet)
        for viewer in self._viewers.values():
            viewer.show(self._newest)

    async def hunger(self) -> None:
        """Wait until some viewer has no frame waiting, so that another is worth rendering."""
        while not any(viewer.wants_frame for viewer in self._viewers.values()):
            self._hungry.clear()
            await self._hungry.wait()
