"""Pictures of one memory from many cameras: one after another, or on a cluster."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import Struct

from voxrt import sim
from voxrt.errors import ToolError
from voxrt.plans.open_workers import open_workers
from voxrt.plans.workers import in_order
from voxrt.views.pictures import render
from voxrt.views.viewpoint import CameraAim, ViewpointError

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator, Sequence

    from voxrt.octree import Rom
    from voxrt.octree.camera import Camera
    from voxrt.options.render_options import RenderOptions
    from voxrt.sim import Frame

_MOST_CAMERAS = 1 << 16  # 36 minutes of 30 pictures a second
_MOST_BYTES = 1 << 26
_KEYS = {"position", "look", "right", "up"}


class PictureJob(Struct, frozen=True, eq=False):
    """What all pictures of a path have in common."""

    rom: Rom
    options: RenderOptions
    check: bool  # whether both engines render each picture


class PathPicture(Struct, frozen=True, eq=False):
    """A picture of a path."""

    number: int  # that of its camera, counted from 0
    frame: Frame
    wrong_pixels: int | None  # that differ between the engines; None if that was not asked for


def read_cameras(path: str | os.PathLike[str], rom: Rom, size: tuple[int, int]) -> list[Camera]:
    """Read a file of cameras: JSON, a list of objects with any of `position`, `look`, `right` and `up`.

    They mean what the options of ``voxrt render`` of these names mean, three numbers each. What a camera does not say
    is chosen to show the whole scene. ViewpointError if the file cannot be read, or says something else.

    Examples
    --------
    >>> import voxrt
    >>> from pathlib import Path
    >>> rom = voxrt.build("examples/house.obj", depth=4).rom
    >>> _ = Path("path.json").write_text('[{"position": [8, 20, 60], "look": [0, -1, -3]}, {}]')
    >>> len(read_cameras("path.json", rom, (640, 480)))
    2
    """
    try:
        with Path(path).open("rb") as file:
            data = file.read(_MOST_BYTES + 1)
        if len(data) > _MOST_BYTES:
            raise ViewpointError(f"{path}: is no path of cameras: it has more than {_MOST_BYTES >> 20} MiB")
        entries = json.loads(data.decode())
    except OSError as error:
        raise ViewpointError(f"{path}: cannot be read: {error.strerror}") from None
    except (ValueError, RecursionError) as error:
        raise ViewpointError(f"{path}: is not JSON: {error}") from None
    if not isinstance(entries, list) or not entries:
        raise ViewpointError(f'{path}: is not a list of cameras; write [{{"position": [x, y, z], ...}}, ...]')
    if len(entries) > _MOST_CAMERAS:
        raise ViewpointError(f"{path}: has {len(entries):,} cameras; render at most {_MOST_CAMERAS:,} at once")
    aim = CameraAim(rom, size)
    return [_camera(f"{path}: camera {number}", one, aim) for number, one in enumerate(entries)]


def take_picture(job: PictureJob, number: int, camera: Camera) -> PathPicture:
    """Render a picture, here or on a worker; ToolError if it cannot be rendered."""
    try:
        if not job.check:
            return PathPicture(number, render(job.rom, camera, job.options), None)
        checked = sim.check(job.rom, camera, **job.options.for_engines())
        return PathPicture(number, getattr(checked, job.options.chosen_engine), checked.wrong_pixels)
    except Exception as error:
        raise ToolError(f"camera {number}: {error}") from error


def take_pictures(
    job: PictureJob, cameras: Sequence[Camera], scheduler: str | None = None, workers: int | None = None
) -> Iterator[PathPicture]:
    """Render the pictures of a path, in its order; on a cluster if one is named, each by one task.

    ToolError if a picture cannot be rendered, or the cluster is not there or lost.
    """
    with open_workers(scheduler, workers, remedy="start it, and this command, again") as found:
        yield from in_order(found.completed(take_picture, list(enumerate(cameras)), (job,)))


def _camera(where: str, entry: object, aim: CameraAim) -> Camera:
    if not isinstance(entry, dict) or not entry.keys() <= _KEYS:
        raise ViewpointError(f"{where}: is not an object with position, look, right and up alone")
    for name, value in entry.items():
        if not (isinstance(value, list) and len(value) == 3) or not all(
            isinstance(one, int | float) and not isinstance(one, bool) for one in value
        ):
            raise ViewpointError(f"{where}: {name} must be three numbers")
    try:
        position = entry.get("position")
        if position is not None:
            position = tuple(round(16 * one) for one in position)
        look, right, up = (None if name not in entry else _register(entry[name]) for name in ("look", "right", "up"))
        return aim.camera(position=position, look=look, right=right, up=up)
    except (ValueError, TypeError, OverflowError) as error:
        raise ViewpointError(f"{where}: {error}") from None


def _register(vector: list[float]) -> tuple[int, int, int]:
    x, y, z = vector
    return int(x), int(y), int(z)
