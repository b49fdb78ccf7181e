"""Uploads and the server's own scenes, over real sockets on loopback."""

from __future__ import annotations

import asyncio
from itertools import pairwise

import pytest
from fakes.blob import mem_files
from fakes.device import FakeDevice, scene, wide_scene
from fakes.frame_server import controlled, frame_where, ignore, pixel, served
from fakes.scene_reader import ReadyScenes
from msgspec.structs import replace

from voxrt.board.errors import Refused
from voxrt.serve import request_handler
from voxrt.serve.frame_client import open_client
from voxrt.serve.packets import CHUNK_LIMIT, Chunk, pack_chunk


async def test_upload():
    device = FakeDevice()
    async with controlled(device, scene(material=5)) as (server, client):
        stages = []
        new = scene("new", blocks=3, material=6)
        checked = await client.upload(mem_files(new), lambda stage, _d, _t: stages.append(stage), check_only=True)
        assert checked["scene"]["crc32"] == new.crc32
        assert server.session.renderer.scene.name == "scene"
        done = await client.upload(mem_files(new), lambda stage, _d, _t: stages.append(stage))
        assert done["scene"] == {"name": "new", "depth": 3, "words": 25, "crc32": new.crc32}
        assert set(stages) == {"send", "read", "write", "verify", "render"}
        packet = await frame_where(client, lambda packet: packet.scene == 2)
        assert pixel(packet)[0] == 6


async def test_frames_while_a_scene_is_loaded():
    """Frames and the steps of the upload take turns: before `done` all frames show the old scene, then the new one."""
    device = FakeDevice(capacity=40000)
    old, new = (replace(wide_scene(str(material), 2000, material), depth=6) for material in (5, 6))
    async with served(device, old) as server:
        renderer = server.session.renderer
        device.calls.clear()
        loading = asyncio.create_task(renderer.load(new, ignore))
        materials = []
        while not loading.done():
            materials.append(int((await renderer.render_view(renderer.view)).colour[0, 0, 0]))
        await loading
        after = await renderer.render_view(renderer.view)
        assert after.colour[0, 0, 0] == 6
        before = [material for material in materials if material == 5]
        assert materials == before + [6] * (len(materials) - len(before))
        assert len(before) >= 8  # 4 bursts are written and 4 read back
        written = [number for number, call in enumerate(device.calls) if call == "write_memory"]
        assert all("frame" in device.calls[a:b] for a, b in pairwise(written))
        assert "hold" not in device.calls


async def test_uploads_that_break_leave_the_old_scene():
    device = FakeDevice(capacity=40)
    old = scene("old", material=5)
    async with controlled(device, old) as (server, client):

        async def refused(files, problem):
            with pytest.raises(Refused, match=problem):
                await client.upload(files, ignore)
            assert server.session.renderer.scene is old

        new = scene("new", blocks=2)
        await refused(mem_files(scene("big", blocks=6)), "49 words and fake holds 40")
        await refused({"new.txt": b"?"}, "upload exactly one file with a suffix of .blob .mem")
        await refused({**mem_files(new), "new.mem": b"FFFFFF01\n"}, "describes another new.mem")
        await refused({**mem_files(new), "new.json": b"{"}, "is no manifest")
        device.fail_write_at = device.writes
        await refused(mem_files(new), "the bus does not answer")
        device.forget_write_at = device.writes
        await refused(mem_files(new), "word 0x10 reads 0x")


async def test_chunks_that_break_end_their_upload_and_no_more():
    new = scene("new", blocks=2)
    async with controlled(loaded=scene("old")) as (server, client):
        # Out of order, damaged, too long, unannounced.
        files = [{"name": "new.mem", "size": 8, "crc32": 0}]
        for chunk, problem in (
            (pack_chunk(Chunk(99, 0, b"x")), "of upload 99"),
            (None, "does not continue"),
            (b"VXCH", "no chunk"),
            (b"", "no chunk"),
        ):
            ready = await client.request("upload", files=files)
            await client._connection.send(pack_chunk(Chunk(ready["upload"], 1, b"x")) if chunk is None else chunk)
            with pytest.raises(Refused, match=problem):
                await client._answer(ready["request"])
        ready = await client.request("upload", files=files)
        await client._connection.send(pack_chunk(Chunk(ready["upload"], 0, b"FFFFFF01")))
        with pytest.raises(Refused, match=r"new\.mem was damaged"):
            await client._answer(ready["request"])
        ready = await client.request("upload", files=files)
        await client.request("cancel")
        await client._connection.send(pack_chunk(Chunk(ready["upload"], 0, b"FFFFFF01")))
        with pytest.raises(Refused, match="more than the limit"):
            await client.request("upload", files=[{"name": "new.mem", "size": 1 << 39, "crc32": 0}])
        await client.upload(mem_files(new), ignore)
        assert server.session.renderer.scene.name == "new"


async def test_a_controller_that_leaves_in_the_middle():
    old = scene("old", material=5)
    async with served(loaded=old) as server, open_client(server.url) as witness:
        async with open_client(server.url) as client:
            await client.take_control()
            ready = await client.request("upload", files=[{"name": "new.mem", "size": CHUNK_LIMIT + 1, "crc32": 0}])
            await client._connection.send(pack_chunk(Chunk(ready["upload"], 0, bytes(CHUNK_LIMIT))))
        await witness.next_frame()
        while (await witness.request("counters"))["counters"]["viewers"] > 1:
            pass
        assert server.session.renderer.scene is old
        await witness.take_control()
        await witness.upload(mem_files(scene("new")), ignore)


async def test_a_reader_that_is_slow_to_start_is_no_silent_server(monkeypatch):
    monkeypatch.setattr(request_handler, "_REPEAT_SECONDS", 0.01)
    heard, new = asyncio.Event(), scene("new", material=6)
    count = iter(range(3))

    class SlowReader(ReadyScenes):
        async def read(self, _paths, _progress):
            await heard.wait()
            return new

    def progress(stage, _done, _total):
        if stage == "read" and next(count, None) is None:
            heard.set()

    async with controlled(loaded=scene(), reader=SlowReader()) as (server, client):
        await client.upload(mem_files(new), progress)
        assert server.session.renderer.scene is new


async def test_control_lost_while_a_scene_is_made():
    reading = asyncio.Event()

    class SlowReader(ReadyScenes):
        async def read(self, _paths, _progress):
            reading.set()
            await asyncio.Event().wait()

    async with controlled(loaded=scene(), reader=SlowReader()) as (server, client):
        upload = asyncio.create_task(client.upload(mem_files(scene("new")), ignore))
        await reading.wait()
        server.session.control.release(client.hello["viewer"])
        with pytest.raises(Refused, match="another viewer took control"):
            await upload
        assert server.session.renderer.scene.name == "scene"


async def test_library():
    scenes = {"a": scene("a", material=6)}
    async with served(loaded=scene(), scenes=scenes) as server, open_client(server.url) as client:
        assert client.hello["scenes"] == ["a"]
        await client.take_control()
        number = await client.send("show", scene="a")
        while (await client._answer(number))["type"] != "done":
            pass
        assert server.session.renderer.scene.name == "a"
        number = await client.send("show", scene="b")
        with pytest.raises(Refused, match="there is no scene 'b'; there are a"):
            await client._answer(number)
