"""Messages of clients: correct ones are read, all others are refused in one line."""

from __future__ import annotations

import contextlib
import json
import struct

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxrt.board.device import Counters, Frame
from voxrt.board.errors import Refused
from voxrt.board.view import Camera
from voxrt.serve.packets import Chunk, FramePacket, pack_chunk, pack_frame, unpack_chunk, unpack_frame
from voxrt.serve.requests import ChangeView, StartUpload, TakeControl, UploadedFile, read_request, request_number

CAMERA = {"position": [-160, 0, 16], "look": [0, 0, -90], "right": [1, 0, 0], "up": [0, 1, 0]}


def test_requests():
    assert read_request('{"type": "take", "request": 7}') == (7, TakeControl())
    change = {"type": "view", "camera": CAMERA, "features": ["light"], "shading": "flat", "nonstop": True}
    assert read_request(json.dumps(change)) == (
        0,
        ChangeView(
            camera=Camera((-160, 0, 16), (0, 0, -90), (1, 0, 0), (0, 1, 0)),
            features=frozenset({"light"}),
            shading="flat",
            nonstop=True,
        ),
    )
    upload = {"type": "upload", "files": [{"name": "a.mem", "size": 9, "crc32": 1}], "check_only": True}
    assert read_request(json.dumps(upload)) == (0, StartUpload((UploadedFile("a.mem", 9, 1),), check_only=True))


@pytest.mark.parametrize(
    ("message", "problem"),
    [
        ("", "no JSON"),
        ("[" * 100000, "no JSON"),
        ("[]", "no JSON object"),
        ('{"type": "fly"}', "'fly' is no type of request; there are cancel, counters"),
        ('{"type": ["take"]}', "is no type of request"),
        ('{"type": "take", "request": -1}', "request -1 is not a whole number from 0"),
        ('{"type": "take", "request": true}', "request True"),
        ('{"type": "take", "now": 1}', "the request take has no field 'now'"),
        ('{"type": "view", "background": [0, 0, 256]}', "background 256 is not a whole number from 0 to 255"),
        ('{"type": "view", "background": [0, 0]}', "background is not three numbers"),
        ('{"type": "view", "camera": {}}', "camera is not {position, look, right, up}"),
        (json.dumps({"type": "view", "camera": {**CAMERA, "look": [0, 0, 32768]}}), "camera.look 32768"),
        (json.dumps({"type": "view", "camera": {**CAMERA, "look": [0, 0, 0.5]}}), "camera.look 0.5"),
        ('{"type": "view", "size": [0, 1]}', "size 0"),
        ('{"type": "view", "features": ["fog"]}', "features is not a list of light, mirrors"),
        ('{"type": "view", "shading": "gouraud"}', "shading 'gouraud' is not faces, report or flat"),
        ('{"type": "view", "shading": ["flat"]}', "shading .* is not faces"),
        ('{"type": "view", "nonstop": 1}', "nonstop 1 is not true or false"),
        ('{"type": "upload", "files": []}', "files is not a list of 1 to 64 files"),
        ('{"type": "upload", "files": [{"name": "a", "size": 1}]}', "a file of an upload is not"),
        ('{"type": "upload", "files": [{"name": "\\u0000", "size": 1, "crc32": 0}]}', "is not a name"),
        ('{"type": "show"}', "scene None is not a name"),
    ],
)
def test_refused(message, problem):
    with pytest.raises(Refused, match=problem.replace("[", r"\[").replace("{", r"\{")):
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
