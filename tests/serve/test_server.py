"""The frame server over real sockets on loopback."""

from __future__ import annotations

import asyncio
import contextlib

import numpy as np
import pytest
from fakes.device import FakeDevice, scene
from fakes.frame_server import CAMERA, controlled, frame_where, pixel, served
from fakes.sockets import ended, raw_connection
from msgspec.structs import replace
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus

from voxrt.board.errors import DeviceError, Refused, TooSlow
from voxrt.board.simulated.model import ModelDevice
from voxrt.boards.board_scenes import asset_reader
from voxrt.serve.clients import Client
from voxrt.serve.frame_client import open_client
from voxrt.serve.packets import CHUNK_LIMIT
from voxrt.serve.page_files import load_page_files
from voxrt.serve.scene_library import SceneLibrary
from voxrt.serve.server import FrameServer
from voxrt.serve.server_options import Limits, ServerOptions


async def test_client():
    async with served(loaded=scene(material=5)) as server, open_client(server.url) as client:
        assert client.hello["protocol"] == 2
        assert client.hello["device"]["capacity"] == 4096
        packet = await client.next_frame()
        assert packet.frame.colour.shape == (48, 64, 3)
        assert pixel(packet)[0] == 5
        assert (packet.frame.counters.cycles, packet.frame.counters.words_read) == (11, 7)
        with pytest.raises(Refused, match="take control first"):
            await client.request("view", camera=CAMERA)
        await client.take_control()
        request = await client.send("view", camera=CAMERA, size=[32, 16])
        packet = await frame_where(client, lambda packet: packet.request == request)
        assert packet.frame.colour.shape == (16, 32, 3)
        assert (pixel(packet)[1], packet.client) == (80, client.hello["viewer"])
        assert (await client.request("registers"))["registers"]["depth"] == 1
        counters = (await client.request("counters"))["counters"]
        assert counters["viewers"] == 1
        assert counters["frames"] >= 2


async def test_the_frames_of_an_animation():
    film = scene(material=5)
    film.words[3] = 0xFFFFFF09  # octant 2 is of another material: a frame of its own
    film = replace(film, roots=(0, 3), period=0.5)
    async with controlled(loaded=film) as (_, client):
        for frame, material in ((0, 5), (1, 9), (0, 5)):
            request = await client.send("view", frame=frame)
            packet = await frame_where(client, lambda packet, request=request: packet.request == request)
            assert pixel(packet)[0] == material
        with pytest.raises(Refused, match="no frame 2; those of scene are 0 to 1"):
            await client.request("view", frame=2)
        with pytest.raises(Refused, match="frame"):
            await client.request("view", frame=-1)


@pytest.mark.parametrize(
    ("fields", "problem"),
    [
        ({"size": [65, 48]}, "65x48 pixels are more than fake renders: 64x48"),
        ({"features": ["mirrors"]}, "fake has no mirrors"),
        ({"camera": {**CAMERA, "position": [1 << 20, 0, 0]}}, "the camera is more than 65536 voxels"),
        ({"camera": {**CAMERA, "right": [32767, 0, 0], "up": [32767, 0, 0]}}, "directions reach 1802185"),
        ({"bounces": 16}, r"<= 15 - at `\$.bounces`"),
    ],
)
async def test_views_out_of_range(fields, problem):
    async with controlled(loaded=scene()) as (server, client):
        before = server.session.renderer.view
        with pytest.raises(Refused, match=problem):
            await client.request("view", **fields)
        assert server.session.renderer.view == before


async def test_control_passes():
    async with served(loaded=scene()) as server, open_client(server.url) as first, open_client(server.url) as second:
        await first.take_control()
        assert not (await second.request("take"))["granted"]
        with pytest.raises(Refused, match="take control"):
            await second.request("view", camera=CAMERA)
        await first.request("release")
        await second.request("view", camera=CAMERA)
        with pytest.raises(Refused, match="take control"):
            await first.request("view", camera=CAMERA)
    async with served(loaded=scene()) as server, open_client(server.url) as waiting:
        async with open_client(server.url) as leaving:
            await leaving.take_control()
            assert not (await waiting.request("take"))["granted"]
        while server.session.control.controller != waiting.hello["viewer"]:
            await waiting.request("counters")


async def test_frames_come_when_something_changed_and_only_complete():
    device = FakeDevice()
    async with controlled(device, scene()) as (server, client):
        await client.next_frame()
        still = device.frames
        for _ in range(20):
            await client.request("counters")
        assert device.frames == still
        device.may_finish.clear()
        request = await client.send("view", camera=CAMERA)
        for _ in range(20):
            await client.request("counters")
        assert server.session.renderer.frames == still  # one has begun, none is sent
        device.may_finish.set()
        await frame_where(client, lambda packet: packet.request == request)
        await client.request("view", nonstop=True)
        numbers = [(await client.next_frame()).sequence for _ in range(10)]
        assert numbers == sorted(set(numbers))


