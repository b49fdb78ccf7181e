"""Cameras: what they see, which way round, and what their registers hold."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from voxrt.sim import Camera, camera_from_registers, frame_points, look_at, pixel_directions

SIZES = [(640, 480), (480, 640), (256, 256), (97, 31), (1920, 1080)]
voxel = st.floats(-1500, 1500, width=32)
place = st.tuples(voxel, voxel, voxel)


def project(camera, size, points):
    """Give the column and row at which points are seen, and which of them lie ahead; floats."""
    frame = np.array([camera.right, camera.up, camera.look], np.float64).T
    across, up, ahead = np.linalg.solve(frame, (np.asarray(points) - np.array(camera.position) / 16).T)
    return size[0] // 2 + across / ahead, size[1] // 2 - up / ahead, ahead > 0


@settings(max_examples=200, deadline=None)
@given(eye=place, target=place, size=st.sampled_from(SIZES), field_of_view=st.floats(5, 120))
def test_look_at_sees_the_target_in_the_middle(eye, target, size, field_of_view):
    line = np.subtract(target, eye)
    if np.linalg.norm(np.cross(line, (0, 1, 0))) < 0.05 * np.linalg.norm(line) or np.linalg.norm(line) < 100:
        return
    camera = look_at(eye, target, size=size, field_of_view=field_of_view)
    column, row, ahead = project(camera, size, [target])
    pixels_a_voxel = min(size) / (2 * np.tan(np.radians(field_of_view) / 2)) / np.linalg.norm(line)
    rounding = 0.05 * pixels_a_voxel * 2 + 0.002 * min(size) / np.tan(np.radians(field_of_view) / 2)
    assert ahead[0]
    assert abs(column[0] - size[0] // 2) < rounding
    assert abs(row[0] - size[1] // 2) < rounding


@settings(max_examples=200, deadline=None)
@given(eye=place, target=place, size=st.sampled_from(SIZES), field_of_view=st.floats(5, 170))
def test_cameras_are_right_handed_upright_and_in_range(eye, target, size, field_of_view):
    line = np.subtract(target, eye)
    if np.linalg.norm(np.cross(line, (0, 1, 0))) < 0.05 * np.linalg.norm(line) or np.linalg.norm(line) < 1e-3:
        return
    camera = look_at(eye, target, size=size, field_of_view=field_of_view)
    look, right, up = (np.array(triple, np.float64) for triple in (camera.look, camera.right, camera.up))
    assert np.linalg.det([right, up, -look]) > 0
    assert up[1] > 0
    assert abs(right[1]) <= 0.5
    triples = np.abs([camera.look, camera.right, camera.up])
    directions = np.abs(pixel_directions(camera, size))
    assert triples.max() < 1 << 15
    assert directions.max() < 1 << 20
    # The largest scale: one of the two limits is met but for rounding.
    assert triples.max() >= (1 << 15) - 2 or directions.max() >= (1 << 20) - 2 * sum(size)


def test_text_reads_from_left_to_right():
    # From the front (+z), +x is on the right and +y is up.
    camera = look_at((8, 8, 100), (8, 8, 0), size=(64, 64))
    (column, row, _) = project(camera, (64, 64), [[10, 8, 0], [8, 10, 0]])
    assert column[0] > 33
    assert row[1] < 31


@settings(max_examples=200, deadline=None)
@given(
    corner=st.tuples(*[st.integers(0, 1000)] * 3),
    extent=st.tuples(*[st.integers(1, 1024)] * 3),
    size=st.sampled_from([*SIZES, (33, 200)]),
)
def test_the_whole_scene_is_in_view_and_fills_it(corner, extent, size):
    low = np.array(corner)
    high = np.minimum(low + extent, 1024)
    corners = np.array([[(low, high)[i >> a & 1][a] for a in range(3)] for i in range(8)])
    camera = frame_points(corners, size)
    column, row, ahead = project(camera, size, corners)
    assert np.all(ahead)
    assert column.min() >= 0
    assert column.max() <= size[0] - 1
    assert row.min() >= 0
    assert row.max() <= size[1] - 1
    if min(extent) >= 8:  # below that, 1/16 voxel of the camera's position is more than a pixel
        # Left free on each side of the tighter axis, and at least on each side of the other.
        tighter = min((size[0] - np.ptp(column)) / size[0], (size[1] - np.ptp(row)) / size[1]) / 2
        assert 0.08 <= tighter <= 0.2
        free = column.min() / size[0], 1 - column.max() / size[0], row.min() / size[1], 1 - row.max() / size[1]
        assert min(free) > 0.07
    assert np.abs(camera.position).max() < 1 << 16
    eye = np.array(camera.position) / 16
    assert np.all(eye > (low + high) / 2)  # right, above, in front


def test_registers_are_taken_as_they_are():
    camera = camera_from_registers((450, 600.03, -300.5), (0, 0, 90), (1, 0, 0), (0, 1, 0))
    assert camera == Camera((7200, 9600, -4808), (0, 0, 90), (1, 0, 0), (0, 1, 0))


def test_what_no_register_holds_is_refused():
    with pytest.raises(ValueError, match=r"camera look .* signed 16 bits"):
        camera_from_registers((0, 0, 0), (0, 0, 1 << 15), (1, 0, 0), (0, 1, 0))
    with pytest.raises(ValueError, match=r"camera right .* whole numbers"):
        camera_from_registers((0, 0, 0), (0, 0, 1), (0.5, 0, 0), (0, 1, 0))
    with pytest.raises(ValueError, match="camera position"):
        camera_from_registers((0, 2.0**28, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0))
    with pytest.raises(ValueError, match="camera position"):
        camera_from_registers((0, float("nan"), 0), (0, 0, 1), (1, 0, 0), (0, 1, 0))


def test_cameras_that_cannot_be_made_say_why():
    with pytest.raises(ValueError, match="coincide"):
        look_at((1, 2, 3), (1, 2, 3), size=(8, 8))
    with pytest.raises(ValueError, match="up points along"):
        look_at((1, 2, 3), (1, 9, 3), size=(8, 8))
    with pytest.raises(ValueError, match="field of view"):
        look_at((1, 2, 3), (1, 2, 9), size=(8, 8), field_of_view=180)
