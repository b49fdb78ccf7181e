"""The handler of one client's messages."""

from __future__ import annotations

import asyncio
import logging
import time
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.board.errors import DeviceError, Refused
from voxrt.octree import Octree, frame_octree
from voxrt.octree.camera import POSITION_UNITS
from voxrt.serve.edits import cut_solid
from voxrt.serve.packets import pack_chunk, unpack_chunk
from voxrt.serve.requests import (
    CancelUpload,
    CastRay,
    ChangeView,
    CutSolid,
    EditScene,
    ListMaterials,
    LoadScene,
    ReadCounters,
    ReadRegisters,
    ReadSaved,
    ReleaseControl,
    SaveScene,
    StartUpload,
    TakeControl,
    read_request,
    request_number,
)
from voxrt.serve.shown_text import shown_line
from voxrt.sim import FACE_NONE, cast_rays
from voxrt.sim.picking import pick

if TYPE_CHECKING:
    from collections.abc import Callable, Coroutine

    from voxrt.board.scene import Scene
    from voxrt.board.scene_memory import Progress
    from voxrt.octree import World
    from voxrt.serve.clients import Client
    from voxrt.serve.renderer import Renderer
    from voxrt.serve.requests import Request
    from voxrt.serve.session import Session

_PROGRESS_SECONDS = 0.05
_REPEAT_SECONDS = 5.0  # of the newest progress, so that a client sees that the server still works
_LOG = logging.getLogger("voxrt.serve")


class RequestHandler:
    """Handles the requests of one client.

    Parameters
    ----------
    session
        The session of the server.
    client
        The client; it gets the answers.
    start_task
        Starts a task that goes on after the client has disconnected.
    """

    def __init__(
        self, session: Session, client: Client, start_task: Callable[[Coroutine[Any, Any, None]], None]
    ) -> None:
        self._session = session
        self._client = client
        self._start_task = start_task

    async def handle(self, message: str | bytes) -> None:
        """Do what a message requests, and answer it. No message makes this raise an error."""
        number = 0
        try:
            if isinstance(message, bytes):
                number = self._upload_number()
                self._handle_chunk(message)
            else:
                try:
                    request = read_request(message)
                except Refused:
                    number = request_number(message)
                    raise
                number = request.request
                await self._handle_request(request)
        except (Refused, DeviceError) as error:
            self._refuse(number, str(error))

    def close(self) -> None:
        """Release control; an incomplete upload ends with it, and what is made of one."""
        self._session.control.release(self._client.number)

    async def _handle_request(self, request: Request) -> None:
        session, client, number = self._session, self._client, request.request
        answer: dict[str, Any] = {"type": "done", "request": number}
        match request:
            case TakeControl():
                answer["granted"] = session.control.request(client.number)
                session.clients.queue_state()
            case ReleaseControl():
                session.control.release(client.number)
                session.clients.queue_state()
            case ReadRegisters():
                answer["registers"] = dict(await session.renderer.read_registers())
            case ReadCounters():
                answer["counters"] = session.counters()
            case CancelUpload():
                session.cancel(client.number)
            case _:
                self._require_control()
                answer |= await self._handle_controller(request)
                if not answer["type"]:
                    return
        client.queue_answer(answer)

    async def _handle_controller(self, request: Request) -> dict[str, Any]:
        """Do what only the client that has control may request; return the answer's fields, `type` empty for none."""
        session, client, number = self._session, self._client, request.request
        answer: dict[str, Any] = {}
        match request:
            case CastRay() | CutSolid() | ListMaterials():
                answer |= await self._describe_scene(request)
            case ChangeView():
                session.renderer.change_view(request, client.number, number)
                session.clients.queue_state()
            case EditScene():
                answer["edit"] = await session.edit(client.number, request)
            case SaveScene():
                answer["files"] = await session.save(client.number, number, request.suffix)
            case ReadSaved():
                if not client.queue_part(pack_chunk(session.saved_part(request.offset))):
                    raise Refused("too many parts are unread; ask for fewer at a time")
                answer["type"] = ""
            case LoadScene():
                self._start_task(self._load(number, partial(session.load_named, client.number, request.scene)))
                answer["type"] = ""
            case StartUpload():
                session.start_upload(number, request)
                answer |= {"type": "ready", "upload": number}
        return answer

    async def _describe_scene(self, request: CastRay | CutSolid | ListMaterials) -> dict[str, Any]:
        renderer = self._session.renderer
        match request:
            case CastRay():
                return {"hit": await renderer.aside(_cast_in(renderer, request))}
            case CutSolid():
                return {"solid": await renderer.aside(_cut_in(renderer, request))}
            case ListMaterials():
                return {"materials": await renderer.materials()}

    def _upload_number(self) -> int:
        session = self._session
        has_control = session.control.controller == self._client.number
        return session.upload.number if session.upload is not None and has_control else 0

    def _handle_chunk(self, message: bytes) -> None:
        session = self._session
        self._require_control()
        upload = session.upload
        if upload is None:
            raise Refused("a chunk came without an upload; announce the upload first")
        try:
            upload.add(unpack_chunk(message))
        except Refused:
            session.drop_upload()
            raise
        self._client.queue_answer({"type": "received", "request": upload.number, "bytes": upload.received})
        if upload.complete:
            self._start_task(self._load(upload.number, partial(session.load_upload, self._client.number, upload)))

    def _require_control(self) -> None:
        if not self._session.control.use(self._client.number):
            raise Refused("this viewer does not have control; take control first")

    async def _load(self, number: int, load: Callable[[Progress], Coroutine[Any, Any, Scene]]) -> None:
        progress = _ReportedProgress(self._client, number)
        progress("read", 0, 1)  # before the process that reads the files has started, which may take long
        repeating = asyncio.ensure_future(progress.repeat())
        try:
            scene = await load(progress)
        except (Refused, DeviceError) as error:
            self._refuse(number, str(error))
        except Exception as error:  # noqa: BLE001 - whatever it is, the client gets an answer
            _LOG.exception("a scene was not loaded; please report this")
            self._refuse(number, f"the scene was not loaded: {type(error).__name__}: {error}; please report this")
        else:
            described = {"name": scene.name, "depth": scene.depth, "words": len(scene.words), "crc32": scene.crc32}
            self._client.queue_answer({"type": "done", "request": number, "scene": described})
        finally:
            repeating.cancel()

    def _refuse(self, number: int, problem: str) -> None:
        self._client.queue_answer({"type": "refused", "request": number, "problem": shown_line(problem)})


