"""The attacks of bench/soak.py, each of which ends by itself."""

from __future__ import annotations

import asyncio
import contextlib
import json
import struct
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from voxrt.board.errors import Refused
from voxrt.serve.frame_client import open_client
from voxrt.serve.packets import CHUNK_LIMIT, Chunk, pack_chunk

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))
from fakes import floods
from fakes.blob import blob_of, rewritten
from fakes.device import never_merged, scene
from fakes.usd_arcs import arcs

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Awaitable, Callable

    from voxrt.serve.frame_client import FrameClient

SECONDS = 1.0  # that an attack lasts which has no end of its own
LONG = b"v 0 0 0\nv 1 0 0.3\nv 0 1 0.7\nv 0.9 0.8 1\n" + b"f 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n" * 2000
LEGACY_REQUEST = struct.pack("<7I", *[0x7FF000] * 6, 0)
RANDOM = np.random.default_rng(1)


@dataclass
class Target:
    """The ports of the server, and the polite viewer that has control; who uses it takes `turn`."""

    port: int
    legacy_port: int
    controller: FrameClient
    turn: asyncio.Lock = field(default_factory=asyncio.Lock)


def ignore(_stage: str, _done: int, _total: int) -> None:
    """Take no notice of progress."""


async def ten_floods(target: Target) -> None:
    flooding = await asyncio.to_thread(
        subprocess.Popen, [sys.executable, floods.__file__, str(target.port)], stdin=subprocess.PIPE
    )
    await asyncio.sleep(SECONDS)
    assert flooding.stdin is not None
    flooding.stdin.close()
    await asyncio.to_thread(flooding.wait)


async def read_nothing(target: Target) -> None:
    async with contextlib.AsyncExitStack() as stack:
        for _ in range(5):
            with contextlib.suppress(OSError):
                connection = await asyncio.to_thread(floods.viewer, target.port)
                stack.callback(connection.close)
        await asyncio.sleep(SECONDS)


async def malformed_messages(target: Target) -> None:
    """Send malformed messages, and at last one that is too long."""
    with contextlib.suppress(ConnectionClosed, InvalidHandshake, OSError):
        async with connect(f"ws://127.0.0.1:{target.port}/v2", proxy=None, compression=None, max_size=None) as client:
            for _ in range(50):
                await client.send(RANDOM.bytes(int(RANDOM.integers(0, 200))))
                await client.send('{"type": "view", "camera": 3}')
            await client.send(bytes(CHUNK_LIMIT + 100))
            while True:
                await client.recv()


async def connect_and_leave(target: Target) -> None:
    for _ in range(5):
        with contextlib.suppress(Refused):
            async with open_client(f"http://127.0.0.1:{target.port}/") as client:
                await client.next_frame()
                client._connection.transport.abort()  # noqa: SLF001 - which no client should do


async def noise(target: Target) -> None:
    """Send bytes that are no request, requests without end, and nothing."""
    requests = [
        b"",
        RANDOM.bytes(int(RANDOM.integers(1, 400))),
        b"GET /v2 HTTP/1.1\r\nHost:",
        b"GET / HTTP/1.1\r\nX: " + b"a" * 100_000 + b"\r\n\r\n",
        b"GET / HTTP/1.1\r\n" + b"X: a\r\n" * 10_000,
        b"GET /../../etc/passwd HTTP/1.1\r\nHost: x\r\n\r\n",
        b"POST / HTTP/1.1\r\nContent-Length: 9999999999\r\n\r\n",
    ]
    await asyncio.gather(*(_send_bytes(target.port, request) for request in requests))


async def connections(target: Target) -> None:
    async with contextlib.AsyncExitStack() as stack:
        for _ in range(300):
            await stack.enter_async_context(_socket(target.port))
        await asyncio.sleep(SECONDS)


async def foreign_pages(target: Target) -> None:
    for _ in range(10):
        with contextlib.suppress(InvalidHandshake, OSError):
            async with connect(f"ws://127.0.0.1:{target.port}/v2", origin="http://evil.example", proxy=None):
                raise AssertionError("a page of another site may connect")


