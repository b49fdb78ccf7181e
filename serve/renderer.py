"""The stage: one device, the scene on it, the view of it, and the frames that come of them."""

from __future__ import annotations

import asyncio
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from ..board.errors import DeviceError
from ..board.scene import Scene
from ..board.scene_memory import SceneMemory
from ..board.view import View, frame_world, refit
from ..board.view_check import check_view
from .packets import FramePacket

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..board.device import Device, Frame
    from ..board.scene_memory import Progress
    from .clients import Audience
    from .requests import ViewChange

    Result = TypeVar("Result")

FIRST_SIZE = (640, 480)
"""Columns and rows of the frames until somebody asks for others."""

NOTHING = Scene(
    "nothing",
    1,
    np.array([0xFFFFFF00], dtype=np.uint32),
    np.full((256, 3), 24, dtype=np.uint8),
    np.zeros(256, dtype=np.bool_),
)
"""What runs until there is a scene: empty space, dark grey."""


class Stage:
    """Renders a frame whenever the view or the scene has changed and somebody can take it, or without end.

    All calls of the device come from one thread; scenes change between two frames.

    Parameters
    ----------
    device
        The ray tracer.
    """

    def __init__(self, device: Device) -> None:
        columns, rows = device.identity.size
        size = min(FIRST_SIZE[0], columns), min(FIRST_SIZE[1], rows)
        self.device = device
        self.scene = NOTHING
        self.scene_number = 0
        self.crc32 = NOTHING.crc32
        self.view = self.first_view = View(frame_world(NOTHING.depth, size), size, NOTHING.background)
        self.nonstop = False
        self.frames = 0
        self.trouble: str | None = None
        self._memory = SceneMemory(device)
        self._thread = ThreadPoolExecutor(1, "device")
        self._between_frames = asyncio.Lock()
        self._wanted = asyncio.Event()
        self._newest_request = (0, 0)

    def change(self, change: ViewChange, viewer: int, request: int) -> None:
        """Change the view for `viewer`, whose `request` it is.

        Raises
        ------
        Refused
            The device cannot show that; the view stays as it is.
        """
        view = change.applied_to(self.view)
        check_view(view, self.device.identity)
        self.view = view
        if change.nonstop is not None:
            self.nonstop = change.nonstop
        self._newest_request = (viewer, request)
        self._wanted.set()

    def check_scene(self, scene: Scene) -> None:
        """Refuse a scene that the device cannot hold or show; touches nothing."""
        self._memory.check(scene)
        check_view(self._view_of(scene), self.device.identity)

    async def put_on(self, scene: Scene, progress: Progress) -> None:
        """Run a scene, from a frame boundary on; one that fails leaves the old one running.

        Raises
        ------
        Refused
            The device cannot hold or show it.
        DeviceError
            The device did not keep it.
        """
        self.check_scene(scene)
        async with self._between_frames:
            await self._on_device(partial(self._memory.swap, scene, progress))
            self.scene, self.crc32 = scene, scene.crc32
            self.view = self.first_view = self._view_of(scene)
            self.scene_number += 1
        self._wanted.set()

    async def read_registers(self) -> Mapping[str, int]:
        """Read the device's registers, between two frames."""
        async with self._between_frames:
            return await self._on_device(self.device.registers)

    async def private_frame(self, view: View) -> Frame:
        """Render a frame of another view, for one who asks; the show goes on as it was."""
        check_view(view, self.device.identity)
        async with self._between_frames:
            return await self._on_device(partial(self.device.frame, view))

    async def run(self, audience: Audience) -> None:
        """Render for `audience`, for ever."""
        self._wanted.set()
        while True:
            if not self.nonstop:
                await self._wanted.wait()
            await audience.hunger()
            self._wanted.clear()
            async with self._between_frames:
                view, scene_number, (viewer, request) = self.view, self.scene_number, self._newest_request
                trouble = None
                try:
                    frame = await self._on_device(partial(self.device.frame, view))
                except DeviceError as error:
                    trouble, self.nonstop = str(error), False
            if trouble is None:
                self.frames += 1
                audience.show(FramePacket(self.frames, scene_number, viewer, request, frame))
            if trouble != self.trouble:
                self.trouble = trouble
                audience.refresh()

    def close(self) -> None:
        """Let go of the device, after the frame under way."""
        self._thread.submit(self.device.close)
        self._thread.shutdown()

    async def _on_device(self, call: Callable[[], Result]) -> Result:
        # Shielded: a caller that is cancelled leaves the device at work, and the next one must wait for its end.
        work = asyncio.get_running_loop().run_in_executor(self._thread, call)
        return await asyncio.shield(work)

    def _view_of(self, scene: Scene) -> View:
        size = self.view.size
        camera = refit(scene.camera, FIRST_SIZE, size) if scene.camera else frame_world(scene.depth, size)
        view = replace(self.view, camera=camera, background=scene.background)
        lighting = scene.lighting
        if lighting is None:
            side, farthest = 16 << scene.depth, self.device.identity.position_limit - 1
            place = min(side, farthest), min(2 * side, farthest), min(side, farthest)
            return replace(view, lighting=replace(view.lighting, position=place))
        built_in = self.device.identity.features
        return replace(
            view,
            lighting=replace(
                lighting,
                on=lighting.on and "light" in built_in,
                flat=lighting.flat and "flat" in built_in,
                bounces=lighting.bounces if "mirrors" in built_in else 0,
            ),
        )
