"""The legacy protocol, byte by byte."""

from __future__ import annotations

import contextlib
import struct

from fakes.device import FakeDevice, scene
from fakes.frame_server import served
from fakes.sockets import ended, raw_connection
from hypothesis import given
from hypothesis import strategies as st

from voxrt.board.errors import DeviceError
from voxrt.board.view import Camera
from voxrt.serve.legacy_server import read_legacy_request

field = st.integers(-2048, 2047)
triple = st.tuples(field, field, field)


def spell(position, look, right, up, background):
    """As the desktop client does: binary digits, two fields of 12 bits per word."""
    (px, py, pz), (lx, ly, lz), (rx, ry, rz), (ux, uy, uz) = position, look, right, up
    fields = ((lz, ly), (lx, pz), (py, px), (rz, ry), (rx, uz), (uy, ux))
    words = [int("00000000" + "".join(format(value & 0xFFF, "012b") for value in pair), 2) for pair in fields]
    red, green, blue = background
    return struct.pack("<7I", *words, int(f"00000000{blue:08b}{green:08b}{red:08b}", 2))


@given(triple, triple, triple, triple, st.tuples(*[st.integers(0, 255)] * 3))
def test_request(position, look, right, up, background):
    request = spell(position, look, right, up, background)
    # In a world of 2**10 voxels per side a unit is a voxel.
    assert read_legacy_request(request, 10) == (
        Camera(tuple(16 * value for value in position), look, right, up),
        background,
    )
    assert read_legacy_request(request, 6)[0].position == position


async def test_pictures():
    device = FakeDevice(size=(640, 512))
    async with served(device, scene(material=9), legacy_port=0) as server:
        before = server.session.renderer.view
        async with raw_connection(server.legacy_port) as (reader, writer):
            for x in (3, 200):
                request = spell((512 * x, 0, 0), (0, 0, 90), (1, 0, 0), (0, 1, 0), (1, 2, 3))
                writer.write(request[:5])
                await writer.drain()
                writer.write(request[5:])
                picture = await reader.readexactly(512 * 512 * 3)
                assert picture[:2] == bytes((9, (((512 * x + 2048) % 4096 - 2048) * 32 // 1024) & 0xFF))
                assert len({picture[i : i + 3] for i in range(0, len(picture), 3)}) == 1
            assert server.session.renderer.view == before
            # An incomplete request, a failing device, too many clients: the server closes each connection.
            device.fail_frames = DeviceError("the lanes hang")
            async with raw_connection(server.legacy_port) as (other_reader, other):
                other.write(b"\0" * 27)
                other.write_eof()
                assert await ended(other_reader)
            async with raw_connection(server.legacy_port) as (other_reader, other):
                other.write(b"\0" * 28)
                assert await ended(other_reader)
            async with contextlib.AsyncExitStack() as stack:
                readers = [(await stack.enter_async_context(raw_connection(server.legacy_port)))[0] for _ in range(4)]
                assert await ended(readers[-1])
