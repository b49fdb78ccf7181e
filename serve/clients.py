"""The connected clients, and what waits to be sent to each.

Every client receives at its own speed. A slow one misses frames and states, and no other client waits for it.
"""

from __future__ import annotations

import asyncio
import json
from collections import deque
from typing import TYPE_CHECKING, Any, Protocol

from .packets import pack_frame

if TYPE_CHECKING:
    from collections.abc import Callable

    from .packets import FramePacket

_BACKLOG_LIMIT = 256  # answers that a client may leave unread


class Connection(Protocol):
    """The connection to a client."""

    async def send(self, message: str | bytes) -> None:
        """Send a message, and wait until the connection accepts another."""


class Client:
    """The output queue of one client: its answers, a flag for a changed state, and the newest frame.

    Parameters
    ----------
    number
        The client's number, counted from 1.
    on_ready
        Called when the queued frame is sent and another may follow.
    describe_state
        Returns the present state of the session.
    """

    def __init__(self, number: int, on_ready: Callable[[], None], describe_state: Callable[[], dict[str, Any]]) -> None:
        self.number = number
        self.dropped_frames = 0
        self.backlog_exceeded = False
        self._on_ready = on_ready
        self._describe_state = describe_state
        self._answers: deque[str] = deque()
        self._state_changed = False
        self._frame: bytes | None = None
        self._work = asyncio.Event()

    @property
    def ready(self) -> bool:
        """Whether it can take a frame: none is queued."""
        return self._frame is None

    def queue_frame(self, frame: bytes) -> None:
        """Send this frame next; it replaces a queued one."""
        if self._frame is not None:
            self.dropped_frames += 1
        self._frame = frame
        self._work.set()

    def queue_answer(self, message: dict[str, Any]) -> None:
        """Send a message after all queued answers."""
        if len(self._answers) >= _BACKLOG_LIMIT:
            self.backlog_exceeded = True
        else:
            self._answers.append(json.dumps(message, separators=(",", ":")))
        self._work.set()

    def queue_state(self) -> None:
        """Send the state of the session, as it is when its turn comes."""
        self._state_changed = True
        self._work.set()

    async def send_all(self, connection: Connection) -> None:
        """Send what is queued, without end; return when too many answers are unread."""
        while not self.backlog_exceeded:
            if self._answers:
                await connection.send(self._answers.popleft())
            elif self._state_changed:
                self._state_changed = False
                await connection.send(json.dumps(self._describe_state(), separators=(",", ":")))
            elif self._frame is not None:
                frame, self._frame = self._frame, None
                self._on_ready()
                await connection.send(frame)
            else:
                self._work.clear()
                await self._work.wait()


class Clients:
    """All connected clients of a server.

    Parameters
    ----------
    describe_state
        Returns the present state of the session.
    """

    def __init__(self, describe_state: Callable[[], dict[str, Any]]) -> None:
        self._describe_state = describe_state
        self._clients: dict[int, Client] = {}
        self._added = 0
        self._newest_frame: bytes | None = None
        self._client_ready = asyncio.Event()
        self._dropped_for_removed = 0

    def __len__(self) -> int:
        return len(self._clients)

    @property
    def dropped_frames(self) -> int:
        """Frames that were not sent because a client was too slow, summed over all clients."""
        return self._dropped_for_removed + sum(client.dropped_frames for client in self._clients.values())

    def add(self) -> Client:
        """Add a client; it gets the state and the newest frame at once."""
        self._added += 1
        client = Client(self._added, self._client_ready.set, self._describe_state)
        self._clients[client.number] = client
        if self._newest_frame is not None:
            client.queue_frame(self._newest_frame)
        else:
            self._client_ready.set()
        self.queue_state()
        return client

    def remove(self, client: Client) -> None:
        """Remove a client."""
        del self._clients[client.number]
        self._dropped_for_removed += client.dropped_frames
        self.queue_state()

    def queue_state(self) -> None:
        """Send the changed state of the session to all clients."""
        for client in self._clients.values():
            client.queue_state()

    def queue_frame(self, packet: FramePacket) -> None:
        """Send a frame to all clients."""
        self._newest_frame = pack_frame(packet)
        for client in self._clients.values():
            client.queue_frame(self._newest_frame)

    async def wait_until_ready(self) -> None:
        """Wait until some client can take a frame."""
        while not any(client.ready for client in self._clients.values()):
            self._client_ready.clear()
            await self._client_ready.wait()
