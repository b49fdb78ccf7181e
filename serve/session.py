"""The session that all clients of a server share: renderer, clients, control, scene library."""

from __future__ import annotations

import asyncio
import time
from functools import partial
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from msgspec.structs import asdict

from voxrt.board.errors import Refused
from voxrt.board.scene import MEMORY_SUFFIXES
from voxrt.board.view import frame_world
from voxrt.serve.clients import Clients
from voxrt.serve.control_transfer import ControlTransfer
from voxrt.serve.edits import EditRate, check_operation, run_operation
from voxrt.serve.packets import CHUNK_LIMIT, PROTOCOL_VERSION
from voxrt.serve.renderer import DEFAULT_SIZE, Renderer
from voxrt.serve.saved_scene import SavedScene
from voxrt.serve.scene_load import SceneLoad
from voxrt.serve.upload import UPLOAD_LIMIT, Upload, memory_bytes

if TYPE_CHECKING:
    from collections.abc import Coroutine

    from voxrt.board.device import Device
    from voxrt.board.scene import Scene
    from voxrt.board.scene_memory import Progress
    from voxrt.serve.packets import Chunk
    from voxrt.serve.requests import EditScene, StartUpload
    from voxrt.serve.scene_library import SceneLibrary
    from voxrt.serve.server_options import Limits

_WATCH_SECONDS = 0.5


