"""A frame server in this process, and what tests ask of its frames."""

from __future__ import annotations

from contextlib import asynccontextmanager

from fakes.device import FakeDevice
from fakes.scene_reader import ReadyScenes

from voxrt.boards.board_scenes import asset_reader
from voxrt.serve.frame_client import open_client
from voxrt.serve.scene_library import SceneLibrary
from voxrt.serve.server import FrameServer
from voxrt.serve.server_options import ServerOptions

CAMERA = {"position": [80, 0, 0], "look": [0, 0, -90], "right": [1, 0, 0], "up": [0, 1, 0]}


def ignore(_stage, _done, _total):
    pass


@asynccontextmanager
async def served(device=None, loaded=None, scenes=None, reader=None, **options):
    device = device or FakeDevice()
    own = ReadyScenes(**scenes or {})
    library = SceneLibrary(reader or asset_reader(), own.files, own)
    async with FrameServer(device, library, ServerOptions(**options)) as server:
        if loaded is not None:
            await server.session.renderer.load(loaded, ignore)
        yield server
    assert not isinstance(device, FakeDevice) or device.closed


@asynccontextmanager
async def controlled(*arguments, **options):
    """The same with a client that has control."""
    async with served(*arguments, **options) as server, open_client(server.url) as client:
        await client.take_control()
        yield server, client


async def frame_where(client, condition):
    while not condition(packet := await client.next_frame()):
        pass
    return packet


def pixel(packet):
    return tuple(packet.frame.colour[0, 0].tolist())
