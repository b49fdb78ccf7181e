"""What viewers upload is built in a child of the server: it can be cancelled and ended, and nothing of it stays."""

from __future__ import annotations

import asyncio
import os
import signal
from pathlib import Path

import pytest
from fakes.blob import blob_of, rewritten
from fakes.device import never_merged, scene
from fakes.frame_server import ignore
from fakes.serving import WAIT, serving, until

from voxrt.board.errors import Refused
from voxrt.serve.frame_client import open_client
from voxrt.serve.packets import CHUNK_LIMIT, Chunk, pack_chunk

if not Path("/proc/self/task").exists():
    pytest.skip("looks at processes by /proc", allow_module_level=True)

LONG = {"long.obj": b"v 0 0 0\nv 1 0 0.3\nv 0 1 0.7\nv 0.9 0.8 1\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n"}
"""A tetrahedron: at a depth of 13 its surface takes minutes."""


def build_stage(client, files):
    """Upload files, and wait until they are voxelized; return the task that uploads."""
    reached = asyncio.Event()

    def progress(stage, _done, _total):
        if stage == "voxelize":
            reached.set()

    async def start():
        await client.take_control()
        upload = asyncio.create_task(client.upload(files, progress))
        waiting = asyncio.create_task(reached.wait())
        await asyncio.wait((upload, waiting), return_when=asyncio.FIRST_COMPLETED, timeout=WAIT)
        assert reached.is_set(), upload
        return upload

    return start()


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    folder = tmp_path_factory.mktemp("serving")
    (folder / "own.blob").write_bytes(blob_of(scene("own", blocks=2)))
    (folder / "gone.blob").write_bytes(blob_of(scene("gone")))
    with serving(folder, "own.blob", "gone.blob", "--depth", 13) as running:
        yield running
        assert running.leftovers() == []
        assert running.log == ""


async def test_cancel_ends_a_build(server):
    async with open_client(server.url) as client:
        upload = await build_stage(client, LONG)
        assert server.children()
        await client._connection.send('{"type": "cancel"}')
        with pytest.raises(Refused, match="cancelled; the scene was not changed"):
            await upload
        await until(lambda: not server.children() and not server.leftovers())
        assert client.state["scene"]["name"] == "own"
        await client.request("view", nonstop=False)


@pytest.mark.parametrize("how", ["connection", "control"])
async def test_a_build_ends_with_its_viewer(server, how):
    async with open_client(server.url) as witness:
        async with open_client(server.url) as client:
            upload = await build_stage(client, LONG)
            if how == "control":
                await client._connection.send('{"type": "release"}')
                with pytest.raises(Refused, match="took control meanwhile"):
                    await upload
            else:
                upload.cancel()
                client._connection.transport.abort()
        await until(lambda: not server.children() and not server.leftovers())
        await witness.take_control()
        assert (await witness.upload({"new.blob": blob_of(scene("new"))}, ignore))["scene"]["name"] == "new"


@pytest.mark.parametrize("number", [signal.SIGSEGV, signal.SIGKILL])
async def test_a_build_that_dies_is_a_line(server, number):
    async with open_client(server.url) as client:
        upload = await build_stage(client, LONG)
        os.kill(server.children()[0], number)
        with pytest.raises(Refused, match=rf"the process that read the files died \({number.name}\)"):
            await upload
        await until(lambda: not server.children() and not server.leftovers())


async def test_a_partial_upload_ends_with_control_and_with_the_connection(server):
    async with open_client(server.url) as client:
        await client.take_control()
        announced = [{"name": "part.obj", "size": 1 << 27, "crc32": 0}]
        for end in ('{"type": "release"}', '{"type": "cancel"}', None):
            await client.take_control()
            ready = await client.request("upload", files=announced)
            await client._connection.send(pack_chunk(Chunk(ready["upload"], 0, bytes(CHUNK_LIMIT))))
            assert (await client._answer(ready["request"]))["bytes"] == CHUNK_LIMIT
            assert server.leftovers()
            if end is not None:
                await client._connection.send(end)
                await until(lambda: not server.leftovers())
    await until(lambda: not server.leftovers())


