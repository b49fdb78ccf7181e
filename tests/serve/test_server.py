"""The frame server as viewers meet it: over real sockets, on loopback."""

from __future__ import annotations

import asyncio
import contextlib
import json
import zlib
from contextlib import asynccontextmanager

import numpy as np
import pytest
from fakes.device import PaintedDevice, scene
from fakes.sockets import ended, stranger
from websockets.asyncio.client import connect
from websockets.exceptions import InvalidStatus

from voxrt.board.errors import Refused
from voxrt.serve.admission import Limits
from voxrt.serve.client import visit
from voxrt.serve.clients import Viewer
from voxrt.serve.packets import CHUNK_LIMIT, Chunk, pack_chunk
from voxrt.serve.scene_files import BoardReader
from voxrt.serve.server import FrameServer, Listening
from voxrt.serve.show import Program

CAMERA = {"position": [80, 0, 0], "look": [0, 0, -90], "right": [1, 0, 0], "up": [0, 1, 0]}


def ignore(_stage, _done, _total):
    pass


def mem_files(made, name=None):
    """The .mem and the .json of a scene."""
    mem = "".join(f"{word:08X}\n" for word in made.words.tolist()).encode()
    rows = [{"colour": colour, "mirror": False} for colour in made.colours[:8].tolist()]
    manifest = {"depth": made.depth, "dialect": "report", "crc32": f"{zlib.crc32(mem):08X}", "materials": rows}
    name = name or made.name
    return {f"{name}.mem": mem, f"{name}.json": json.dumps(manifest).encode()}


@asynccontextmanager
async def served(device=None, running=None, library=None, reader=None, **listening):
    device = device or PaintedDevice()
    async with FrameServer(device, Program(reader or BoardReader(), library or {}), Listening(**listening)) as server:
        if running is not None:
            await server.show.stage.put_on(running, ignore)
        yield server
    assert device.closed


async def frame_where(client, condition):
    while not condition(packet := await client.frame()):
        pass
    return packet


def pixel(packet):
    return tuple(packet.frame.colour[0, 0].tolist())


def test_visit(run):
    async def visiting():
        async with served(running=scene(material=5)) as server, visit(server.url) as client:
            assert client.hello["protocol"] == 1
            assert client.hello["device"]["capacity"] == 4096
            packet = await client.frame()
            assert packet.frame.colour.shape == (48, 64, 3)
            assert pixel(packet)[0] == 5
            assert (packet.frame.counters.cycles, packet.frame.counters.words_read) == (11, 7)
            with pytest.raises(Refused, match="take control first"):
                await client.ask("view", camera=CAMERA)
            await client.take()
            request = await client.send("view", camera=CAMERA, size=[32, 16])
            packet = await frame_where(client, lambda packet: packet.request == request)
            assert packet.frame.colour.shape == (16, 32, 3)
            assert (pixel(packet)[1], packet.viewer) == (80, client.hello["viewer"])
            assert (await client.ask("registers"))["registers"]["depth"] == 1
            counters = (await client.ask("counters"))["counters"]
            assert counters["viewers"] == 1
            assert counters["frames"] >= 2

    run(visiting())


@pytest.mark.parametrize(
    ("fields", "problem"),
    [
        ({"size": [65, 48]}, "65x48 pixels are more than painter has: 64x48"),
        ({"features": ["mirrors"]}, "painter has no mirrors"),
        ({"camera": {**CAMERA, "position": [1 << 20, 0, 0]}}, "the camera stands more than 65536 voxels"),
        ({"camera": {**CAMERA, "right": [32767, 0, 0], "up": [32767, 0, 0]}}, "directions reach 1802185"),
        ({"bounces": 16}, "bounces 16"),
    ],
)
def test_views_out_of_range(run, fields, problem):
    async def visiting():
        async with served(running=scene()) as server, visit(server.url) as client:
            await client.take()
            before = server.show.stage.view
            with pytest.raises(Refused, match=problem):
                await client.ask("view", **fields)
            assert server.show.stage.view == before

    run(visiting())