async def legacy(target: Target) -> None:
    """Request pictures by the legacy protocol, some in part; more clients than there may be."""

    async def request(data: bytes) -> None:
        async with _socket(target.legacy_port) as (reader, writer):
            writer.write(data)
            if len(data) % len(LEGACY_REQUEST) == 0:
                with contextlib.suppress(asyncio.IncompleteReadError):
                    await reader.readexactly(3 * 512 * 512)

    await asyncio.gather(*(request(LEGACY_REQUEST * 3) for _ in range(8)), request(LEGACY_REQUEST[:11]))


async def scene_of_death(target: Target) -> None:
    await _refused(target, {"death.blob": blob_of(never_merged(16))}, "too slow to show")


async def damaged_files(target: Target) -> None:
    blob = bytearray(blob_of(scene("x")))
    blob[-10] ^= 1
    for files, problem in (
        ({"x.blob": bytes(blob)}, "damaged"),
        ({"x.glb": b"glTF" + RANDOM.bytes(500)}, "x.glb"),
        ({"x.obj": b"f 1 2 3\n" + RANDOM.bytes(500)}, "x.obj"),
    ):
        await _refused(target, files, problem)


async def cancelled_builds(target: Target) -> None:
    async with target.turn:
        client = target.controller
        upload = asyncio.create_task(client.upload({"long.obj": LONG}, ignore))
        await asyncio.sleep(SECONDS)
        await client._connection.send('{"type": "cancel"}')  # noqa: SLF001 - the upload waits for its own answer
        with contextlib.suppress(Refused):
            await upload


async def incomplete_uploads(target: Target) -> None:
    """Announce a large upload, send a part of it, and announce another."""
    async with target.turn:
        client = target.controller
        for _ in range(5):
            ready = await client.request("upload", files=[{"name": "a.obj", "size": 1 << 27, "crc32": 0}])
            await client._connection.send(pack_chunk(Chunk(ready["upload"], 0, bytes(CHUNK_LIMIT))))  # noqa: SLF001
        await client.request("cancel")


async def names(target: Target) -> None:
    """Announce files by names that are none."""
    async with target.turn:
        for name in ("\u202ea.obj", "a\nb.obj", "../a.obj", "a" * 10_000, "", "\x00"):
            with contextlib.suppress(Refused):
                await target.controller.request("upload", files=[{"name": name, "size": 9, "crc32": 0}])
                raise AssertionError(name)


async def files_outside(target: Target) -> None:
    """Name files of the server by every way of USD, and by those of the other formats."""
    for outside in ("/etc/passwd", "/etc/nosuchfile", "../other/geo.usda"):
        for text in arcs(outside).values():
            await _refused(target, {"stage.usda": text.encode()}, "is outside the file's folder")
        gltf = {"asset": {"version": "2.0"}, "buffers": [{"uri": outside, "byteLength": 4}]}
        await _refused(target, {"a.gltf": json.dumps(gltf).encode()}, "is outside the asset's folder")


async def long_names(target: Target) -> None:
    named = rewritten(blob_of(scene("x")), b"NAME", b"n" * (1 << 20))
    await _refused(target, {"x.blob": named}, "characters are no name")


async def rays_in_a_void(target: Target) -> None:
    """Cast rays that visit every level of empty space; viewers that ask for more leave before the answer."""
    async with target.turn:
        for _ in range(50):
            await target.controller.request("ray", origin=[16, 16, 16], direction=[8191, 8190, 8189])


async def memory_by_the_square(target: Target) -> None:
    corners = b"\n".join(b"v %d %d 0" % (x * x % 7919, x * x * x % 6007) for x in range(70_000))
    for name, data, problem in (
        ("a.toml", b"a." * 100_000 + b"a=1", "parts; use"),
        ("a.obj", corners + b"\nf " + b" ".join(b"%d" % x for x in range(1, 70_001)), "export it as triangles"),
    ):
        await _refused(target, {name: data}, problem)


