"""The agent on a PYNQ board: it gives registers, memory and frames of the ray tracer over TCP.

The protocol, version 1. Numbers are unsigned, 32 bits, little-endian.

1. The agent sends ``VXRTAGNT``, the version and 16 random bytes.
2. The client sends the HMAC-SHA256 of these bytes within 5 s. The key is the token, empty if the agent has none.
3. The agent sends an answer: the words of the octree memory, their byte address on the core's bus (0 if they are on the
   chip), the columns and rows of the largest frame, and the number that columns are a multiple of.
4. The client sends requests: operation, a, b and data. The agent answers each with a status (0 done, 1 refused), a
   number of bytes, and these bytes: the result, or a line of UTF-8 that says why not. The operations:
   0 nothing.
   1 registers: a accesses, each an address and a value. Bit 0 of the address is set for a write. Result: what was read.
   2 read: b words from word a on. Result: the words.
   3 write: b words from word a on. Data: the words.
   4 expect: the next frame has a columns and b rows. A frame that is not complete is dropped.
   5 take: wait for the frame. Result: the bytes of the video stream.

Data and words are at most 256 KiB. A larger or unknown request ends the connection, and so do 60 s without a request: a
client sends 0 to stay. One client is served at a time.
"""

from __future__ import annotations

import argparse
import contextlib
import hmac
import importlib
import secrets
import socket
import struct
import sys
import threading
import time
from pathlib import Path
from typing import Any

NOTHING, REGISTERS, READ, WRITE, EXPECT, TAKE = range(6)
DATA_LIMIT = 1 << 18
PROOF_SECONDS, IDLE_SECONDS, SEND_SECONDS, VDMA_SECONDS = 5.0, 60.0, 20.0, 2.0
PARTS = ("core", "memory", "vdma")  # of rtl/vivado/build.tcl; octrees in DRAM need no `memory`
SIZE, WIDTH_STEP = (1920, 1080), 8  # the VDMA writes words of 64 bits: 8 pixels of 3 bytes are 3 of them
WORDS_BEFORE = 7  # in a buffer in DRAM: word 0 of the octree is the last of a line, so blocks are lines
MOST_WORDS, FEWEST_WORDS = 8 + (8 << 24), 1 << 15  # what the largest core can address; what a block RAM holds

# The VDMA's channel from the stream into memory, as in AMD's product guide PG020. PYNQ's own driver waits for four
# frames before it returns the first one, and the ray tracer starts every frame by itself.
_CONTROL, _STATUS, _ROWS, _ROW_BYTES, _STRIDE, _BUFFERS = 0x30, 0x34, 0xA0, 0xA4, 0xA8, (0xAC, 0xB0, 0xB4)
_RUN, _RESET, _FRAME_DONE = 1 << 0, 1 << 2, 1 << 12
_ERRORS = {4: "internal", 5: "bus", 6: "address", 7: "early frame", 8: "early line", 11: "late frame", 15: "late line"}
_ENDS = _FRAME_DONE | sum(1 << bit for bit in _ERRORS)


class RefusedError(Exception):
    """A request that cannot be carried out; the message says why."""


