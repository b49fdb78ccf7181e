"""Views of a board that sends its frames, compared with the exact model's."""

from __future__ import annotations

import pytest
from fakes.box_scenes import boxes, ignore
from fakes.pynq import Core, install
from msgspec.structs import replace

from voxrt.board.board_report import cameras_around, check_views
from voxrt.board.scene_memory import SceneMemory


def test_frames_of_a_board_are_compared(monkeypatch, open_board):
    pytest.importorskip("voxrt.sim._rtl", reason="the verilated core is not in this installation")
    install(monkeypatch, Core())
    device, scene, size = open_board(), boxes(1, 3), (64, 48)
    SceneMemory(device).load(scene, ignore)
    cameras = cameras_around(scene.depth, size, 3)
    views = check_views(device, scene, cameras, size, ignore, sends_frames=True)
    assert all(view.equal for view in views)
    assert len({view.crc32 for view in views}) == 3
    assert all(view.crc32 == view.expected_crc32 and view.hits > 0 for view in views)
    # Another scene than the board's.
    views = check_views(device, replace(scene, words=boxes(2, 3).words), cameras, size, ignore, sends_frames=True)
    assert not any(view.equal for view in views)