def _cast_in(renderer: Renderer, ray: CastRay) -> Callable[[], dict[str, Any] | None]:
    """Return what finds the first solid voxel on a ray in the scene as it is now."""
    if renderer.world is not None:
        return partial(_pick_voxel, renderer.world, ray)
    return partial(_cast_ray, renderer.scene, renderer.view.frame, ray)


def _cut_in(renderer: Renderer, box: CutSolid) -> Callable[[], dict[str, object]]:
    """Return what cuts the solid voxels of a box out of the scene as it is now."""
    scene, world, frame = renderer.scene, renderer.world, renderer.view.frame
    return lambda: cut_solid(world or _frame_of(scene, frame), box.low, box.high)


def _frame_of(scene: Scene, frame: int) -> Octree:
    return frame_octree(Octree(scene.depth, scene.words), scene.roots[frame])


def _cast_ray(scene: Scene, frame: int, ray: CastRay) -> dict[str, Any] | None:
    """Find the first solid voxel on a ray, as the hardware finds it, and where the ray enters it."""
    octree = _frame_of(scene, frame)
    origin, still = np.array(ray.origin) / POSITION_UNITS, not any(ray.direction)
    try:
        hits = cast_rays(octree, origin, (1, 0, 0) if still else ray.direction, threads=1)
    except ValueError as error:
        raise Refused(str(error)) from error
    starts_inside = hits.face[0] == FACE_NONE
    if not hits.hit[0] or (still and not starts_inside):
        return None
    point = origin + hits.parameter[0] * np.array(ray.direction)
    face = None if starts_inside else int(hits.face[0])
    return {"voxel": hits.voxel[0].tolist(), "material": int(hits.material[0]), "face": face, "point": point.tolist()}


def _pick_voxel(world: World, ray: CastRay) -> dict[str, Any] | None:
    """Do what :func:`_cast_ray` does, in a world that is edited."""
    origin, still = np.array(ray.origin) / POSITION_UNITS, not any(ray.direction)
    try:
        found = pick(world, origin, (1, 0, 0) if still else ray.direction)
    except ValueError as error:
        raise Refused(str(error)) from error
    if found is None or (still and found.beside is not None):
        return None
    face, point = None, origin
    if found.beside is not None:
        face = next(axis for axis in range(3) if found.beside[axis] != found.voxel[axis])
        plane = max(found.beside[face], found.voxel[face])
        point = origin + (plane - origin[face]) / ray.direction[face] * np.array(ray.direction)
    return {"voxel": found.voxel, "material": found.material, "face": face, "point": point.tolist()}


class _ReportedProgress:
    """Sends progress to a client, from time to time; other threads may call it."""

    def __init__(self, client: Client, number: int) -> None:
        self._client = client
        self._number = number
        self._loop = asyncio.get_running_loop()
        self._stage, self._time = "", 0.0
        self._message: dict[str, Any] = {}

    def __call__(self, stage: str, done: int, total: int) -> None:
        now = time.monotonic()
        if stage != self._stage or done == total or now - self._time >= _PROGRESS_SECONDS:
            self._stage, self._time = stage, now
            self._message = {"type": "progress", "request": self._number, "stage": stage, "done": done, "total": total}
            self._loop.call_soon_threadsafe(self._client.queue_answer, self._message)

    async def repeat(self) -> None:
        """Send the newest progress again, without end."""
        while True:
            await asyncio.sleep(_REPEAT_SECONDS)
            self._client.queue_answer(self._message)