class Board:
    """The ray tracer in a bitstream (``.bit``, its ``.hwh`` beside it)."""

    def __init__(self, bitstream: str) -> None:
        try:
            pynq: Any = importlib.import_module("pynq")
            overlay = pynq.Overlay(bitstream)
            found = {**overlay.ip_dict, **overlay.mem_dict}
            parts = {n: pynq.MMIO(found[n]["phys_addr"], found[n]["addr_range"]) for n in PARTS if n in found}
            self._core, self._core_bytes, self._vdma = parts["core"], found["core"]["addr_range"], parts["vdma"]
        except (ImportError, OSError, RuntimeError, KeyError, AttributeError) as error:
            raise RefusedError(
                f"{bitstream}: no ray tracer ({error!r}); on a PYNQ board, load one of rtl/vivado"
            ) from error
        self._allocate = pynq.allocate
        self._frame: Any = None
        self._expected = False
        buffer = None if "memory" in parts else self._allocate_octree()
        self._base = 0 if buffer is None else int(buffer.physical_address)
        self._words = parts["memory"].array if buffer is None else buffer[WORDS_BEFORE:]
        self.description = struct.pack("<5I", len(self._words), self._base, *SIZE, WIDTH_STEP)

    def execute(self, operation: int, a: int, b: int, data: bytes) -> bytes:
        """Carry out a request and return its result."""
        if operation == REGISTERS:
            return self._access(data)
        if operation in (READ, WRITE):
            if a + b > len(self._words):
                raise RefusedError(f"words {a} to {a + b} are not in a memory of {len(self._words)}")
            return self._move(slice(a, a + b), memoryview(data).cast("I") if operation == WRITE else None)
        if operation == EXPECT:
            self._expect(a, b)
        return self._take() if operation == TAKE else b""

    def stop(self) -> None:
        """Stop the VDMA and free the frame."""
        if self._frame is not None:
            self._reset()
            self._frame.freebuffer()
            self._frame = None

    def _access(self, data: bytes) -> bytes:
        values = b""
        for address, value in struct.iter_unpack("<2I", data):
            if address & 2 or address >= self._core_bytes:
                raise RefusedError(f"the ray tracer has no register at 0x{address & ~1:X}")
            if address & 1:
                self._core.write(address - 1, value)
            else:
                values += struct.pack("<I", self._core.read(address))
        return values

    def _move(self, part: slice, words: memoryview | None) -> bytes:
        if words is not None:
            self._words[part] = words
        if self._base:  # the core does not see the processor's caches: flush what is written, read from the memory
            (self._words[part].invalidate if words is None else self._words[part].flush)()
        return b"" if words is not None else bytes(self._words[part].tobytes())

    def _expect(self, columns: int, rows: int) -> None:
        if not (0 < columns <= SIZE[0] and 0 < rows <= SIZE[1]) or columns % WIDTH_STEP:
            raise RefusedError(f"no frame has {columns}x{rows} pixels")
        if self._expected or self._frame is None or self._frame.shape != (rows, columns, 3):
            self.stop()
            self._frame = self._allocate(shape=(rows, columns, 3), dtype="u1")
            self._reset()
            self._vdma.write(_CONTROL, self._vdma.read(_CONTROL) | _RUN)
            writes = [(register, int(self._frame.physical_address)) for register in _BUFFERS]
            for register, value in [*writes, (_STRIDE, 3 * columns), (_ROW_BYTES, 3 * columns), (_ROWS, rows)]:
                self._vdma.write(register, value)  # the last one starts the channel
        self._vdma.write(_STATUS, _ENDS)  # writing 1 clears
        self._expected = True

    def _take(self) -> bytes:
        status = self._wait(_STATUS, _ENDS, 0)
        if errors := [problem for bit, problem in _ERRORS.items() if status >> bit & 1]:
            raise RefusedError(f"the VDMA reports an error ({', '.join(errors)}); the frame was dropped, try again")
        self._expected = False
        self._frame.invalidate()
        return bytes(self._frame.tobytes())

    def _reset(self) -> None:
        self._vdma.write(_CONTROL, _RESET)
        self._wait(_CONTROL, _RESET, _RESET)
        self._expected = False

    def _wait(self, register: int, bits: int, present: int) -> int:
        end = time.monotonic() + VDMA_SECONDS
        while not ((value := int(self._vdma.read(register))) ^ present) & bits:
            if time.monotonic() > end:
                raise RefusedError(f"the VDMA did not answer for {VDMA_SECONDS:.0f} s; check the block design")
            time.sleep(0.0005)
        return value

    def _allocate_octree(self) -> Any:  # noqa: ANN401 - pynq is there on boards alone
        """Allocate most of the contiguous memory that is free; a frame still fits beside it."""
        words = MOST_WORDS
        while words >= FEWEST_WORDS:
            with contextlib.suppress(RuntimeError, MemoryError, OSError), contextlib.ExitStack() as kept:
                memory = self._allocate(shape=(words,), dtype="u4")
                kept.callback(memory.freebuffer)
                self._allocate(shape=(SIZE[1], SIZE[0], 3), dtype="u1").freebuffer()
                if memory.physical_address + memory.nbytes > 1 << 32:
                    raise RefusedError("contiguous memory is beyond the 4 GiB of the ray tracer; reserve some below")
                kept.pop_all()
                return memory
            words = words * 3 // 4
        raise RefusedError("contiguous memory is too small for an octree and a frame; give Linux more by cma=")