async def repeated_headers(target: Target) -> None:
    for name in (b"Host", b"Origin", b"Authorization"):
        async with _socket(target.port) as (reader, writer):
            writer.write(b"GET /v2 HTTP/1.1\r\n" + 2 * (name + b": 127.0.0.1\r\n") + b"\r\n")
            with contextlib.suppress(TimeoutError):
                answer = await asyncio.wait_for(reader.read(1000), SECONDS)
                assert answer.startswith(b"HTTP/1.1 400 ") or not answer, answer


async def long_texts(target: Target) -> None:
    """Send text messages that are longer than any request; each ends its connection."""
    for _ in range(10):
        with contextlib.suppress(ConnectionClosed, InvalidHandshake, OSError):
            async with connect(f"ws://127.0.0.1:{target.port}/v2", proxy=None, compression=None) as client:
                await client.send("[" + "1," * 100_000 + "1]")
                while True:
                    await client.recv()


async def edits(target: Target) -> None:
    """Edit as fast as the server lets, also beyond all bounds, and go back by steps that there are not."""
    far = [1e308, -1e308, 0]
    # Small shapes: what undo keeps of large ones would hide a leak.
    operations = [
        {"op": "fill", "sphere": {"centre": [32, 32, 32], "radius": 24}, "material": 1},
        {"op": "fill", "sphere": {"centre": far, "radius": 1e308}, "material": 0},
        {"op": "fill", "capsule": {"start": far, "end": [0, 0, 0], "radius": 1}, "material": 1},
        {"op": "paste", "box": {"low": [0, 0, 0], "high": [16, 16, 16]}, "at": [1, 0, 1], "turned": 3},
        {"op": "set", "points": [[-1, 0, 1 << 40]], "materials": 1},
        {"op": "set", "points": [[x, x, x] for x in range(64)] * 9, "materials": [x % 3 for x in range(576)]},
        {"op": "material", "name": "\x1b[2J", "colour": "#000000"},
        *({"op": one} for one in ("undo", "undo", "redo", "redo")),
    ]
    async with target.turn:
        for operation in 20 * operations:
            with contextlib.suppress(Refused):
                await target.controller.edit(operation)


ATTACKS: dict[str, Callable[[Target], Awaitable[None]]] = {
    "ten floods": ten_floods,
    "viewers that read nothing": read_nothing,
    "malformed messages": malformed_messages,
    "viewers that come and vanish": connect_and_leave,
    "noise instead of requests": noise,
    "many silent connections": connections,
    "pages of other sites": foreign_pages,
    "the legacy protocol": legacy,
    "the scene of death": scene_of_death,
    "damaged files": damaged_files,
    "builds that are cancelled": cancelled_builds,
    "incomplete uploads": incomplete_uploads,
    "names that are none": names,
    "files outside of the folder": files_outside,
    "names of a megabyte": long_names,
    "rays in a void": rays_in_a_void,
    "memory by the square": memory_by_the_square,
    "headers that come twice": repeated_headers,
    "texts that are too long": long_texts,
    "edits without end": edits,
}


async def _refused(target: Target, files: dict[str, bytes], problem: str) -> None:
    async with target.turn:
        try:
            await target.controller.upload(files, ignore)
        except Refused as refusal:
            answer = str(refusal)
        else:
            answer = "nothing: it was loaded"
        assert problem in answer, f"{', '.join(files)}: the server said {answer}"


async def _send_bytes(port: int, request: bytes) -> None:
    """Connect, send bytes, read the answer for a moment, and abort the connection."""
    async with _socket(port) as (reader, writer):
        writer.write(request)
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(reader.read(1000), 0.2)


@contextlib.asynccontextmanager
async def _socket(port: int) -> AsyncIterator[tuple[asyncio.StreamReader, asyncio.StreamWriter]]:
    with contextlib.suppress(ConnectionError):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        try:
            yield reader, writer
        finally:
            writer.transport.abort()