async def test_files_and_names_are_limited(server):
    async with open_client(server.url) as client:
        await client.take_control()
        for name, size, problem in (
            ("\u202etxt.blob", 100, "printable characters"),
            ("a\nb.blob", 100, "printable characters"),
            ("é" * 101, 100, "200 bytes of printable"),
            ("../a.blob", 100, "no plain file name"),
            ("a\\b.blob", 100, "no plain file name"),
            ("..", 100, "no plain file name"),
            ("a.obj", 1 << 29, "more than the limit"),
            ("a.mem", 1 << 40, "more than the limit"),
        ):
            with pytest.raises(Refused, match=problem):
                await client.request("upload", files=[{"name": name, "size": size, "crc32": 0}])
        pair = [{"name": name, "size": 9, "crc32": 0} for name in ("a.mem", "A.MEM")]
        with pytest.raises(Refused, match="two files have the name"):
            await client.request("upload", files=pair)
        hidden = blob_of(scene("x"), name="a\u202eb\x07\n" + "c" * 990)
        name = (await client.upload({"x.blob": hidden}, ignore))["scene"]["name"]
        assert name.startswith("a\\x202eb\\x07\\x0ac")
        assert name.isprintable()
        assert len(name) <= 1000
        with pytest.raises(Refused, match="section NAME: 1048576 characters are no name; it may have 1000"):
            await client.upload({"x.blob": rewritten(hidden, b"NAME", b"c" * (1 << 20))}, ignore)


async def outcome(client, number):
    """Wait for what comes of a request, after all progress."""
    while (answer := await client._answer(number))["type"] == "progress":
        pass
    return answer


async def test_a_deleted_file_is_answered(server):
    (server.temporary.parent / "gone.blob").unlink(missing_ok=True)
    async with open_client(server.url) as client:
        await client.take_control()
        number = await client.send("show", scene="gone")
        with pytest.raises(Refused, match=r"gone\.blob: cannot be read: No such file"):
            await outcome(client, number)


async def test_a_full_temporary_folder_is_answered(tmp_path):
    with serving(tmp_path, file_bytes=CHUNK_LIMIT) as server:
        async with open_client(server.url) as client:
            await client.take_control()
            with pytest.raises(Refused, match=r"the server cannot store the files in .*: File too large"):
                await client.upload({"big.obj": bytes(2 * CHUNK_LIMIT)}, ignore)
            await client.upload({"small.blob": blob_of(scene("small"))}, ignore)
            assert server.leftovers() == []


async def test_the_scene_of_death_is_refused(server):
    """A scene whose every frame takes minutes: it is refused, frames of the present one go on."""
    death = {"death.blob": blob_of(never_merged(16))}
    async with open_client(server.url) as witness, open_client(server.url) as client:
        await client.take_control()
        await client.request("view", nonstop=True)
        with pytest.raises(Refused, match="too slow to show"):
            await client.upload(death, ignore)
        numbers = [(await witness.next_frame()).scene for _ in range(5)]
        assert len(set(numbers)) == 1
        assert witness.state["scene"]["number"] == numbers[0]
        assert witness.state["scene"]["name"] != "endless"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
async def test_the_end_of_the_server_ends_builds(tmp_path, number):
    with serving(tmp_path, "--depth", 13) as server:
        async with open_client(server.url) as client:
            upload = await build_stage(client, LONG)
            children = server.children()
            server.process.send_signal(number)
            with pytest.raises(Refused):
                await upload
            code = await asyncio.to_thread(server.process.wait, WAIT)
            assert code == (-number if number == signal.SIGKILL else 0)
            await until(lambda: not any(_runs(pid) for pid in children))
        if number != signal.SIGKILL:
            assert server.leftovers() == []


def _runs(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False
