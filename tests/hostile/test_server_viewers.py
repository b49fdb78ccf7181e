"""Viewers that read nothing, send without end, or never show a token: others are served, and memory stays bounded."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import struct
import subprocess
import sys
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
import pytest
from fakes import floods
from fakes.device import FakeDevice, scene
from fakes.frame_server import served
from fakes.serving import serving, until
from fakes.sockets import ended, raw_connection
from websockets.asyncio.client import connect
from websockets.frames import CloseCode

from voxrt.board.scene import Scene
from voxrt.serve.frame_client import open_client
from voxrt.serve.limited_connection import TEXT_LIMIT
from voxrt.serve.packets import FRAME_HEADER
from voxrt.serve.server_options import Limits

VOID = [1, *(1 + 8 * (level + 1) for level in range(15) for _ in range(8)), *[0xFFFFFF00] * 8]
"""A ray goes from leaf to leaf through 16 levels of emptiness."""

EXAMPLES = Path(__file__).parents[2] / "examples"
LEGACY_REQUEST = struct.pack("<7I", *[0x7FF000] * 6, 0)


@asynccontextmanager
async def stalled(port):
    """A viewer that reads nothing after its handshake."""
    connection = await asyncio.to_thread(floods.viewer, port)
    try:
        yield connection
    finally:
        connection.close()


async def frames_of(client, count):
    for _ in range(count):
        await client.next_frame()


async def test_a_viewer_that_stops_reading_is_dropped():
    """Its frames are larger than all buffers on the way. The polite viewer gets its frames meanwhile."""
    device = FakeDevice(size=(1024, 1024))
    limits = Limits(send_seconds=0.5, send_bytes_per_second=1 << 30)
    async with served(device, scene(), limits=limits) as server, open_client(server.url) as polite:
        await polite.take_control()
        await polite.request("view", nonstop=True, size=[1024, 1024])
        async with stalled(server.port), stalled(server.port):
            await until(lambda: len(server.session.clients) == 3)
            while len(server.session.clients) > 1:
                await polite.next_frame()


async def test_the_frames_that_are_kept_for_slow_viewers_are_limited():
    device = FakeDevice(size=(1024, 1024))
    frame = 1024 * 1024 * 3 + FRAME_HEADER
    async with (
        served(device, scene(), limits=Limits(frame_bytes=3 * frame)) as server,
        open_client(server.url) as polite,
    ):
        await polite.take_control()
        await polite.request("view", nonstop=True, size=[1024, 1024])
        async with contextlib.AsyncExitStack() as stack:
            for _ in range(6):  # each stops in a frame of its own
                await stack.enter_async_context(stalled(server.port))
                await frames_of(polite, 5)
            clients = server.session.clients._clients.values()
            kept = {id(data): len(data) for client in clients for data in client.frames}
            assert sum(kept.values()) <= 4 * frame
            assert len(clients) < 7
            await frames_of(polite, 5)


@pytest.mark.parametrize("data", [floods.PING, floods.FRAGMENT], ids=["pings", "fragments"])
async def test_a_viewer_that_is_flooded_by_its_own_answers_is_dropped(data):
    """It sends pings, and reads none of the pongs; or a message of endless empty fragments."""
    limits = Limits(frames_per_second=1e6, send_seconds=1e6)
    async with served(FakeDevice(), scene(), limits=limits) as server:
        async with stalled(server.port) as connection:
            await until(lambda: len(server.session.clients) == 1)

            def flood():
                connection.sendall(floods.BEGIN if data is floods.FRAGMENT else b"")
                while True:
                    connection.sendall((b"\x89\xfd" + bytes(4 + 125)) * 500 if data is floods.PING else data * 500)

            with pytest.raises(OSError, match=r"reset|[Bb]roken"):
                await asyncio.to_thread(flood)
        await until(lambda: len(server.session.clients) == 0)


async def test_connections_without_a_token_are_limited_per_address():
    limits = Limits(strangers_per_address=5, handshake_seconds=60, new_connections_per_address_and_second=1000)
    async with (
        served(FakeDevice(), scene(), limits=limits, token="sesame") as server,
        open_client(server.url) as polite,
        contextlib.AsyncExitStack() as stack,
    ):
        first = [await stack.enter_async_context(raw_connection(server.port)) for _ in range(5)]
        await until(lambda: server.connections == 6)
        for _ in range(10):
            reader, _ = await stack.enter_async_context(raw_connection(server.port))
            assert await ended(reader)
        assert server.connections == 6
        await polite.request("counters")
        first[0][1].close()
        await until(lambda: server.connections == 5)
        async with open_client(server.url) as second:
            await second.request("counters")
    async with served(FakeDevice(), scene(), limits=Limits(new_connections_per_address_and_second=1)) as server:
        closed = 0
        for _ in range(10):
            async with raw_connection(server.port) as (reader, writer):
                writer.write(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
                closed += await ended(reader)
        assert closed >= 5


async def test_the_legacy_port_is_off_unless_asked_for_and_bounded():
    async with served(FakeDevice(), scene()) as server:
        assert server.legacy_port is None
    device = FakeDevice(size=(640, 512))
    async with (
        served(device, scene(), legacy_port=0) as server,
        open_client(server.url) as polite,
        contextlib.AsyncExitStack() as stack,
    ):
        await polite.take_control()
        await polite.request("view", nonstop=True)
        clients = [await stack.enter_async_context(raw_connection(server.legacy_port)) for _ in range(12)]
        for _, writer in clients:
            writer.write(LEGACY_REQUEST * 100)
        for _ in range(20):
            before = device.frames
            await polite.next_frame()
            assert device.frames - before < 10  # its frames and those of the others take turns
        assert sum([await ended(reader) for reader, _ in clients[4:]]) == 8


def flood(port):
    return subprocess.Popen([sys.executable, floods.__file__, str(port)], stdin=subprocess.PIPE)


async def test_floods_leave_a_viewer_its_frames(tmp_path):
    """The polite viewer goes on, memory stays, nothing is logged, and Ctrl-C ends the server in their midst."""

    with serving(tmp_path, EXAMPLES / "house.obj", "--depth", 5) as server:
        async with open_client(server.url) as polite:
            await polite.take_control()
            await polite.request("view", nonstop=True, size=[320, 240])
            await frames_of(polite, 20)
            before = server.megabytes()
            flooding = flood(server.port)
            try:
                await frames_of(polite, 60)
                assert (await polite.request("counters"))["counters"]["viewers"] > 3
                assert server.megabytes() - before < 150
                assert server.log == ""
                assert await asyncio.to_thread(server.interrupt) == 0
            finally:
                flooding.stdin.close()
                flooding.wait()
        assert server.log == ""


@pytest.mark.parametrize("parts", [1, 3])
async def test_a_text_that_is_too_long_ends_its_connection(parts):
    async with served(FakeDevice(), scene()) as server, connect(server.url.replace("http", "ws") + "v2") as viewer:
        await viewer.send(["1" * (TEXT_LIMIT // parts)] * parts)
        await viewer.send("1" * TEXT_LIMIT)  # both are long enough to be no request, and short enough to be read
        await viewer.send(["1" * ((TEXT_LIMIT + parts) // parts)] * parts)
        await viewer.wait_closed()
    assert viewer.close_code == CloseCode.MESSAGE_TOO_BIG


async def test_the_longest_announcement_of_an_upload_is_read():
    files = [{"name": "\u00e9" * 98 + f"{number:02}.a", "size": 1, "crc32": 0} for number in range(64)]
    async with served(FakeDevice(), scene()) as server, open_client(server.url) as client:
        await client.take_control()
        assert (await client.request("upload", files=files))["type"] == "ready"


async def test_rays_leave_nothing_to_wait_for_at_the_end():
    """Rays and checks have a thread of their own; that of the event loop would be waited for."""
    void = Scene("void", 16, np.array(VOID, np.uint32), np.zeros((256, 3), np.uint8), np.zeros(256, bool))
    async with served(FakeDevice(), void) as server, open_client(server.url) as client:
        await client.take_control()
        for _ in range(20):
            answer = await client.request("ray", origin=[16, 16, 16], direction=[8191, 8190, 8189])
            assert answer["hit"] is None
        assert asyncio.get_running_loop()._default_executor is None


async def test_shutdown_with_viewers_that_read_nothing(tmp_path):
    with serving(tmp_path, EXAMPLES / "house.obj", "--depth", 5) as server:
        async with open_client(server.url) as polite, stalled(server.port), stalled(server.port):
            await polite.take_control()
            await polite.request("view", nonstop=True, size=[1600, 1200])
            await frames_of(polite, 5)
            assert await asyncio.to_thread(server.interrupt) == 0


async def test_a_viewer_that_vanishes_in_its_own_flood_is_not_logged(caplog):
    """The pongs to a piece of its pings are written when the connection is lost already."""
    limits = Limits(frames_per_second=1e6, new_clients_per_second=1000)
    async with served(FakeDevice(), scene(), limits=limits) as server:
        for _ in range(20):
            connection = await asyncio.to_thread(floods.viewer, server.port)
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
            connection.sendall(floods.PING * 20_000)
            connection.close()  # by a reset
        await until(lambda: server.connections == 0)
    assert not caplog.records