async def test_trouble_is_told_and_passes():
    device = FakeDevice()
    async with controlled(device, scene()) as (server, client):
        await client.next_frame()
        for failure, trouble in (
            (DeviceError("the lanes hang"), "the lanes hang"),
            (MemoryError(), "there is not enough memory for a frame; choose a smaller picture"),
            (ValueError("?"), "the frame failed: ValueError: ?; please report this"),
        ):
            device.fail_frames = failure
            await client.request("view", camera=CAMERA, nonstop=True)
            while client.state.get("trouble") != trouble:
                await client._receive()
            device.fail_frames = None
            request = await client.send("view", camera=CAMERA)
            await frame_where(client, lambda packet, request=request: packet.request == request)
            while client.state["trouble"] is not None:
                await client._receive()
            assert server.session.renderer.trouble is None


class SlowAtFullSize(FakeDevice):
    """Its frames of more than 16 columns take too long."""

    def __init__(self):
        super().__init__()
        self.tried = []

    def frame(self, view, seconds=10.0, drop=None):
        self.tried.append((view.size, seconds))
        if view.size[0] > 16:
            raise TooSlow("the frame took more than 1.0 s")
        return super().frame(view, seconds, drop)


async def test_a_scene_that_is_too_slow_for_its_picture_is_shown_smaller():
    device = SlowAtFullSize()
    async with controlled(device, scene(material=5)) as (server, client):
        packet = await frame_where(client, lambda packet: packet.scene == 1)
        assert packet.frame.colour.shape == (12, 16, 3)
        large = next(number for number, (size, _) in enumerate(device.tried) if size[0] > 16)
        (_, limit), (smaller, rest) = device.tried[large : large + 2]
        assert smaller == (16, 12)
        assert rest == limit / 4  # the others wait
        assert pixel(packet)[0] == 5
        assert client.state["view"]["size"] == [16, 12]
        assert server.session.renderer.trouble is None


async def test_viewers_see_what_the_file_of_a_scene_lost():
    files = {"car.obj": b"mtllib car.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"}
    library = SceneLibrary(asset_reader(depth=4))
    async with FrameServer(ModelDevice(), library, ServerOptions(port=0)) as server, open_client(server.url) as client:
        await client.take_control()
        await client.upload(files, lambda *_: None)
        while client.state["scene"]["number"] == 0:
            await client.next_frame()
        (warning,) = [line for line in client.state["scene"]["warnings"] if "car.mtl" in line]
        assert "was not found" in warning


async def test_a_slow_viewer_stalls_nobody():
    device = FakeDevice(size=(640, 480))
    async with (
        served(device, scene()) as server,
        open_client(server.url) as fast,
        connect(f"ws://127.0.0.1:{server.port}/v2", max_queue=1, proxy=None, compression=None) as slow,
    ):
        slow.transport.pause_reading()
        await fast.take_control()
        await fast.request("view", nonstop=True)
        for _ in range(60):
            await fast.next_frame()
        clients = server.session.clients._clients
        assert server.session.clients.dropped_frames > 20
        assert sum(client._frame is not None for client in clients.values()) <= 2
        slow.transport.abort()


async def test_access():
    async def status(server, query="", **headers):
        try:
            async with connect(f"ws://127.0.0.1:{server.port}/v2{query}", additional_headers=headers, proxy=None):
                return 101
        except InvalidStatus as error:
            return error.response.status_code

    with pytest.raises(Refused, match=r"0\.0\.0\.0 can be reached from other machines; give a token"):
        FrameServer(FakeDevice(), SceneLibrary(asset_reader()), ServerOptions(host="0.0.0.0"))
    async with served(token="sesame") as server:
        assert await status(server) == 401
        assert await status(server, "?token=sesame") == 101
        assert await status(server, "?token=sesame", Origin="http://evil.example") == 403
        assert await status(server, "?token=sesame", Origin=f"http://127.0.0.1:{server.port}") == 101
        assert server.url.endswith("/#token=sesame")
        async with open_client(server.url) as client:
            assert client.hello["viewer"] > 0
        with pytest.raises(Refused, match="the token is missing or wrong"):
            async with open_client(f"http://127.0.0.1:{server.port}/"):
                pass
    async with served(limits=Limits(clients=2)) as server, open_client(server.url), open_client(server.url) as last:
        assert await status(server) == 503
        assert (await last.request("counters"))["counters"]["viewers"] == 2
    async with served(limits=Limits(new_clients_per_second=1)) as server:
        assert [await status(server) for _ in range(4)].count(503) >= 1


async def http(port, request):
    async with raw_connection(port) as (reader, writer):
        writer.write(request)
        return await reader.read()


