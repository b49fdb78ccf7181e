"""The ray tracer on a PYNQ board, by the agent that runs there: ``board/agent/voxrt_board.py`` has the protocol."""

from __future__ import annotations

import hmac
import socket
import struct
import threading
import time
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import numpy as np

from voxrt.board.errors import DeviceError
from voxrt.board.register_device import RegisterDevice

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from voxrt.board.register_writes import Writes

TOKEN_VARIABLE = "VOXRT_BOARD_TOKEN"  # noqa: S105 - the name of the variable that holds it
"""The environment variable that holds the token: a command line shows it to all users of a machine."""

_NOTHING, _REGISTERS, _READ, _WRITE, _EXPECT, _TAKE = range(6)
_MAGIC, _VERSION = b"VXRTAGNT", 1
_BURST = 1 << 16  # words per request
_PROBLEM_LIMIT = 500  # bytes
_CONNECT_SECONDS, _ANSWER_SECONDS, _KEEP_SECONDS = 10.0, 30.0, 15.0
_PAUSE_SECONDS = 0.0005


def open_tcp(address: str, token: str) -> RegisterDevice:
    """Connect to an agent and open the ray tracer behind it.

    Parameters
    ----------
    address
        ``tcp://BOARD:PORT``.
    token
        The token of the agent; empty if it has none.

    Raises
    ------
    DeviceError
        The agent does not answer, refuses the token, or serves another client; or its ray tracer is not supported.
    """
    link = AgentLink(address, token)
    try:
        return RegisterDevice(f"board at {link.name}", _Registers(link), _Memory(link), _Video(link), _pause)
    except BaseException:
        link.close()
        raise


class AgentLink:
    """The connection to an agent; :meth:`ask` may be called from any thread.

    Parameters
    ----------
    address, token
        As :func:`open_tcp` has them.

    Attributes
    ----------
    name
        Of the board, shown to users.
    memory_words, memory_base, size, width_step
        What the agent says of the board.
    """

    def __init__(self, address: str, token: str) -> None:
        host, port = _split(address)
        self.name = f"{host}:{port}"
        self._lock = threading.Lock()
        self._closed = threading.Event()
        try:
            self._socket = socket.create_connection((host, port), _CONNECT_SECONDS)
        except OSError as error:
            raise DeviceError(f"{self.name} does not answer ({error}); run voxrt-board on the board") from error
        try:
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            described = self._greet(token)
        except BaseException as error:
            self._socket.close()
            if isinstance(error, OSError):
                raise DeviceError(f"{self.name} is no agent of voxrt-board ({error}); name its port") from error
            raise
        self._socket.settimeout(_ANSWER_SECONDS)
        self.memory_words, base, columns, rows, self.width_step = struct.unpack("<5I", described)
        self.memory_base = base or None
        self.size = columns, rows
        threading.Thread(target=self._keep, daemon=True, name="keep the board").start()

    def ask(self, operation: int, a: int = 0, b: int = 0, data: bytes = b"", *, expected: int = 0) -> bytes:
        """Send a request and return its result, which has `expected` bytes.

        Raises
        ------
        DeviceError
            The agent refuses the request, or the connection is lost.
        """
        with self._lock:
            try:
                self._socket.sendall(struct.pack("<3I", operation, a, b) + data)
                return self._answer(expected)
            except DeviceError:
                raise
            except BaseException as error:
                self.close()  # the next answer would be another request's
                if isinstance(error, OSError):
                    raise DeviceError(
                        f"the connection to {self.name} is lost ({error}); see that voxrt-board runs, and start again"
                    ) from error
                raise

    def close(self) -> None:
        """Close the connection; another client may use the board then."""
        self._closed.set()
        self._socket.close()

    def _keep(self) -> None:
        """Show the agent that this client is there, until the connection is closed."""
        while not self._closed.wait(_KEEP_SECONDS):
            try:
                self.ask(_NOTHING)
            except DeviceError:
                return  # the next request says so

    def _greet(self, token: str) -> bytes:
        magic, version, nonce = struct.unpack("<8sI16s", self._receive(28))
        if (magic, version) != (_MAGIC, _VERSION):
            raise DeviceError(f"{self.name} is no agent of this version; install voxrt-board anew on the board")
        self._socket.sendall(hmac.digest(token.encode(), nonce, "sha256"))
        return self._answer(20)

    def _answer(self, expected: int) -> bytes:
        status, count = struct.unpack("<2I", self._receive(8))
        if count != expected if status == 0 else count > _PROBLEM_LIMIT:
            raise OSError(f"{count} bytes came instead of {expected}")
        data = self._receive(count)
        if status:
            raise DeviceError(f"{self.name}: {data.decode(errors='replace')}")
        return data

    def _receive(self, count: int) -> bytes:
        data = bytearray()
        while len(data) < count:
            part = self._socket.recv(count - len(data))
            if not part:
                raise OSError("it was closed there")
            data += part
        return bytes(data)


def _split(address: str) -> tuple[str, int]:
    try:
        parts = urlsplit(address)
        host, port = parts.hostname, parts.port
    except ValueError:
        host = port = None
    if host is None or port is None:
        raise DeviceError(f"{address} is no address of a board; name it as tcp://BOARD:PORT")
    return host, port


class _Registers:
    def __init__(self, link: AgentLink) -> None:
        self._link = link

    def read(self, offsets: Sequence[int]) -> Sequence[int]:
        accesses = struct.pack(f"<{2 * len(offsets)}I", *(word for offset in offsets for word in (offset, 0)))
        found = self._link.ask(_REGISTERS, len(offsets), 0, accesses, expected=4 * len(offsets))
        return struct.unpack(f"<{len(offsets)}I", found)

    def write(self, writes: Writes) -> None:
        words = [
            word
            for start, values in writes
            for place, value in enumerate(values)
            for word in (start + 4 * place | 1, value)
        ]
        self._link.ask(_REGISTERS, len(words) // 2, 0, struct.pack(f"<{len(words)}I", *words))


class _Memory:
    def __init__(self, link: AgentLink) -> None:
        self._link = link
        self.base = link.memory_base

    def __len__(self) -> int:
        return int(self._link.memory_words)

    def __getitem__(self, words: slice) -> NDArray[np.uint32]:
        bursts = [(start, min(_BURST, words.stop - start)) for start in range(words.start, words.stop, _BURST)]
        data = b"".join(self._link.ask(_READ, start, count, expected=4 * count) for start, count in bursts)
        return np.frombuffer(data, dtype="<u4").astype(np.uint32)

    def __setitem__(self, words: slice, values: NDArray[np.uint32]) -> None:
        for start in range(0, len(values), _BURST):
            part = values[start : start + _BURST]
            self._link.ask(_WRITE, words.start + start, len(part), part.astype("<u4").tobytes())


class _Video:
    def __init__(self, link: AgentLink) -> None:
        self._link = link
        self._shape = 0, 0, 3
        self.size, self.width_step = link.size, link.width_step

    def expect(self, size: tuple[int, int]) -> None:
        self._shape = size[1], size[0], 3
        self._link.ask(_EXPECT, *size)

    def take(self) -> NDArray[np.uint8]:
        rows, columns, _ = self._shape
        data = self._link.ask(_TAKE, expected=3 * rows * columns)
        return np.frombuffer(data, dtype=np.uint8).reshape(self._shape)

    def close(self) -> None:
        self._link.close()


def _pause() -> None:
    time.sleep(_PAUSE_SECONDS)