class Session:
    """One device, and everything that its clients share.

    Parameters
    ----------
    device
        The ray tracer; :meth:`close` closes it.
    library
        The scenes that can be loaded.
    limits
        The load that the clients may be.
    """

    def __init__(self, device: Device, library: SceneLibrary, limits: Limits) -> None:
        self.renderer = Renderer(device)
        self.clients = Clients(self.state, limits)
        self.control = ControlTransfer(time.monotonic, self._drop_work_of)
        self.upload: Upload | None = None
        self._library = library
        self._load: SceneLoad | None = None
        self._memory_bytes = memory_bytes(device.identity.capacity)
        self._edit_rate = EditRate(limits.edits_per_second)
        self._saved: SavedScene | None = None
        self._saving = False
        self._started = time.monotonic()

    async def run(self) -> None:
        """Render frames for the clients, without end."""
        await self.renderer.run(self.clients)

    async def watch(self) -> None:
        """Drop clients that are too slow, and pass control on when the controller is idle, without end."""
        while True:
            await asyncio.sleep(_WATCH_SECONDS)
            self.clients.drop_slow()
            if self._load is not None:
                self.control.use(self._load.client)  # who waits for a scene is not idle
            if self.control.pass_on():
                self.clients.queue_state()

    def hello(self, client: int) -> dict[str, Any]:
        """Return the first message to a client."""
        identity = self.renderer.device.identity
        return {
            "type": "hello",
            "protocol": PROTOCOL_VERSION,
            "viewer": client,
            "device": {
                "name": identity.name,
                "version": identity.version,
                "capacity": identity.capacity,
                "depth": identity.depth,
                "size": identity.size,
                "width_step": identity.width_step,
                "position_limit": identity.position_limit,
                "features": sorted(identity.features),
                "clock": identity.clock,
            },
            "scenes": sorted(self._library.scenes),
            "suffixes": self._library.reader.suffixes,
            "limits": {"chunk": CHUNK_LIMIT, "upload": UPLOAD_LIMIT},
        }

    def state(self) -> dict[str, Any]:
        """Return the message that describes the present state."""
        renderer, scene = self.renderer, self.renderer.scene
        return {
            "type": "state",
            "viewers": len(self.clients),
            "controller": self.control.controller,
            "waiting": self.control.waiting,
            "scene": {
                "number": renderer.scene_number,
                "name": scene.name,
                "depth": scene.depth,
                "words": len(scene.words),
                "crc32": renderer.crc32,
                "bounds": renderer.bounds,
                "camera": asdict(scene.camera or frame_world(scene.depth, DEFAULT_SIZE)),
                "size": DEFAULT_SIZE,
                "frames": len(scene.roots),
                "period": scene.period,
                "voxel_size": scene.voxel_size,
                "warnings": scene.warnings,
                "edits": renderer.edits(self.control.controller),
            },
            "view": {
                "camera": asdict(renderer.view.camera),
                "size": renderer.view.size,
                "background": renderer.view.background,
                "light": renderer.view.lighting.position,
                "ambient": renderer.view.lighting.ambient,
                "features": sorted(renderer.view.lighting.features),
                "shading": renderer.view.lighting.shading,
                "bounces": renderer.view.lighting.bounces,
                "nonstop": renderer.nonstop,
                "frame": renderer.view.frame,
            },
            "trouble": renderer.trouble,
        }

    def counters(self) -> dict[str, int | float]:
        """Return the counters of the server since its start."""
        return {
            "seconds": round(time.monotonic() - self._started, 3),
            "frames": self.renderer.frames,
            "dropped": self.clients.dropped_frames,
            "viewers": len(self.clients),
            "scenes": self.renderer.scene_number,
        }

    def start_upload(self, number: int, announced: StartUpload) -> None:
        """Begin the upload `number`; an incomplete one is dropped.

        Raises
        ------
        Refused
            The files are larger than the limit, or than a memory that the device can hold, or cannot be stored.
        """
        self.drop_upload()
        size = sum(file.size for file in announced.files)
        if size > UPLOAD_LIMIT:
            raise Refused(f"an upload of {size} bytes is more than the limit of {UPLOAD_LIMIT}; make the files smaller")
        for file in announced.files:
            if PurePath(file.name).suffix.lower() in MEMORY_SUFFIXES and file.size > self._memory_bytes:
                identity = self.renderer.device.identity
                raise Refused(
                    f"{file.name} has {file.size} bytes, and {identity.name} holds {identity.capacity} words, which "
                    f"take {self._memory_bytes} at most; build it with a smaller depth"
                )
        self.upload = Upload(number, announced)

    def drop_upload(self) -> None:
        """Remove the files of the present upload, if there is one."""
        if self.upload is not None:
            self.upload.close()
            self.upload = None

    def cancel(self, client: int) -> None:
        """Cancel what the controller `client` uploads, and what is made of it; the present scene stays."""
        if self.control.controller == client:
            self.drop_upload()
        if self._load is not None and self._load.client == client:
            self._load.cancel("cancelled; the scene was not changed")

    async def load_upload(self, client: int, upload: Upload, progress: Progress) -> Scene:
        """Make a scene from the present upload, which is complete, and load it; a mere check writes nothing.

        Raises
        ------
        Refused
            The files are no scene, it does not fit, another scene is being loaded, or this was cancelled.
        DeviceError
            The device did not keep the scene; the present one stays.
        """
        if self.upload is not upload:
            raise Refused("cancelled; the scene was not changed")
        self.upload = None
        try:
            scene = self._library.reader.read(upload.paths, progress)
            return await self._load_scene(client, scene, progress, check_only=upload.announced.check_only)
        finally:
            upload.close()

    async def load_named(self, client: int, name: str, progress: Progress) -> Scene:
        """Load a scene of the library. Raises what :meth:`load_upload` raises."""
        paths = self._library.find(name)
        reader = self._library.scene_reader or self._library.reader
        return await self._load_scene(client, reader.read(paths, progress), progress, check_only=False)

    async def edit(self, client: int, request: EditScene) -> dict[str, int]:
        """Edit the scene, and return the figures of the edit.

        Raises
        ------
        Refused
            Edits come too fast, or this one is too large, or cannot be done; or the scene is an animation.
        DeviceError
            The device did not keep it.
        """
        self._edit_rate.check()
        check_operation(request.operation)
        change = partial(run_operation, request.operation, request.stroke)
        figures = await self.renderer.edit(change, client, request.request)
        self.clients.queue_state()
        return figures

    async def save(self, client: int, number: int, suffix: str) -> list[dict[str, Any]]:
        """Make files of the scene, and describe them; :meth:`saved_part` reads them.

        Raises
        ------
        Refused
            Another scene is being saved, or this one cannot be saved so.
        """
        if self._saving:
            raise Refused("a scene is being saved; ask again when its files are there")
        self._drop_saved()
        self._saving = True
        try:
            saved = await asyncio.to_thread(lambda: SavedScene(number, self.renderer.still_scene(), suffix))
        finally:
            self._saving = False
        if self.control.controller != client:
            saved.close()
            raise Refused("another viewer took control meanwhile; nothing was saved")
        self._saved = saved
        return saved.files

    def saved_part(self, offset: int) -> Chunk:
        """Read a part of the files that were saved last."""
        if self._saved is None:
            raise Refused("no scene was saved; save one first")
        return self._saved.part(offset)

    def stop(self) -> None:
        """End the frame in progress; there are no further ones."""
        self.renderer.device.stop()

    def close(self) -> None:
        """Close the device."""
        self.drop_upload()
        self._drop_saved()
        self.renderer.close()

    def _drop_saved(self) -> None:
        if self._saved is not None:
            self._saved.close()
            self._saved = None

    async def _load_scene(
        self, client: int, made: Coroutine[Any, Any, Scene], progress: Progress, *, check_only: bool
    ) -> Scene:
        if self._load is not None:
            made.close()
            raise Refused("another scene is being loaded; try again when it is shown")
        load = self._load = SceneLoad(client)
        try:
            scene = await load.make(made)
            await self.renderer.aside(partial(self.renderer.check_scene, scene))
            if not check_only:
                await self.renderer.load(scene, progress, load.check)
        finally:
            self._load = None
        if not check_only:
            self.clients.queue_state()
        return scene

    def _drop_work_of(self, client: int) -> None:
        self.drop_upload()
        self._drop_saved()
        if self._load is not None and self._load.client == client:
            self._load.cancel("another viewer took control meanwhile; the scene was not changed")