def test_control_passes(run):
    async def visiting():
        async with served(running=scene()) as server, visit(server.url) as first, visit(server.url) as second:
            await first.take()
            assert not (await second.ask("take"))["granted"]
            with pytest.raises(Refused, match="take control"):
                await second.ask("view", camera=CAMERA)
            await first.ask("release")
            await second.ask("view", camera=CAMERA)
            with pytest.raises(Refused, match="take control"):
                await first.ask("view", camera=CAMERA)
        async with served(running=scene()) as server, visit(server.url) as waiting:
            async with visit(server.url) as leaving:
                await leaving.take()
                assert not (await waiting.ask("take"))["granted"]
            while server.show.handover.controller != waiting.hello["viewer"]:
                await waiting.ask("counters")

    run(visiting())


def test_frames_come_when_something_changed_and_only_complete(run):
    async def visiting():
        device = PaintedDevice()
        async with served(device, scene()) as server, visit(server.url) as client:
            await client.take()
            await client.frame()
            still = device.frames
            for _ in range(20):
                await client.ask("counters")
            assert device.frames == still
            device.may_finish.clear()
            request = await client.send("view", camera=CAMERA)
            for _ in range(20):
                await client.ask("counters")
            assert server.show.stage.frames == still  # one has begun, none is sent
            device.may_finish.set()
            await frame_where(client, lambda packet: packet.request == request)
            await client.ask("view", nonstop=True)
            numbers = [(await client.frame()).sequence for _ in range(10)]
            assert numbers == sorted(set(numbers))

    run(visiting())


def test_upload(run):
    async def visiting():
        device = PaintedDevice()
        async with served(device, scene(material=5)) as server, visit(server.url) as client:
            await client.take()
            stages = []
            new = scene("new", blocks=3, material=6)
            checked = await client.upload(mem_files(new), lambda stage, _d, _t: stages.append(stage), check_only=True)
            assert checked["scene"]["crc32"] == new.crc32
            assert server.show.stage.scene.name == "scene"
            done = await client.upload(mem_files(new), lambda stage, _d, _t: stages.append(stage))
            assert done["scene"] == {"name": "new", "depth": 3, "words": 25, "crc32": new.crc32}
            assert set(stages) == {"send", "read", "write", "verify"}
            packet = await frame_where(client, lambda packet: packet.scene == 2)
            assert pixel(packet)[0] == 6

    run(visiting())


def test_uploads_that_break_leave_the_old_scene(run):
    async def visiting():
        device = PaintedDevice(capacity=40)
        old = scene("old", material=5)
        async with served(device, old) as server, visit(server.url) as client:
            await client.take()

            async def refused(files, problem):
                with pytest.raises(Refused, match=problem):
                    await client.upload(files, ignore)
                assert server.show.stage.scene is old

            new = scene("new", blocks=2)
            await refused(mem_files(scene("big", blocks=6)), "49 words and painter holds 40")
            await refused({"new.mem": mem_files(new)["new.mem"]}, "not a .mem with the .json")
            await refused({"new.txt": b"?"}, "not a .mem with the .json")
            await refused({**mem_files(new), "new.mem": b"FFFFFF01\n"}, "describes another new.mem")
            await refused({**mem_files(new), "new.json": b"{"}, "is no manifest")
            device.fail_write_at = device.writes
            await refused(mem_files(new), "the bus does not answer")
            device.forget_write_at = device.writes
            await refused(mem_files(new), "word 0x10 reads 0x")
            # Chunks out of order, damaged, too long, unannounced; each ends the upload and no more.
            files = [{"name": "new.mem", "size": 8, "crc32": 0}]
            for chunk, problem in (
                (pack_chunk(Chunk(99, 0, b"x")), "of upload 99"),
                (None, "does not continue"),
                (b"VXCH", "no chunk"),
                (b"", "no chunk"),
            ):
                ready = await client.ask("upload", files=files)
                await client._connection.send(pack_chunk(Chunk(ready["upload"], 1, b"x")) if chunk is None else chunk)
                with pytest.raises(Refused, match=problem):
                    await client._answer(ready["request"])
            ready = await client.ask("upload", files=files)
            await client._connection.send(pack_chunk(Chunk(ready["upload"], 0, b"FFFFFF01")))
            with pytest.raises(Refused, match=r"new\.mem was damaged"):
                await client._answer(ready["request"])
            ready = await client.ask("upload", files=files)
            await client.ask("cancel")
            await client._connection.send(pack_chunk(Chunk(ready["upload"], 0, b"FFFFFF01")))
            with pytest.raises(Refused, match="more than the"):
                await client.ask("upload", files=[{"name": "new.mem", "size": 1 << 39, "crc32": 0}])
            await client.upload(mem_files(new), ignore)
            assert server.show.stage.scene.name == "new"

    run(visiting())