def serve(listener: socket.socket, board: Board, token: str) -> None:
    """Serve one client at a time, without end."""
    busy = threading.Lock()
    while True:
        connection, _ = listener.accept()
        with contextlib.suppress(OSError):  # the client has left, or is too slow
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            nonce = secrets.token_bytes(16)
            connection.sendall(struct.pack("<8sI16s", b"VXRTAGNT", 1, nonce))
            proof = _receive(connection, 32, time.monotonic() + PROOF_SECONDS)
            if not hmac.compare_digest(proof, hmac.new(token.encode(), nonce, "sha256").digest()):
                _answer(connection, 1, b"the token is another one; VOXRT_BOARD_TOKEN must hold that of the agent")
            elif not busy.acquire(timeout=2 * VDMA_SECONDS):  # so long the work for a client that has left may take
                _answer(connection, 1, b"another client uses the board; end it")
            else:
                threading.Thread(target=_serve_client, args=(connection, board, busy), daemon=True).start()
                continue
        connection.close()


def _serve_client(connection: socket.socket, board: Board, busy: threading.Lock) -> None:
    with contextlib.suppress(OSError), connection:  # the client has left, or is too slow
        _answer(connection, 0, board.description)
        while True:
            end = time.monotonic() + IDLE_SECONDS
            operation, a, b = struct.unpack("<3I", _receive(connection, 12, end))
            size = {NOTHING: 0, REGISTERS: 8 * a, READ: 4 * b, WRITE: 4 * b, EXPECT: 0, TAKE: 0}.get(operation, 1 << 40)
            if size > DATA_LIMIT:
                _answer(connection, 1, b"the request is unknown or too large; update this side or the other")
                break
            data = _receive(connection, 0 if operation == READ else size, end)
            try:
                status, result = 0, board.execute(operation, a, b, data)
            except Exception as error:  # noqa: BLE001 - whatever pynq raises, the client gets an answer
                status, result = 1, " ".join((str(error) or repr(error)).split())[:500].encode()
            _answer(connection, status, result)
    with contextlib.suppress(Exception):
        board.stop()
    busy.release()


def _receive(connection: socket.socket, count: int, end: float) -> bytes:
    data = b""
    while len(data) < count:
        connection.settimeout(max(1e-6, end - time.monotonic()))
        part = connection.recv(count - len(data))
        if not part or time.monotonic() > end:
            raise OSError
        data += part
    return data


def _answer(connection: socket.socket, status: int, data: bytes) -> None:
    connection.settimeout(SEND_SECONDS)
    connection.sendall(struct.pack("<2I", status, len(data)) + data)


def main() -> None:
    """Serve until Ctrl-C; print an error in one line."""
    parser = argparse.ArgumentParser(prog="voxrt-board", description="Give the ray tracer of a PYNQ board over TCP.")
    parser.add_argument("bitstream", help="the .bit of the ray tracer, its .hwh in the same folder")
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on; all but loopback need a token")
    parser.add_argument("--port", type=int, default=4810)
    parser.add_argument("--token-file", type=Path, help="its first line is the token; default: a random one is made")
    arguments = parser.parse_args()
    try:
        token = arguments.token_file.read_text().split("\n")[0].strip() if arguments.token_file else ""
        with socket.create_server((arguments.host, arguments.port)) as listener:
            host, port = listener.getsockname()
            if not token and (arguments.token_file or not host.startswith("127.")):
                token = secrets.token_urlsafe(16)
                print("VOXRT_BOARD_TOKEN=" + token, flush=True)
            board = Board(arguments.bitstream)
            print(f"listening on {host} port {port}; Ctrl-C ends it", flush=True)
            serve(listener, board, token)
    except KeyboardInterrupt:
        pass
    except (RefusedError, OSError, OverflowError) as error:
        sys.exit(f"voxrt-board: error: {error}")


if __name__ == "__main__":
    main()
