"""The renderer: one device, its scene, the view, and the frames of both."""

from __future__ import annotations

import asyncio
import logging
import math
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from msgspec.structs import replace

from voxrt.board.edited_scene import rom_of, with_materials
from voxrt.board.errors import DeviceError, FrameDropped, Refused, TooSlow
from voxrt.board.frame_drop import FrameDrop
from voxrt.board.scene import Scene
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.view import View, frame_world, refit
from voxrt.board.view_check import check_view
from voxrt.octree import Octree, solid_bounds
from voxrt.octree.words import EMPTY
from voxrt.serve.packets import FramePacket
from voxrt.sim.backgrounds import background_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from voxrt.board.device import Device, Frame, Identity
    from voxrt.board.scene_memory import Progress
    from voxrt.board.view import Triple
    from voxrt.octree import World
    from voxrt.serve.clients import Clients
    from voxrt.serve.requests import ChangeView

    Result = TypeVar("Result")

DEFAULT_SIZE = (640, 480)
"""Columns and rows of the frames until a client changes the size. Cameras of scenes are made for it."""

_PATIENCE = 60.0  # seconds
_SMALLER = 4  # what may take longer begins with frames that have this part of columns and rows

EMPTY_SCENE = Scene(
    "nothing",
    1,
    np.array([EMPTY], dtype=np.uint32),
    np.full((256, 3), 24, dtype=np.uint8),
    np.zeros(256, dtype=np.bool_),
)
"""The scene until another one is loaded: empty space, dark grey."""

_REGISTERS_SECONDS = 0.05
_OUTDATED_SECONDS = 0.5
"""Frames that take longer are dropped when the view changes. One of two frames is never dropped, so that frames appear
however often the view changes."""
_LOG = logging.getLogger("voxrt.serve")


def _ignore() -> None:
    pass


