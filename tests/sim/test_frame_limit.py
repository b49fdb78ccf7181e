"""The limit of the model's frames: one that would take minutes ends in the middle, and a busy machine ends none."""

from __future__ import annotations

import threading
from bisect import bisect_left

import numpy as np
import pytest
from fakes.device import never_merged

from voxrt.board.errors import DeviceError, TooSlow
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import Lighting, View, frame_world
from voxrt.sim import _model


@pytest.fixture
def device():
    device = ModelDevice()
    SceneMemory(device).load(never_merged(16), lambda *_: None)
    return device


@pytest.mark.parametrize("lighting", [Lighting(), Lighting(on=True, position=(1, 2, 3))], ids=["plain", "light"])
def test_a_frame_ends_in_time(device, lighting):
    view = View(frame_world(16, (640, 480)), (640, 480), lighting=lighting)
    with pytest.raises(TooSlow, match=r"the frame takes more work than 0\.2 s of an idle machine do"):
        device.frame(view, 0.2)


def test_the_limit_counts_work_and_not_time():
    """Whatever else the machine does, a frame ends at the same limit."""
    device = ModelDevice(threads=1)
    SceneMemory(device).load(never_merged(7), lambda *_: None)
    view = View(frame_world(7, (640, 480)), (640, 480))

    def ends(limit):
        try:
            device.frame(view, limit)
        except TooSlow:
            return True
        return False

    limits = np.arange(0.005, 4, 0.01)  # checks stand at whole hundredths
    first = [bisect_left(limits, 1, key=lambda limit: not ends(limit)) for _ in range(3)]
    assert first[0] == first[1] == first[2]
    assert 0 < first[0] < len(limits)


def test_stop_ends_the_frame_in_progress_and_all_further_ones(device):
    view = View(frame_world(16, (640, 480)), (640, 480))
    timer = threading.Timer(0.1, device.stop)
    timer.start()
    with pytest.raises(DeviceError, match="stopped"):
        device.frame(view)
    with pytest.raises(DeviceError, match="stopped"):
        device.frame(view)
    timer.join()


def test_rays_are_counted_by_the_words_they_read():
    """A point light makes the model trace pixel by pixel; each of these rays reads many thousand words."""
    scene = never_merged(16)
    stop = _model.Stop()
    stop.set()
    camera = np.array([(1 << 19, 1 << 19, 1 << 21), (0, 0, -1000), (2, 0, 0), (0, 2, 0)], dtype=np.int32)
    with pytest.raises(InterruptedError):
        _model.Memory(scene.words, 16).render(scene.colours, camera, 640, 480, stop=stop)
