"""Ctrl-C ends a server whatever it does: without this, each of these frames would hold it for minutes."""

from __future__ import annotations

import asyncio
from contextlib import suppress

import pytest
from fakes.blob import blob_of
from fakes.device import never_merged, scene
from fakes.serving import serving

from voxrt.board.errors import Refused
from voxrt.serve.frame_client import open_client
from voxrt.sim import SimulatorError
from voxrt.sim.verilated import import_verilated


async def test_in_a_long_frame_of_the_simulated_device(tmp_path):
    try:
        import_verilated("")
    except SimulatorError as error:
        pytest.skip(str(error))

    (tmp_path / "own.blob").write_bytes(blob_of(scene("own", blocks=2)))
    with serving(tmp_path, "own.blob", "--device", "sim", "--config", "tiny") as server:
        async with open_client(server.url) as client:
            await client.take_control()
            await client.next_frame()
            await client.request("view", size=[2048, 2048], nonstop=True)
            await client.request("counters")
            assert await asyncio.to_thread(server.interrupt) == 0
        assert server.leftovers() == []


async def test_in_the_first_frame_of_a_scene(tmp_path):
    rendering = asyncio.Event()

    def progress(stage, _done, _total):
        if stage == "render":
            rendering.set()

    (tmp_path / "own.blob").write_bytes(blob_of(scene("own", blocks=2)))
    with serving(tmp_path, "own.blob") as server:
        async with open_client(server.url) as client:
            await client.take_control()
            await client.request("view", size=[4000, 4000])  # its frames may take half a minute
            upload = asyncio.create_task(client.upload({"death.blob": blob_of(never_merged(16))}, progress))
            await rendering.wait()
            assert await asyncio.to_thread(server.interrupt) == 0
            with suppress(Refused):
                await upload
        assert server.leftovers() == []