class Renderer:
    """Renders a frame when the view or the scene has changed and a client is ready for it, or without end.

    All calls of the device come from one thread, and never two at a time. A scene is loaded in steps between frames;
    :class:`~.scene_memory.SceneMemory` says what frames show meanwhile. Every frame has a time limit. A scene whose
    first frame exceeds it is refused, and the present one stays.

    Parameters
    ----------
    device
        The ray tracer.
    """

    def __init__(self, device: Device) -> None:
        size = _first_size(device.identity)
        self.device = device
        self.scene = EMPTY_SCENE
        self.world: World | None = None  # the scene, once it is edited
        self._edits = 0
        self.scene_number = 0
        self.crc32 = EMPTY_SCENE.crc32
        self.bounds: tuple[Triple, Triple] | None = None
        self.view = View(frame_world(EMPTY_SCENE.depth, size), size, EMPTY_SCENE.background)
        self.nonstop = False
        self.frames = 0
        self.trouble: str | None = None
        self._memory = SceneMemory(device)
        self._thread = ThreadPoolExecutor(1, "device")
        self._aside = ThreadPoolExecutor(1, "aside")
        self._shown_frame: int | None = 0  # of the animation, that the device shows; None where that is not known
        self._loading = asyncio.Lock()
        self._device_lock = asyncio.Lock()  # fair: frames and the steps of a scene that is loaded take turns
        self._changed = asyncio.Event()
        self._newest_request = (0, 0)
        self._registers: Mapping[str, int] = {}
        self._registers_time = -math.inf
        self._first_frame: tuple[View, Frame] | None = None  # of a scene that was loaded
        self._drop: FrameDrop | None = None  # of the present frame, if it may be dropped
        self._frame_began = -math.inf
        self._dropped = False  # whether the last frame was

    def change_view(self, change: ChangeView, client: int, request: int) -> None:
        """Change the view; frames then carry the numbers `client` and `request`.

        Raises
        ------
        Refused
            The device cannot render the new view; the present one stays.
        """
        view = change.applied_to(self.view)
        check_view(view, self.device.identity)
        if view.frame >= len(self.scene.roots):
            last = len(self.scene.roots) - 1
            raise Refused(f"there is no frame {view.frame}; those of {self.scene.name} are 0 to {last}")
        self.view = view
        if change.nonstop is not None:
            self.nonstop = change.nonstop
        self._newest_request = (client, request)
        self._changed.set()
        if self._drop is not None:
            loop, drop, self._drop = asyncio.get_running_loop(), self._drop, None
            loop.call_at(max(loop.time(), self._frame_began + _OUTDATED_SECONDS), drop.request)

    def check_scene(self, scene: Scene) -> None:
        """Refuse a scene that the device cannot hold or render; nothing is written."""
        self._memory.check(scene)
        check_view(self._view_of(scene, self.view.size), self.device.identity)

    async def load(self, scene: Scene, progress: Progress, check: Callable[[], None] = _ignore) -> None:
        """Load a scene while frames of the present one are rendered, and show it from the next frame on.

        Parameters
        ----------
        scene
            The scene.
        progress
            Receives what is done; called from the device's thread.
        check
            Called between two steps; if it raises an error, the present scene stays, and the error is raised again.

        Raises
        ------
        Refused
            The device cannot hold or render it, or its first frame exceeds the limit of frames, also where it is
            smaller. The present scene stays.
        DeviceError
            The device did not keep it; the present scene stays.
        """
        async with self._loading:
            bounds = await self.aside(partial(self._check_and_measure, scene))
            steps = self._memory.load_in_steps(scene, progress, partial(self._render_first, scene, progress))
            complete = False
            while not complete:
                async with self._device_lock:
                    check()
                    self._shown_frame = None  # the present scene may be selected anew, if this one fails
                    try:
                        complete = await self._on_device(partial(_finish_step, steps))
                    except TooSlow as error:
                        raise Refused(
                            f"{scene.name} is too slow to show ({error}); build it again, with a smaller depth"
                        ) from error
                    if complete:
                        assert self._first_frame is not None
                        self.scene, self.crc32, self.bounds = scene, scene.crc32, bounds
                        self.view = self._first_frame[0]
                        self.scene_number += 1
                        self.world, self._edits = None, 0
        self._changed.set()

    async def edit(self, change: Callable[[World], None], client: int, request: int) -> dict[str, int]:
        """Edit the scene; frames then carry the numbers `client` and `request`. Return the figures of the edit.

        Raises
        ------
        Refused
            The scene is an animation, `change` refuses, or the device has no room for the result.
        DeviceError
            The device did not keep what was written. Frames show the voxels before; the next edit shows both.
        """
        number = self.scene_number
        async with self._loading:
            if self.scene_number != number:
                raise Refused("another scene was loaded meanwhile; look at it, and edit it then")
            world = await self.aside(partial(self._changed_world, change, client))
            async with self._device_lock:
                written = await self._on_device(partial(self._show_world, world))
        self._newest_request = (client, request)
        self._changed.set()
        self._edits += 1
        return {**self.edits(client), "blocks": written, "words": 1 + 8 * world.figures().blocks}

    def edits(self, client: int | None) -> dict[str, int]:
        """Count the edits of the scene, and those that a client can undo and do again."""
        undo, redo = (0, 0) if self.world is None or client is None else self.world.steps_of(client)
        materials = 0 if self.world is None else len(self.world.materials)
        return {"number": self._edits, "undo": undo, "redo": redo, "materials": materials}

    async def materials(self) -> list[tuple[str, str]]:
        """Return the names and the colours of the scene's materials, by id."""
        world = self.world
        found = (await self.aside(partial(rom_of, self.scene))).materials if world is None else world.materials
        return [(one.name, "#{:02x}{:02x}{:02x}".format(*one.colour)) for one in found]

    def still_scene(self) -> Scene:
        """Return the scene with its octree as it is now; Refused if it is an animation. It may take seconds."""
        if len(self.scene.roots) > 1:
            raise Refused(f"{self.scene.name} is an animation, whose frames share blocks; load a scene of one frame")
        world = self.world
        return self.scene if world is None else replace(self.scene, words=world.rom().octree.words)

    def _changed_world(self, change: Callable[[World], None], client: int) -> World:
        world = self.world
        if world is None:
            world = self._memory.world_of(self.still_scene())
        world.author = client
        change(world)
        return world

    def _show_world(self, world: World) -> int:
        scene = with_materials(self.scene, world.materials)
        if self.world is None:
            self._memory.begin_edits(world, scene)
        written = self._memory.show_edits(scene)
        self._shown_frame = 0
        self.scene, self.world = scene, world
        return written

    async def aside(self, call: Callable[[], Result]) -> Result:
        """Call what looks at a scene, in a thread beside that of the device; one at a time, each takes a moment."""
        return await asyncio.get_running_loop().run_in_executor(self._aside, call)

    async def read_registers(self) -> Mapping[str, int]:
        """Read the registers of the device between two frames; they may have been read a moment ago for another."""
        async with self._device_lock:
            now = time.monotonic()
            if now - self._registers_time > _REGISTERS_SECONDS:
                self._registers = await self._on_device(self.device.registers)
                self._registers_time = now
            return self._registers

    async def render_view(self, view: View) -> Frame:
        """Render one frame of another view; the view of the session stays."""
        check_view(view, self.device.identity)
        async with self._device_lock:
            return await self._on_device(partial(self._render, view))

    async def run(self, clients: Clients) -> None:
        """Render frames for `clients`, without end; an error is told to them, and the next change tries again."""
        self._changed.set()
        while True:
            if not self.nonstop:
                await self._changed.wait()
            await clients.wait_until_ready()
            self._changed.clear()
            trouble = None
            try:
                clients.queue_frame(await self._next_frame())
            except FrameDropped:
                self._changed.set()
                continue
            except TooSlow as error:
                trouble = f"{error}: move the camera, choose a smaller picture, or load another scene"
            except DeviceError as error:
                trouble = str(error)
            except MemoryError:
                trouble = "there is not enough memory for a frame; choose a smaller picture"
            except Exception as error:  # noqa: BLE001 - the loop goes on, whatever a device does
                trouble = f"the frame failed: {type(error).__name__}: {error}; please report this"
                _LOG.exception("a frame failed; please report this")
            if trouble is not None:
                self.nonstop = False
            if trouble != self.trouble:
                self.trouble = trouble
                clients.queue_state()

    def close(self) -> None:
        """End the present frame and close the device."""
        self.device.stop()
        self._aside.shutdown(wait=False, cancel_futures=True)
        self._thread.submit(self.device.close)
        self._thread.shutdown()

    async def _next_frame(self) -> FramePacket:
        async with self._device_lock:
            view, scene_number, (client, request) = self.view, self.scene_number, self._newest_request
            first, self._first_frame = self._first_frame, None
            if first is not None and first[0] == view:
                frame = first[1]
            else:
                frame = await self._render_until_outdated(view)
        self.frames += 1
        return FramePacket(self.frames, scene_number, client, request, frame)

    async def _render_until_outdated(self, view: View) -> Frame:
        """Render a frame; raise FrameDropped where it takes long and the view changes."""
        drop = None if self._dropped else FrameDrop()
        self._drop, self._frame_began, self._dropped = drop, asyncio.get_running_loop().time(), False
        try:
            return await self._on_device(partial(self._render, view, drop))
        except FrameDropped:
            self._dropped = True
            raise
        finally:
            self._drop = None

    def _check_and_measure(self, scene: Scene) -> tuple[Triple, Triple] | None:
        self._memory.check(scene)  # before anything else looks at its words
        return solid_bounds(Octree(scene.depth, scene.words))

    def _render(self, view: View, drop: FrameDrop | None = None, seconds: float | None = None) -> Frame:
        if view.frame != self._shown_frame:
            self._memory.select_frame(view.frame)
            self._shown_frame = view.frame
        return self.device.frame(view, seconds or self.device.identity.frame_seconds(view.size), drop)

    def _render_first(self, scene: Scene, progress: Progress) -> None:
        progress("render", 0, 1)
        self._shown_frame = 0  # of the scene that was selected just now
        size = self.view.size
        view = self._view_of(scene, size)
        try:
            frame = self._render(view)
        except TooSlow:
            view = self._view_of(scene, _smaller_size(size, self.device.identity.width_step))
            # All other viewers wait meanwhile.
            frame = self._render(view, seconds=self.device.identity.frame_seconds(size) / _SMALLER)
        self._first_frame = view, frame

    async def _on_device(self, call: Callable[[], Result]) -> Result:
        # A call of the device goes on when its caller is cancelled, so it is shielded. The next call waits in the same
        # thread.
        work = asyncio.get_running_loop().run_in_executor(self._thread, call)
        work.add_done_callback(_retrieve_error)
        return await asyncio.shield(work)

    def _view_of(self, scene: Scene, size: tuple[int, int]) -> View:
        camera = refit(scene.camera, DEFAULT_SIZE, size) if scene.camera else frame_world(scene.depth, size)
        view = replace(self.view, camera=camera, size=size, background=background_of(scene.background), frame=0)
        lighting = scene.lighting
        if lighting is None:
            side, farthest = 16 << scene.depth, self.device.identity.position_limit - 1
            place = min(side, farthest), min(2 * side, farthest), min(side, farthest)
            return replace(view, lighting=replace(view.lighting, position=place))
        return replace(view, lighting=lighting.within(self.device.identity.features))


def _first_size(identity: Identity) -> tuple[int, int]:
    part = _SMALLER if identity.frame_seconds(DEFAULT_SIZE) > _PATIENCE else 1
    columns, rows = (min(side // part, most) for side, most in zip(DEFAULT_SIZE, identity.size, strict=True))
    return columns, rows


def _smaller_size(size: tuple[int, int], width_step: int) -> tuple[int, int]:
    return max(size[0] // (_SMALLER * width_step), 1) * width_step, max(size[1] // _SMALLER, 1)


def _retrieve_error(work: asyncio.Future[Any]) -> None:
    """Mark the error of a call as seen: a caller that was cancelled does not ask for it."""
    if not work.cancelled():
        work.exception()


def _finish_step(steps: Iterator[None]) -> bool:
    """Do the next step; True when there are no more."""
    return next(steps, "complete") is not None
