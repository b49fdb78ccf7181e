"""Connections that read no more than their limits permit, and that buffer no more than a few messages."""

from __future__ import annotations

import asyncio
import time
from typing import TYPE_CHECKING, Any, cast

from msgspec import field
from websockets.asyncio.server import ServerConnection
from websockets.frames import DATA_OPCODES, CloseCode, Frame, Opcode

from voxrt.serve.rate_limiter import RateLimiter
from voxrt.serve.strangers import network
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.serve.server_options import Limits
    from voxrt.serve.strangers import Strangers

_PIECE, _LARGE_PIECE = 1 << 12, 1 << 16  # bytes that are read before the limits are looked at
_FEW_FRAMES = 4  # in a piece: the next one may be larger
TEXT_LIMIT = 1 << 16
"""Bytes of the longest text message: an upload of 64 files with long names fits."""

_BUFFER_LIMIT = 1 << 20  # bytes to be sent; messages wait above 32 KiB, so that only answers to pings come so far


class _GatedTransport:
    """A transport with two reasons not to read: the queue of messages is full, or a limit is exceeded.

    Parameters
    ----------
    transport
        The connection's transport.
    on_open
        Called when no reason is left.
    """

    def __init__(self, transport: asyncio.Transport, on_open: Callable[[], None]) -> None:
        self._transport = transport
        self._on_open = on_open
        self._loop = asyncio.get_running_loop()
        self._queue_full = self._held = False

    def __getattr__(self, name: str) -> Any:  # noqa: ANN401 - as the transport's attribute is
        return getattr(self._transport, name)

    @property
    def closed(self) -> bool:
        """Whether nothing may be read now."""
        return self._queue_full or self._held

    def write(self, data: bytes) -> None:
        if not self._transport.is_closing():  # else asyncio logs a line for each of many writes
            self._transport.write(data)

    def pause_reading(self) -> None:
        self._queue_full = True
        self._transport.pause_reading()

    def resume_reading(self) -> None:
        self._queue_full = False
        self._loop.call_soon(self._open)

    def hold(self, seconds: float) -> None:
        self._held = True
        self._transport.pause_reading()
        self._loop.call_later(seconds, self._release)

    def _release(self) -> None:
        self._held = False
        self._open()

    def _open(self) -> None:
        if not self.closed:
            self._on_open()
        if not self.closed:
            self._transport.resume_reading()


class ConnectionGuard(Value, frozen=True):
    """What all connections of a server share.

    Attributes
    ----------
    limits
        The limits of each connection and of all together. A connection that exceeds the rates waits. One that sends
        too many fragments or leaves too many answers to pings unread is aborted.
    strangers
        Counts the connections of each address.
    connections
        The open connections.
    """

    limits: Limits
    strangers: Strangers
    connections: set[LimitedConnection] = field(default_factory=set)


class LimitedConnection(ServerConnection):
    """A connection within limits; the arguments after `guard` are those of websockets."""

    def __init__(self, guard: ConnectionGuard, *arguments: Any, **options: Any) -> None:  # noqa: ANN401
        super().__init__(*arguments, **options)
        self._guard = guard
        self._bytes = RateLimiter(guard.limits.bytes_per_second, time.monotonic)
        self._frames = RateLimiter(guard.limits.frames_per_second, time.monotonic)
        self._texts = RateLimiter(guard.limits.text_bytes_per_second, time.monotonic)
        self._new_frames = self._new_text = self._fragments = 0
        self._text: int | None = None  # bytes of the text message that is arriving
        self._unread = bytearray()
        self._piece = _PIECE
        self._address: str | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Admit it, or abort it at once."""
        self._gate = _GatedTransport(cast("asyncio.Transport", transport), self._read_on)
        super().connection_made(cast("asyncio.Transport", self._gate))
        self._guard.connections.add(self)
        address = network(transport.get_extra_info("peername"))
        if self._guard.strangers.admit(address):
            self._address = address
        if self._address is None or len(self._guard.connections) > self._guard.limits.connections:
            self.transport.abort()

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget it."""
        self._guard.connections.discard(self)
        self._unread.clear()
        self.accept()
        super().connection_lost(exc)

    def accept(self) -> None:
        """Count it among the strangers no more."""
        if self._address is not None:
            self._guard.strangers.leave(self._address)
            self._address = None

    def data_received(self, data: bytes) -> None:
        """Read as much as the limits permit, and keep the rest."""
        self._unread += data
        self._read_on()

    def process_event(self, event: Any) -> None:  # noqa: ANN401 - a request or a frame
        """Count a frame."""
        if isinstance(event, Frame):
            self._new_frames += 1
            if event.opcode in DATA_OPCODES:
                self._fragments = 0 if event.fin else self._fragments + 1
                self._count_text(event)
            if self._fragments > self._guard.limits.fragments:
                self.transport.abort()
            if self._text is not None and self._text > TEXT_LIMIT:
                self.protocol.fail(CloseCode.MESSAGE_TOO_BIG, f"a text message has more than {TEXT_LIMIT} bytes")
                self.send_data()
                return
        super().process_event(event)

    def _count_text(self, frame: Frame) -> None:
        """Text costs far more to read than the chunks of files."""
        if frame.opcode is not Opcode.CONT:
            self._text = 0 if frame.opcode is Opcode.TEXT else None
        if self._text is not None:
            self._text += len(frame.data)
            self._new_text += len(frame.data)

    def _read_on(self) -> None:
        while self._unread and not self._gate.closed and not self.transport.is_closing():
            piece = bytes(self._unread[: self._piece])
            del self._unread[: self._piece]
            super().data_received(piece)
            if self.transport.get_write_buffer_size() > _BUFFER_LIMIT:
                self.transport.abort()
            wait = max(
                self._bytes.charge(len(piece)),
                self._frames.charge(self._new_frames),
                self._texts.charge(self._new_text),
            )
            self._piece = min(2 * self._piece, _LARGE_PIECE) if self._new_frames <= _FEW_FRAMES else _PIECE
            self._new_frames = self._new_text = 0
            if wait > 0:
                self._gate.hold(wait)