def test_a_controller_that_leaves_in_the_middle(run):
    async def visiting():
        old = scene("old", material=5)
        async with served(running=old) as server, visit(server.url) as witness:
            async with visit(server.url) as client:
                await client.take()
                ready = await client.ask("upload", files=[{"name": "new.mem", "size": CHUNK_LIMIT + 1, "crc32": 0}])
                await client._connection.send(pack_chunk(Chunk(ready["upload"], 0, bytes(CHUNK_LIMIT))))
            await witness.frame()
            while (await witness.ask("counters"))["counters"]["viewers"] > 1:
                pass
            assert server.show.stage.scene is old
            await witness.take()
            await witness.upload(mem_files(scene("new")), ignore)

    run(visiting())


def test_control_lost_while_a_scene_is_made(run):
    async def visiting():
        reading, may_read = asyncio.Event(), asyncio.Event()
        loop = asyncio.get_running_loop()

        class SlowReader(BoardReader):
            def __call__(self, files, progress):
                loop.call_soon_threadsafe(reading.set)
                asyncio.run_coroutine_threadsafe(may_read.wait(), loop).result()
                return super().__call__(files, progress)

        async with served(running=scene(), reader=SlowReader()) as server, visit(server.url) as client:
            await client.take()
            upload = asyncio.create_task(client.upload(mem_files(scene("new")), ignore))
            await reading.wait()
            server.show.handover.leave(client.hello["viewer"])
            may_read.set()
            with pytest.raises(Refused, match="control passed to another viewer"):
                await upload
            assert server.show.stage.scene.name == "scene"

    run(visiting())


def test_library(run):
    async def visiting():
        library = {"a": lambda: scene("a", material=6)}
        async with served(running=scene(), library=library) as server, visit(server.url) as client:
            assert client.hello["scenes"] == ["a"]
            await client.take()
            number = await client.send("show", scene="a")
            while (await client._answer(number))["type"] != "done":
                pass
            assert server.show.stage.scene.name == "a"
            number = await client.send("show", scene="b")
            with pytest.raises(Refused, match="there is no scene 'b'; there are a"):
                await client._answer(number)

    run(visiting())


def test_trouble_is_told_and_passes(run):
    async def visiting():
        device = PaintedDevice()
        async with served(device, scene()) as server, visit(server.url) as client:
            await client.take()
            await client.frame()
            device.fail_frames = True
            await client.ask("view", camera=CAMERA, nonstop=True)
            while not client.state or client.state["trouble"] != "the lanes hang":
                await client._receive()
            device.fail_frames = False
            request = await client.send("view", camera=CAMERA)
            await frame_where(client, lambda packet: packet.request == request)
            while client.state["trouble"] is not None:
                await client._receive()
            assert server.show.stage.trouble is None

    run(visiting())


def test_a_slow_viewer_stalls_nobody(run):
    async def visiting():
        device = PaintedDevice(size=(640, 480))
        async with (
            served(device, scene()) as server,
            visit(server.url) as fast,
            connect(f"ws://127.0.0.1:{server.port}/v1", max_queue=1, proxy=None, compression=None) as slow,
        ):
            slow.transport.pause_reading()
            await fast.take()
            await fast.ask("view", nonstop=True)
            for _ in range(60):
                await fast.frame()
            viewers = server.show.audience._viewers
            assert server.show.audience.dropped > 20
            assert sum(viewer._frame is not None for viewer in viewers.values()) <= 2
            slow.transport.abort()

    run(visiting())


def test_who_may_come_in(run):
    async def visiting():
        async def status(server, query="", **headers):
            try:
                async with connect(f"ws://127.0.0.1:{server.port}/v1{query}", additional_headers=headers, proxy=None):
                    return 101
            except InvalidStatus as error:
                return error.response.status_code

        with pytest.raises(Refused, match=r"0\.0\.0\.0 can be reached from other machines; give a token"):
            FrameServer(PaintedDevice(), Program(BoardReader()), Listening(host="0.0.0.0"))
        async with served(token="sesame") as server:
            assert await status(server) == 401
            assert await status(server, "?token=sesame") == 101
            assert await status(server, "?token=sesame", Origin="http://evil.example") == 403
            assert await status(server, "?token=sesame", Origin=f"http://127.0.0.1:{server.port}") == 101
            assert server.url.endswith("/#token=sesame")
            async with visit(server.url) as client:
                assert client.hello["viewer"] > 0
            with pytest.raises(Refused, match="this server wants its token"):
                async with visit(f"http://127.0.0.1:{server.port}/"):
                    pass
        async with served(limits=Limits(viewers=2)) as server, visit(server.url), visit(server.url) as last:
            assert await status(server) == 503
            assert (await last.ask("counters"))["counters"]["viewers"] == 2
        async with served(limits=Limits(arrivals=1)) as server:
            assert [await status(server) for _ in range(4)].count(503) >= 1

    run(visiting())


