"""The host's side of the serial line of an ECP5 board; ``docs/board-serial.md`` is the protocol's reference."""

from __future__ import annotations

import os
import zlib
from contextlib import suppress
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from voxrt.board.errors import DeviceError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

BAUD = 3_000_000
QUIET_SECONDS = 0.1
"""A line without a byte for this long is quiet: the board waits for a request again."""

_REQUEST, _ANSWER = 0x56, 0x76
_READ, _WRITE = 1, 2
_DONE, _DISTURBED, _MALFORMED, _NO_REGISTER = range(4)
_BURST = 255  # words per request
_HEADER = 4
_TRIES = 5


class Port(Protocol):
    """Bytes to and from the board; :class:`serial.Serial` is one."""

    def write(self, data: bytes, /) -> object:
        """Send bytes."""

    def read(self, count: int, /) -> bytes:
        """Receive `count` bytes, or fewer when none came for :data:`QUIET_SECONDS`."""

    def close(self) -> None:
        """Close the port."""


class SerialLink:
    """Reads and writes words of the board's address map.

    Each request is answered before the next one is sent. A request that is not answered, or whose answer is damaged,
    is sent again when the line is quiet; writing the same words twice does no harm.

    Parameters
    ----------
    name
        Of the port, shown to users.
    port
        The open port.
    """

    def __init__(self, name: str, port: Port) -> None:
        self.name = name
        self._port = port
        self._sequence = 0

    def read(self, address: int, count: int) -> NDArray[np.uint32]:
        """Read words from a byte address on: uint32, shape (count,).

        Raises
        ------
        DeviceError
            The board does not answer, or an address has no register.
        """
        parts = [np.zeros(0, dtype=np.uint32)]
        for start in range(0, count, _BURST):
            burst = min(_BURST, count - start)
            answer = self._ask(_READ, address + 4 * start, burst, b"")
            if len(answer) != 4 * burst:
                raise DeviceError(f"{self.name}: {len(answer)} bytes came instead of {4 * burst}; upgrade voxrt")
            parts.append(np.frombuffer(answer, dtype="<u4").astype(np.uint32))
        return np.concatenate(parts)

    def write(self, address: int, words: ArrayLike) -> None:
        """Write words (uint32, shape (N,)) from a byte address on.

        Raises
        ------
        DeviceError
            As :meth:`read`; what was written before the failure stays written.
        """
        values = np.asarray(words, dtype="<u4")
        for start in range(0, len(values), _BURST):
            burst = values[start : start + _BURST]
            self._ask(_WRITE, address + 4 * start, len(burst), burst.tobytes())

    def close(self) -> None:
        """Close the port."""
        self._port.close()

    def _ask(self, operation: int, address: int, count: int, data: bytes) -> bytes:
        problem = "does not answer"
        for _ in range(_TRIES):
            self._sequence = (self._sequence + 1) % 256
            head = bytes((_REQUEST, operation, self._sequence, count)) + address.to_bytes(3, "little")
            try:
                self._port.write(_with_crc(head + data))
                answer = self._receive()
                if answer is not None and (answer[1] == _DISTURBED or answer[2] == self._sequence):
                    status = answer[1]
                    if status == _DONE:
                        return answer[_HEADER:]
                    if status == _MALFORMED:
                        raise DeviceError(f"{self.name}: the board does not know a request of voxrt; upgrade voxrt")
                    if status == _NO_REGISTER:
                        raise DeviceError(
                            f"{self.name}: address 0x{address:06X} has no register in this design; "
                            "load a bitstream of this version of voxrt"
                        )
                    problem = "receives damaged bytes"
                elif answer is not None:
                    problem = "answers another request"
                self._drain()
            except OSError as error:
                raise DeviceError(f"{self.name}: {error}; plug the board in and try again") from error
        raise DeviceError(
            f"{self.name}: the board {problem}; check the cable, and that its bitstream is one of voxrt bitstream"
        )

    def _receive(self) -> bytes | None:
        """Receive an answer without its CRC; None if none came that is whole."""
        head = self._port.read(_HEADER)
        if len(head) != _HEADER or head[0] != _ANSWER:
            return None
        rest = self._port.read(4 * head[3] + 4)
        whole = head + rest
        if len(rest) != 4 * head[3] + 4 or _with_crc(whole[:-4]) != whole:
            return None
        return whole[:-4]

    def _drain(self) -> None:
        """Drop what comes until the line is quiet."""
        for _ in range(64):  # a line that never falls quiet is not the board's
            if not self._port.read(4096):
                return


def open_serial(path: str) -> SerialLink:
    """Open a serial port, such as ``/dev/ttyUSB0`` or ``COM3``.

    Raises
    ------
    DeviceError
        pyserial is missing, or the port cannot be opened.
    """
    try:
        serial: Any = import_module("serial")
    except ImportError as error:
        raise DeviceError("serial lines need pyserial: pip install pyserial") from error
    try:
        port = serial.Serial(path, BAUD, timeout=QUIET_SECONDS, write_timeout=1.0, exclusive=True)
    except (OSError, ValueError) as error:
        raise DeviceError(f"{path}: cannot be opened ({_reason(error)}); {_ports()}") from error
    # Where there is no such mode a request takes some milliseconds more.
    with suppress(AttributeError, OSError, ValueError, NotImplementedError):
        port.set_low_latency_mode(True)
    port.reset_input_buffer()
    return SerialLink(path, port)


def _reason(error: Exception) -> str:
    number = getattr(error, "errno", None)
    return os.strerror(number) if number else str(error)


def _ports() -> str:
    tools: Any = import_module("serial.tools.list_ports")
    found: Sequence[str] = sorted(port.device for port in tools.comports())
    return f"serial ports here are {', '.join(found)}" if found else "there is no serial port here: plug the board in"


def _with_crc(data: bytes) -> bytes:
    return data + zlib.crc32(data).to_bytes(4, "little")