async def test_page():
    async with served() as server:
        answer = await http(server.port, b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
        assert answer.startswith(b"HTTP/1.1 200 OK")
        assert b"Content-Security-Policy: default-src 'none'" in answer
        assert b"<canvas" in answer
        for name in (b"main.js", b"style.css", b"icon.svg"):
            assert b" 200 " in await http(server.port, b"GET /%b HTTP/1.1\r\nHost: x\r\n\r\n" % name)
        for name in (b"nothing", b"../server.py", b"%2e%2e/server.py", b"page_files.py"):
            assert b" 404 " in await http(server.port, b"GET /%b HTTP/1.1\r\nHost: x\r\n\r\n" % name)
        # The page asks why it was refused: it would be, under a name that is not this machine's.
        request = b"GET /v2 HTTP/1.1\r\nHost: %b\r\n\r\n"
        assert b" 426 " in await http(server.port, request % (b"127.0.0.1:%d" % server.port))
        refused = await http(server.port, request % b"x")
        assert refused.startswith(b"HTTP/1.1 403 ")
        assert b"pages of http://x may not connect; start the server with --origin http://x" in refused


@pytest.mark.parametrize("name", [b"Host", b"Origin", b"Authorization"])
async def test_headers_that_come_twice_are_refused(name):
    upgrade = b"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
    async with served() as server:
        for end in (b"", upgrade + b"AAAAAAAAAAAAAAAAAAAAAA==\r\n"):
            twice = name + b": 127.0.0.1\r\n" + name.lower() + b": 127.0.0.1\r\n"
            answer = await http(server.port, b"GET /v2 HTTP/1.1\r\n" + twice + end + b"\r\n")
            assert answer.startswith(b"HTTP/1.1 400 ")
            assert b"the header " + name + b" comes more than once" in answer


async def test_malformed_and_excess_connections():
    """Malformed, truncated, oversized and abandoned connections, and too many; a correct client still gets frames."""
    random = np.random.default_rng(7)
    limits = Limits(
        connections=120, strangers_per_address=200, new_connections_per_address_and_second=1000, handshake_seconds=0.5
    )
    async with served(loaded=scene(), limits=limits) as server, open_client(server.url) as correct:
        await correct.take_control()

        async def send_noise(length):
            try:
                return await http(server.port, random.bytes(length))
            except ConnectionError:
                return b""

        await asyncio.gather(*(send_noise(length + 1) for length in range(60)), return_exceptions=True)
        oversized = b"GET / HTTP/1.1\r\nX: " + b"a" * 100_000 + b"\r\n\r\n"
        await asyncio.gather(http(server.port, oversized), return_exceptions=True)
        # Abandoned before, during and after the handshake.
        for opening in (b"", b"GET /v2 HTTP/1.1\r\nHost:", b"GET /v2 HTTP/1.1\r\nHost: x\r\n\r\n"):
            async with raw_connection(server.port) as (_, writer):
                writer.write(opening)
        # More connections than the limit: the server closes the excess ones.
        async with contextlib.AsyncExitStack() as stack:
            readers = [(await stack.enter_async_context(raw_connection(server.port)))[0] for _ in range(300)]
            await correct.request("counters")
            assert all(await asyncio.gather(*(ended(reader) for reader in readers[150:])))
        # Malformed messages.
        async with connect(f"ws://127.0.0.1:{server.port}/v2", proxy=None) as malformed:
            for _ in range(50):
                await malformed.send(random.bytes(int(random.integers(0, 200))))
                await malformed.send('{"type": "view", "camera": 3}')
            await malformed.send(bytes(CHUNK_LIMIT + 100))
            with contextlib.suppress(ConnectionClosed):
                while True:
                    await malformed.recv()
            assert malformed.close_code == 1009
        while server.connections > 1:
            await correct.request("counters")
        request = await correct.send("view", camera=CAMERA)
        await frame_where(correct, lambda packet: packet.request == request)
        assert len(server.session.clients) == 1


async def test_backlog_of_answers():
    class BlockedConnection:
        async def send(self, _message):
            await asyncio.Event().wait()

    client = Client(1, lambda: None, str, lambda: None)
    sending = asyncio.create_task(client.send_all(BlockedConnection()))
    for number in range(1000):
        client.queue_answer({"type": "done", "request": number})
        client.queue_state()
        client.queue_frame(b"frame")
    assert client.backlog_exceeded
    assert len(client._answers) == 256
    assert client.dropped_frames == 999
    sending.cancel()


def test_who_loads_the_page_five_times_at_once_is_served():
    """Each file is a connection of its own, and so is the viewer."""
    burst = 2 * Limits().new_connections_per_address_and_second
    assert burst >= 5 * (len(load_page_files()) + 1)
