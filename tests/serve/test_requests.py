"""Messages of clients: correct ones are read, all others are refused in one line."""

from __future__ import annotations

import contextlib
import json
import re
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxrt.board.device import Counters, Frame
from voxrt.board.errors import Refused
from voxrt.board.view import Camera, View
from voxrt.serve.packets import Chunk, FramePacket, pack_chunk, pack_frame, unpack_chunk, unpack_frame
from voxrt.serve.requests import CastRay, StartUpload, TakeControl, UploadedFile, read_request, request_number

CAMERA = {"position": [-160, 0, 16], "look": [0, 0, -90], "right": [1, 0, 0], "up": [0, 1, 0]}


def test_requests():
    assert read_request('{"type": "take", "request": 7}') == TakeControl(request=7)
    assert read_request('{"type": "ray", "origin": [1, 2, 3], "direction": [0, 0, -1]}') == CastRay(
        origin=(1, 2, 3), direction=(0, 0, -1)
    )
    change = {"type": "view", "camera": CAMERA, "features": ["light"], "shading": "flat", "frame": 3}
    view = read_request(json.dumps(change)).applied_to(View(Camera(*4 * [(1, 2, 3)]), (64, 48), (9, 8, 7)))
    assert view.camera == Camera((-160, 0, 16), (0, 0, -90), (1, 0, 0), (0, 1, 0))
    assert (view.size, view.background, view.frame) == ((64, 48), (9, 8, 7), 3)
    assert (view.lighting.on, view.lighting.bounces, view.lighting.shading) == (True, 0, "flat")
    upload = {"type": "upload", "files": [{"name": "a.mem", "size": 9, "crc32": 1}], "check_only": True}
    started = read_request(json.dumps(upload))
    assert started == StartUpload(files=(UploadedFile("a.mem", 9, 1),), check_only=True)


@pytest.mark.parametrize(
    ("message", "problem"),
    [
        ("", "truncated"),
        ("[" * 100000, "is no request"),
        ("[]", "Expected `object`"),
        ('{"type": "fly"}', "Invalid value 'fly' - at `$.type`"),
        ('{"type": ["take"]}', "Expected `str`"),
        ('{"request": 1}', "missing required field `type`"),
        ('{"type": "take", "request": -1}', "Expected `int` >= 0 - at `$.request`"),
        ('{"type": "take", "request": true}', "Expected `int`, got `bool` - at `$.request`"),
        ('{"type": "take", "now": 1}', "unknown field `now`"),
        ('{"type": "view", "background": [0, 0, 256]}', "Expected `int` <= 255 - at `$.background[2]`"),
        ('{"type": "view", "background": [0, 0]}', "Expected `array` of length 3 - at `$.background`"),
        ('{"type": "view", "camera": {}}', "missing required field `position` - at `$.camera`"),
        (json.dumps({"type": "view", "camera": {**CAMERA, "look": [0, 0, 32768]}}), "at `$.camera.look[2]`"),
        (json.dumps({"type": "view", "camera": {**CAMERA, "look": [0, 0, 0.5]}}), "at `$.camera.look[2]`"),
        ('{"type": "view", "size": [0, 1]}', "Expected `int` >= 1 - at `$.size[0]`"),
        ('{"type": "view", "features": ["fog"]}', "Invalid enum value 'fog' - at `$.features[0]`"),
        ('{"type": "view", "shading": "gouraud"}', "Invalid enum value 'gouraud' - at `$.shading`"),
        ('{"type": "view", "shading": ["flat"]}', "at `$.shading`"),
        ('{"type": "view", "nonstop": 1}', "Expected `bool | null`, got `int` - at `$.nonstop`"),
        ('{"type": "ray", "origin": [0, 0, 0], "direction": [0, 0, 1048576]}', "at `$.direction[2]`"),
        ('{"type": "upload", "files": []}', "Expected `array` of length >= 1 - at `$.files`"),
        ('{"type": "upload", "files": [{"name": "a", "size": 1}]}', "missing required field `crc32`"),
        ('{"type": "upload", "files": [{"name": "\\u0000", "size": 1, "crc32": 0}]}', "is not a name"),
        ('{"type": "upload", "files": [{"name": "../a", "size": 1, "crc32": 0}]}', "is no plain file name"),
        (
            '{"type": "upload", "files": [{"name": "a", "size": 1, "crc32": 0}, {"name": "A", "size": 1, "crc32": 0}]}',
            "two files have the name a",
        ),
        ('{"type": "show", "scene": ""}', "is not a name"),
        ('{"type": "show"}', "missing required field `scene`"),
    ],
)
def test_refused(message, problem):
    with pytest.raises(Refused, match=re.escape(problem)):
        read_request(message)


@given(
    st.text()
    | st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
        lambda inner: (
            st.lists(inner, max_size=4)
            | st.dictionaries(
                st.sampled_from(["type", "request", "camera", "position", "size", "files", "name", "crc32"])
                | st.text(max_size=3),
                inner | st.sampled_from(["view", "upload", "show", "take"]),
                max_size=5,
            )
        ),
        max_leaves=12,
    ).map(json.dumps)
)
def test_any_text(text):
    assert 0 <= request_number(text) < 2**32
    with contextlib.suppress(Refused):
        read_request(text)


def test_frame_layout():
    """Every field of docs/protocol.md."""
    colour = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3)
    message = pack_frame(FramePacket(5, 6, 7, 8, Frame(colour, Counters(6, 2**40, None, 0.0125))))
    assert struct.unpack_from("<4sHHHH", message) == (b"VXFR", 56, 3, 2, 0)
    assert struct.unpack_from("<7I2Q", message, 12) == (5, 18, 6, 7, 8, 6, 12500, 2**64 - 1, 2**40)
    assert message[56:] == bytes(range(18))
    back = unpack_frame(message)
    assert (back.sequence, back.scene, back.client, back.request) == (5, 6, 7, 8)
    assert back.frame.counters == Counters(6, 2**40, None, 0.0125)
    assert (back.frame.colour == colour).all()
    for broken in (message[:-1], message + b"x", message[:20], b"", b"VXFRUIT" * 12):
        with pytest.raises(Refused):
            unpack_frame(broken)


@given(st.binary(max_size=60))
def test_any_chunk(data):
    with contextlib.suppress(Refused):
        unpack_chunk(data)
    if data:
        message = pack_chunk(Chunk(3, 4, data))
        assert unpack_chunk(message) == message or unpack_chunk(message).data == data
        with pytest.raises(Refused, match="CRC-32"):
            unpack_chunk(message[:-1] + bytes([message[-1] ^ 1]))
