"""The show: what all viewers share — the stage, the audience, who steers, which scenes there are."""

from __future__ import annotations

import asyncio
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

from ..board.errors import Refused
from .clients import Audience
from .handover import Handover
from .packets import CHUNK_LIMIT
from .receiving import UPLOAD_LIMIT
from .renderer import Stage

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..board.device import Device
    from ..board.scene import Scene
    from ..board.scene_memory import Progress
    from .scene_files import SceneReader

PROTOCOL = 1
"""Version of the protocol; a client refuses a server of another."""


@dataclass(frozen=True, slots=True)
class Program:
    """What a show can put on.

    Attributes
    ----------
    reader
        Makes scenes of uploaded files.
    library
        The server's own scenes by name, read when they are asked for.
    """

    reader: SceneReader
    library: Mapping[str, Callable[[], Scene]] = field(default_factory=dict)


class Show:
    """One device and everybody who watches it.

    Parameters
    ----------
    device
        The ray tracer; closed with the show.
    program
        What can be put on.
    """

    def __init__(self, device: Device, program: Program) -> None:
        self.stage = Stage(device)
        self.audience = Audience(self.state)
        self.handover = Handover(time.monotonic)
        self._program = program
        self._reading = ThreadPoolExecutor(1, "reader")
        self._scene_change = asyncio.Lock()
        self._began = time.monotonic()

    async def run(self) -> None:
        """Render for the viewers, for ever."""
        await self.stage.run(self.audience)

    def hello(self, viewer: int) -> dict[str, Any]:
        """Tell a new viewer what this is."""
        identity = self.stage.device.identity
        return {
            "type": "hello",
            "protocol": PROTOCOL,
            "viewer": viewer,
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
            "scenes": sorted(self._program.library),
            "suffixes": self._program.reader.suffixes,
            "limits": {"chunk": CHUNK_LIMIT, "upload": UPLOAD_LIMIT},
        }

    def state(self) -> dict[str, Any]:
        """Tell what is shown now."""
        stage, scene = self.stage, self.stage.scene
        return {
            "type": "state",
            "viewers": len(self.audience),
            "controller": self.handover.controller,
            "waiting": self.handover.waiting,
            "scene": {
                "number": stage.scene_number,
                "name": scene.name,
                "depth": scene.depth,
                "words": len(scene.words),
                "crc32": stage.crc32,
                "camera": asdict(stage.first_view.camera),
                "size": stage.first_view.size,
            },
            "view": {
                "camera": asdict(stage.view.camera),
                "size": stage.view.size,
                "background": stage.view.background,
                "light": stage.view.lighting.position,
                "ambient": stage.view.lighting.ambient,
                "features": sorted(stage.view.lighting.features),
                "bounces": stage.view.lighting.bounces,
                "nonstop": stage.nonstop,
            },
            "trouble": stage.trouble,
        }

    def counters(self) -> dict[str, int | float]:
        """Tell what the server has counted since it began."""
        return {
            "seconds": round(time.monotonic() - self._began, 3),
            "frames": self.stage.frames,
            "dropped": self.audience.dropped,
            "viewers": len(self.audience),
            "scenes": self.stage.scene_number,
        }

    async def put_on_files(
        self, files: Mapping[str, bytes], progress: Progress, *, check_only: bool, allowed: Callable[[], bool]
    ) -> Scene:
        """Make a scene of files and run it, or stop before its first word is written.

        Raises
        ------
        Refused
            The files make no scene, it does not fit, another change is under way, or `allowed` no longer holds when
            the scene is ready.
        DeviceError
            The device did not keep it; the old scene runs on.
        """
        return await self._change_scene(
            partial(self._program.reader, files, progress), progress, check_only=check_only, allowed=allowed
        )

    async def put_on_listed(self, name: str, progress: Progress, *, allowed: Callable[[], bool]) -> Scene:
        """Run a scene of the library. Raises what :meth:`put_on_files` does."""
        if name not in self._program.library:
            raise Refused(f"there is no scene {name!r}; there are {', '.join(sorted(self._program.library)) or 'none'}")
        return await self._change_scene(self._program.library[name], progress, check_only=False, allowed=allowed)

    def close(self) -> None:
        """Let go of the device."""
        self._reading.shutdown(wait=False, cancel_futures=True)
        self.stage.close()

    async def _change_scene(
        self, make: Callable[[], Scene], progress: Progress, *, check_only: bool, allowed: Callable[[], bool]
    ) -> Scene:
        if self._scene_change.locked():
            raise Refused("another scene is on its way; wait until it is there")
        async with self._scene_change:
            scene = await asyncio.get_running_loop().run_in_executor(self._reading, make)
            self.stage.check_scene(scene)
            if check_only:
                return scene
            if not allowed():
                raise Refused("control passed to another viewer meanwhile; the scene was not changed")
            await self.stage.put_on(scene, progress)
        self.audience.refresh()
        return scene