async def http(port, request):
    async with stranger(port) as (reader, writer):
        writer.write(request)
        return await reader.read()


def test_page(run):
    async def visiting():
        async with served() as server:
            answer = await http(server.port, b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
            assert answer.startswith(b"HTTP/1.1 200 OK")
            assert b"Content-Security-Policy: default-src 'none'" in answer
            assert b"<canvas" in answer
            for name in (b"main.js", b"style.css", b"icon.svg"):
                assert b" 200 " in await http(server.port, b"GET /%b HTTP/1.1\r\nHost: x\r\n\r\n" % name)
            for name in (b"nothing", b"../server.py", b"%2e%2e/server.py", b"page_files.py"):
                assert b" 404 " in await http(server.port, b"GET /%b HTTP/1.1\r\nHost: x\r\n\r\n" % name)
            assert b" 426 " in await http(server.port, b"GET /v1 HTTP/1.1\r\nHost: x\r\n\r\n")

    run(visiting())


def test_garbage_and_crowds(run):
    """Malformed, truncated, oversized and abandoned clients, and more of them than fit; an honest one sees frames."""

    async def visiting():
        random = np.random.default_rng(7)
        async with (
            served(running=scene(), limits=Limits(sockets=120, arrivals=1000, patience=0.5)) as server,
            visit(server.url) as honest,
        ):
            await honest.take()

            async def noise(length):
                try:
                    return await http(server.port, random.bytes(length))
                except ConnectionError:
                    return b""

            await asyncio.gather(*(noise(length + 1) for length in range(60)), return_exceptions=True)
            oversized = b"GET / HTTP/1.1\r\nX: " + b"a" * 100_000 + b"\r\n\r\n"
            await asyncio.gather(http(server.port, oversized), return_exceptions=True)
            # Abandoned before, in the middle of and after the handshake.
            for opening in (b"", b"GET /v1 HTTP/1.1\r\nHost:", b"GET /v1 HTTP/1.1\r\nHost: x\r\n\r\n"):
                async with stranger(server.port) as (_, writer):
                    writer.write(opening)
            # More sockets than are borne: the rest is cut off, and all of them go.
            async with contextlib.AsyncExitStack() as crowd:
                readers = [(await crowd.enter_async_context(stranger(server.port)))[0] for _ in range(300)]
                await honest.ask("counters")
                assert all(await asyncio.gather(*(ended(reader) for reader in readers[150:])))
            # Visitors that talk nonsense.
            async with connect(f"ws://127.0.0.1:{server.port}/v1", proxy=None) as visitor:
                for _ in range(50):
                    await visitor.send(random.bytes(int(random.integers(0, 200))))
                    await visitor.send('{"type": "view", "camera": 3}')
                await visitor.send(bytes(CHUNK_LIMIT + 100))
                await visitor.wait_closed()
                assert visitor.close_code == 1009
            while len(server.sockets) > 1:
                await honest.ask("counters")
            request = await honest.send("view", camera=CAMERA)
            await frame_where(honest, lambda packet: packet.request == request)
            assert len(server.show.audience) == 1

    run(visiting())


def test_answers_that_nobody_reads(run):
    async def visiting():
        class Blocked:
            async def send(self, _message):
                await asyncio.Event().wait()

        viewer = Viewer(1, lambda: None, dict)
        sending = asyncio.create_task(viewer.send_all(Blocked()))
        for number in range(1000):
            viewer.answer({"type": "done", "request": number})
            viewer.refresh()
            viewer.show(b"frame")
        assert viewer.overrun
        assert len(viewer._answers) == 256
        assert viewer.dropped == 999
        sending.cancel()

    run(visiting())
