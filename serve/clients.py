"""The connected clients, and what waits to be sent to each.

Every client receives at its own speed. A slow one misses frames and states, and no other client waits for it. One that
receives too slowly, or nothing, is dropped.
"""

from __future__ import annotations

import asyncio
import json
import time
from collections import deque
from typing import TYPE_CHECKING, Any, Protocol

from voxrt.serve.packets import pack_frame

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from voxrt.serve.packets import FramePacket
    from voxrt.serve.server_options import Limits

_BACKLOG_LIMIT = 256  # answers that a client may leave unread
_PARTS_LIMIT = 4  # parts of files that a client may leave unread
_FRAGMENT = 1 << 18  # bytes; a connection copies and buffers no more of a frame
_STATE_SECONDS = 0.05  # between two states


class Connection(Protocol):
    """The connection to a client."""

    async def send(self, message: str | bytes | Iterable[memoryview]) -> None:
        """Send a message, whole or in fragments, and wait until the connection accepts another."""


class Client:
    """The output queue of one client: its answers, a flag for a changed state, and the newest frame.

    Parameters
    ----------
    number
        The client's number, counted from 1.
    on_ready
        Called when the queued frame is sent and another may follow.
    state_text
        Returns the message that describes the present state of the session.
    abort
        Aborts the connection.
    """

    def __init__(
        self, number: int, on_ready: Callable[[], None], state_text: Callable[[], str], abort: Callable[[], None]
    ) -> None:
        self.number = number
        self.dropped_frames = 0
        self.backlog_exceeded = False
        self.abort = abort
        self.sending_since: float | None = None
        self.sent: str | bytes = b""
        """What is being sent."""
        self._on_ready = on_ready
        self._state_text = state_text
        self._answers: deque[str | bytes] = deque()
        self._state_changed = False
        self._frame: bytes | None = None
        self._work = asyncio.Event()

    @property
    def ready(self) -> bool:
        """Whether it can take a frame: none is queued."""
        return self._frame is None

    @property
    def frames(self) -> Iterator[bytes]:
        """The frames that it keeps: the one that is being sent, and the queued one."""
        for frame in (self.sent, self._frame):
            if isinstance(frame, bytes):
                yield frame

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

    def queue_part(self, part: bytes) -> bool:
        """Send a part of a file after all queued answers; False where too many are unread."""
        if sum(isinstance(answer, bytes) for answer in self._answers) >= _PARTS_LIMIT:
            return False
        self._answers.append(part)
        self._work.set()
        return True

    def queue_state(self) -> None:
        """Send the state of the session, as it is when its turn comes."""
        self._state_changed = True
        self._work.set()

    async def send_all(self, connection: Connection) -> None:
        """Send what is queued, without end; return when too many answers are unread."""
        while not self.backlog_exceeded:
            if self._answers:
                await self._send(connection, self._answers.popleft())
            elif self._state_changed:
                self._state_changed = False
                await self._send(connection, self._state_text())
            elif self._frame is not None:
                frame, self._frame = self._frame, None
                self._on_ready()
                await self._send(connection, frame)
            else:
                self._work.clear()
                await self._work.wait()

    async def _send(self, connection: Connection, message: str | bytes) -> None:
        self.sending_since, self.sent = time.monotonic(), message
        if len(message) <= _FRAGMENT or isinstance(message, str):
            await connection.send(message)
        else:
            data = memoryview(message)
            await connection.send([data[at : at + _FRAGMENT] for at in range(0, len(data), _FRAGMENT)])
        self.sending_since, self.sent = None, b""


class Clients:
    """All connected clients of a server.

    Parameters
    ----------
    describe_state
        Returns the present state of the session.
    limits
        How long a client may take, and how many frames may be kept for clients.
    """

    def __init__(self, describe_state: Callable[[], dict[str, Any]], limits: Limits) -> None:
        self._describe_state = describe_state
        self._limits = limits
        self._clients: dict[int, Client] = {}
        self._added = 0
        self._newest_frame: bytes | None = None
        self._client_ready = asyncio.Event()
        self._dropped_for_removed = 0
        self._state_text: str | None = None
        self._state_time = 0.0
        self._state_timer: asyncio.TimerHandle | None = None

    def __len__(self) -> int:
        return len(self._clients)

    @property
    def dropped_frames(self) -> int:
        """Frames that were not sent because a client was too slow, summed over all clients."""
        return self._dropped_for_removed + sum(client.dropped_frames for client in self._clients.values())

    def add(self, abort: Callable[[], None]) -> Client:
        """Add a client, whose connection `abort` aborts; it gets the state and the newest frame at once."""
        self._added += 1
        client = Client(self._added, self._client_ready.set, self._newest_state, abort)
        self._clients[client.number] = client
        if self._newest_frame is not None:
            client.queue_frame(self._newest_frame)
        else:
            self._client_ready.set()
        client.queue_state()
        self.queue_state()
        return client

    def remove(self, client: Client) -> None:
        """Remove a client."""
        del self._clients[client.number]
        self._dropped_for_removed += client.dropped_frames
        self.queue_state()

    def queue_state(self) -> None:
        """Send the changed state of the session to all clients, at once or a moment after the last one."""
        self._state_text = None
        if self._state_timer is None:
            wait = self._state_time + _STATE_SECONDS - time.monotonic()
            if wait <= 0:
                self._send_state()
            else:
                self._state_timer = asyncio.get_running_loop().call_later(wait, self._send_state)

    def queue_frame(self, packet: FramePacket) -> None:
        """Send a frame to all clients."""
        self._newest_frame = pack_frame(packet)
        for client in self._clients.values():
            client.queue_frame(self._newest_frame)
        kept = {id(frame): len(frame) for client in self._clients.values() for frame in client.frames}
        if sum(kept.values()) > self._limits.frame_bytes:
            sending = [client for client in self._clients.values() if isinstance(client.sent, bytes) and client.sent]
            if sending:
                min(sending, key=lambda client: client.sending_since or 0.0).abort()

    def drop_slow(self) -> None:
        """Abort the connections of clients that exceed the time limit of sending."""
        now, limits = time.monotonic(), self._limits
        for client in self._clients.values():
            limit = limits.send_seconds + len(client.sent) / limits.send_bytes_per_second
            if client.sending_since is not None and now - client.sending_since > limit:
                client.abort()

    async def wait_until_ready(self) -> None:
        """Wait until some client can take a frame."""
        while not any(client.ready for client in self._clients.values()):
            self._client_ready.clear()
            await self._client_ready.wait()

    def _newest_state(self) -> str:
        if self._state_text is None:
            self._state_text = json.dumps(self._describe_state(), separators=(",", ":"))
        return self._state_text

    def _send_state(self) -> None:
        self._state_timer, self._state_time = None, time.monotonic()
        for client in self._clients.values():
            client.queue_state()
