"""Cameras from all, some or no registers: right-handed, with the whole scene in the picture."""

from __future__ import annotations

import numpy as np
import pytest

from voxrt import Camera, Material, Rom, ViewpointError, aim_camera, render
from voxrt.octree import from_dense
from voxrt.views.viewpoint import authored_camera
from voxrt.voxelize import EMPTY, Grid, Viewpoint

SIZE = (80, 60)


@pytest.fixture(scope="module")
def rom():
    """Two boxes that do not reach the world's sides."""
    world = np.zeros((64, 64, 64), np.uint8)
    world[5:50, 3:11, 20:60] = 1
    world[30:41, 11:30, 22:31] = 2
    return Rom("boxes", from_dense(world), (EMPTY, Material("low", (255, 255, 255)), Material("high", (255, 0, 0))))


@pytest.mark.parametrize(
    "registers",
    [
        {},
        {"position": (-80, 48, 1280)},
        {"position": (440, 1600, 640)},
        {"position": (440, -900, 640)},
        {"look": (0, 0, -1)},
        {"look": (0, -1, 0)},
        {"look": (0, 1, 0)},
        {"look": (30000, -30000, 30000)},
        {"look": (5, -3, -9), "position": (0, 480, 640)},
        {"right": (20, 0, -3)},
        {"up": (0, 20, 0)},
        {"look": (0, 0, 900), "right": (-20, 0, 0)},
        {"look": (0, 0, 900), "up": (0, 20, 0)},
        {"right": (-20, 0, 0), "up": (0, 20, 0)},
        {"look": (0, 0, -900), "right": (20, 0, 0), "up": (0, 20, 0)},
        {"right": (20, 0, -3), "position": (0, 480, 1640)},
    ],
)
def test_a_camera_is_right_handed_and_sees_the_scene(rom, registers):
    camera = aim_camera(rom, SIZE, **registers)
    for name, value in registers.items():
        alone = name == "look" and not {"right", "up"} & set(registers)
        assert getattr(camera, name) == value or alone
    look, right, up = (np.array(vector, float) for vector in (camera.look, camera.right, camera.up))
    if "look" in registers:
        assert np.cross(look, registers["look"]) == pytest.approx(0, abs=2e-4 * np.linalg.norm(look))
        assert look @ registers["look"] > 0
    look, right, up = (vector / np.linalg.norm(vector) for vector in (look, right, up))
    assert right == pytest.approx(np.cross(look, up), abs=0.05)
    assert "up" in registers or "right" in registers or up[1] > -0.01
    drawn = render(rom, camera, size=SIZE, engine="model").material != 0
    assert drawn.any()
    if "position" not in registers:
        assert not (drawn[0].any())
        assert not (drawn[-1].any())
        assert not (drawn[:, 0].any())
        assert not (drawn[:, -1].any())
        assert drawn.any(axis=0).mean() > 0.7 or drawn.any(axis=1).mean() > 0.7


def test_given_registers_are_kept(rom):
    registers = (1, 2, 3), (4, 5, 6), (7, 8, 9), (-1, 0, 1)
    position, look, right, up = registers
    assert aim_camera(rom, SIZE, position=position, look=look, right=right, up=up) == Camera(*registers)


def test_an_empty_memory_has_a_camera():
    empty = Rom("empty", from_dense(np.zeros((4, 4, 4), np.uint8)), (EMPTY,))
    assert not render(empty, size=SIZE, engine="model").material.any()
    aim_camera(empty, SIZE, look=(0, 0, 1))


@pytest.mark.parametrize(
    "registers",
    [
        {"look": (0, 0, 0)},
        {"right": (0, 0, 0)},
        {"up": (0, 0, 0), "look": (0, 0, 1)},
        {"look": (0, 0, 9), "right": (0, 0, 1)},
        {"look": (0, 0, 9), "up": (0, 0, 1)},
        {"look": (0, 0, 9), "right": (1, 0, 0), "up": (1, 0, 0)},
    ],
)
def test_registers_that_make_no_camera(rom, registers):
    with pytest.raises(ViewpointError):
        aim_camera(rom, SIZE, **registers)


@pytest.mark.parametrize("size", [(64, 48), (48, 64)])
def test_the_authors_camera(size):
    grid = Grid(7, (-4.0, 0.0, -4.0), 0.125)
    viewpoint = Viewpoint(eye=(3.0, 2.0, 9.0), target=(0.0, 1.0, -1.0), field_of_view=40.0)
    camera = authored_camera(viewpoint, grid, size)
    assert camera.position == (7 * 8 * 16, 2 * 8 * 16, 13 * 8 * 16)
    look, up = np.array(camera.look, float), np.array(camera.up, float)
    towards = np.array((-3.0, -1.0, -10.0))
    assert look @ towards / np.linalg.norm(look) / np.linalg.norm(towards) == pytest.approx(1, abs=1e-6)
    half_height = np.linalg.norm(up) * size[1] / 2 / np.linalg.norm(look)
    assert half_height == pytest.approx(np.tan(np.radians(20)), rel=0.01)


@pytest.mark.parametrize("size", [(64, 48), (48, 64)])
def test_a_shifted_camera_sees_a_part_of_a_wider_picture(size):
    """The middle of the picture lies a quarter of its height to the right of the point ahead, and half below it."""
    grid = Grid(7, (-4.0, 0.0, -4.0), 0.125)
    place = {"eye": (3.0, 2.0, 9.0), "target": (0.0, 1.0, -1.0), "field_of_view": 40.0}
    plain = authored_camera(Viewpoint(**place), grid, size)
    moved = authored_camera(Viewpoint(**place, shift=(0.25, -0.5)), grid, size)
    right, up = np.array(moved.right, float), np.array(moved.up, float)
    ahead = moved.look - size[1] * (0.25 * right - 0.5 * up)  # the direction of the point ahead
    look = np.array(plain.look, float)
    assert ahead @ look / np.linalg.norm(ahead) / np.linalg.norm(look) == pytest.approx(1, abs=1e-4)
    half_height = np.linalg.norm(up) * size[1] / 2 / np.linalg.norm(ahead)
    assert half_height == pytest.approx(np.tan(np.radians(20)), rel=0.02)


def test_an_authors_camera_that_cannot_be():
    grid = Grid(7, (0.0, 0.0, 0.0), 1.0)
    with pytest.raises(ViewpointError, match="the scene's camera: "):
        authored_camera(Viewpoint((1, 9, 1), (1, 1, 1), up=(0, 2, 0)), grid, (64, 48))


@pytest.mark.parametrize(("target", "up"), [((4, 0, 4), (0, 0, -1)), ((4, 18, 4), (0, 0, 1))])
def test_an_authors_camera_may_look_straight_down_or_up(target, up):
    """As a map: -z is at the top of what lies below, +z of what hangs above."""
    camera = authored_camera(Viewpoint((4, 9, 4), target), Grid(3, (0.0, 0.0, 0.0), 1.0), (64, 48))
    assert camera.look[0] == camera.look[2] == 0
    assert np.sign(camera.up).tolist() == list(up)
