"""A frame that takes long is dropped when the view changes, and frames appear however often it changes."""

from __future__ import annotations

from threading import Timer

import numpy as np
import pytest
from fakes.device import FakeDevice, never_merged, opened_or_skipped, scene
from fakes.frame_server import CAMERA, controlled, frame_where, ignore
from msgspec.structs import replace
from oracles import worlds
from oracles.cuts import memory_of

from voxrt.board.errors import FrameDropped
from voxrt.board.frame_drop import FrameDrop
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.core import open_rtl
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import View, frame_world
from voxrt.serve import renderer


class Hanging(FakeDevice):
    """Frames end when they are told to, or are dropped."""

    hangs = False

    def frame(self, view, seconds=10.0, drop=None):
        if self.hangs:
            self.may_finish.clear()
        return super().frame(view, seconds, drop)


def camera(x):
    return {**CAMERA, "position": [x, 0, 0]}


async def test_a_long_frame_is_dropped_and_the_next_one_is_not(monkeypatch):
    monkeypatch.setattr(renderer, "_OUTDATED_SECONDS", 0.0)
    device = Hanging(pixel_seconds=1.0)
    async with controlled(device, scene()) as (server, client):
        await client.next_frame()
        device.hangs = True
        await client.request("view", camera=camera(1))
        while not device.busy.locked():
            await client.request("counters")
        second = await client.send("view", camera=camera(2))
        while device.dropped == 0 or not device.busy.locked():
            await client.request("counters")
        # The second frame has begun. It stays, although the view changes again and again.
        for x in range(3, 6):
            last = await client.send("view", camera=camera(x))
        before = server.session.renderer.frames
        for _ in range(20):
            await client.request("counters")
        assert (device.dropped, server.session.renderer.frames) == (1, before)
        device.hangs = False
        device.may_finish.set()
        packet = await frame_where(client, lambda packet: packet.request >= second)
        assert packet.request == second
        await frame_where(client, lambda packet: packet.request == last)
        assert device.dropped == 1
        assert server.session.renderer.trouble is None


async def test_a_quick_frame_is_not_dropped(monkeypatch):
    monkeypatch.setattr(renderer, "_OUTDATED_SECONDS", 60.0)
    device = FakeDevice()
    async with controlled(device, scene()) as (_, client):
        for x in range(50):
            request = await client.send("view", camera=camera(x))
        await frame_where(client, lambda packet: packet.request == request)
        assert device.dropped == 0


@pytest.mark.parametrize("opened", [ModelDevice, lambda: open_rtl("tiny")])
def test_devices_render_on_after_a_frame_was_dropped(opened):
    device = opened_or_skipped(opened)
    small = replace(scene("boxes"), depth=4, words=memory_of(worlds.boxes(4, 9, 3)))
    memory = SceneMemory(device)
    memory.load(small, ignore)
    view = View(frame_world(4, (48, 32)), (48, 32), small.background)
    expected = device.frame(view).colour
    before, meanwhile = FrameDrop(), FrameDrop()
    before.request()
    with pytest.raises(FrameDropped):
        device.frame(view, drop=before)
    np.testing.assert_array_equal(device.frame(view, drop=FrameDrop()).colour, expected)
    depth = small.depth
    if isinstance(device, ModelDevice):
        depth = 12
        memory.load(never_merged(depth), ignore)  # every frame takes minutes
    large = View(frame_world(depth, (1600, 1200)), (1600, 1200), small.background)
    timer = Timer(0.2, meanwhile.request)
    timer.start()
    with pytest.raises(FrameDropped):
        device.frame(large, drop=meanwhile)
    timer.join()
    memory.load(small, ignore)
    np.testing.assert_array_equal(device.frame(view).colour, expected)
