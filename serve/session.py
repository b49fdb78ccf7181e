"""The session that all clients of a server share: renderer, clients, control, scene library."""

from __future__ import annotations

import asyncio
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict
from functools import partial
from typing import TYPE_CHECKING, Any

from ..board.errors import Refused
from ..board.view import frame_world
from .clients import Clients
from .control_transfer import ControlTransfer
from .packets import CHUNK_LIMIT, PROTOCOL_VERSION
from .renderer import DEFAULT_SIZE, Renderer
from .upload import UPLOAD_LIMIT

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..board.device import Device
    from ..board.scene import Scene
    from ..board.scene_memory import Progress
    from .scene_library import SceneLibrary


class Session:
    """One device, and everything that its clients share.

    Parameters
    ----------
    device
        The ray tracer; :meth:`close` closes it.
    library
        The scenes that can be loaded.
    """

    def __init__(self, device: Device, library: SceneLibrary) -> None:
        self.renderer = Renderer(device)
        self.clients = Clients(self.state)
        self.control = ControlTransfer(time.monotonic)
        self._library = library
        self._reader_thread = ThreadPoolExecutor(1, "reader")
        self._scene_change = asyncio.Lock()
        self._started = time.monotonic()

    async def run(self) -> None:
        """Render frames for the clients, without end."""
        await self.renderer.run(self.clients)

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

    async def load_files(
        self, files: Mapping[str, bytes], progress: Progress, *, check_only: bool, allowed: Callable[[], bool]
    ) -> Scene:
        """Make a scene from files and load it; with `check_only` nothing is written to the device.

        Raises
        ------
        Refused
            The files are no scene, it does not fit, another scene is being loaded, or `allowed` returns False when the
            scene has been made.
        DeviceError
            The device did not keep the scene; the present one stays.
        """
        return await self._load(
            partial(self._library.reader, files, progress), progress, check_only=check_only, allowed=allowed
        )

    async def load_named(self, name: str, progress: Progress, *, allowed: Callable[[], bool]) -> Scene:
        """Load a scene of the library. Raises what :meth:`load_files` raises."""
        return await self._load(self._library.find(name), progress, check_only=False, allowed=allowed)

    def close(self) -> None:
        """Close the device."""
        self._reader_thread.shutdown(wait=False, cancel_futures=True)
        self.renderer.close()

    async def _load(
        self, make_scene: Callable[[], Scene], progress: Progress, *, check_only: bool, allowed: Callable[[], bool]
    ) -> Scene:
        if self._scene_change.locked():
            raise Refused("another scene is being loaded; try again when it is shown")
        async with self._scene_change:
            scene = await asyncio.get_running_loop().run_in_executor(self._reader_thread, make_scene)
            self.renderer.check_scene(scene)
            if check_only:
                return scene
            if not allowed():
                raise Refused("another viewer took control meanwhile; the scene was not changed")
            await self.renderer.load(scene, progress)
        self.clients.queue_state()
        return scene
