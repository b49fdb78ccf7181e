"""A Blender file to a scene, in this process: ``child.py`` calls it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import bpy
from msgspec.structs import replace

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.blend.rendered import as_rendered
from voxrt.voxelize.formats.blend.scene import read_depsgraph
from voxrt.voxelize.formats.external_files import ALLOW_OUTSIDE, ExternalFiles, asset_name
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from voxrt.voxelize.formats.reader_process.limits import Allowance
    from voxrt.voxelize.scene import Scene

_MAGIC = (b"BLENDER", b"\x28\xb5\x2f\xfd", b"\x1f\x8b")  # plain, or compressed by zstd or gzip
_OLD = re.compile(rb"BLENDER([_-])([vV])(\d)(\d\d)")


def read_file(
    path: Path, allowance: Allowance, *, time: float | None, allow_outside: bool, opaque_from: float
) -> Scene:
    """Read what a render of a file shows; :func:`~voxrt.voxelize.formats.blend.isolated.read_isolated` says how."""
    allowance.add(path.stat().st_size)
    _open(path)
    log = WarningLog()
    external_files = ExternalFiles.of(path, allow_outside=allow_outside)
    for library in bpy.data.libraries:
        _check_library(path, library, external_files, allowance)
    for image in bpy.data.images:
        _check_image(image, external_files, allowance, log)
    if bpy.app.autoexec_fail or any(text.use_module for text in bpy.data.texts):
        log.add("script", "scripts in the file, and drivers that are scripts, were not run")
    scene = bpy.context.scene
    if time is not None:
        frame = scene.frame_start + time * scene.render.fps / scene.render.fps_base
        scene.frame_set(int(frame // 1), subframe=frame % 1)

    def read(depsgraph: Any) -> Scene:
        return read_depsgraph(depsgraph, bpy.data.materials, asset_name(path), path=path, opaque_from=opaque_from)

    found = as_rendered(scene, bpy.context.view_layer, read)
    return replace(found, warnings=(*log.warnings(), *found.warnings))


def _open(path: Path) -> None:
    with path.open("rb") as file:
        head = file.read(12)
    if not head.startswith(_MAGIC):
        raise AssetError(path, "is not a Blender file", fix="check the file")
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        old = _OLD.match(head)
        if old is not None and old[2] == b"V":
            problem = f"was saved by Blender {old[3].decode()}.{old[4].decode()} on a processor of another byte order"
            fix = "open it in Blender 4 and save it again"
        else:
            first = str(error).strip().splitlines()[0].removeprefix("Error: ").strip()
            problem, fix = f"Blender cannot open it ({first[:200]})", "it is damaged: repair it or save it again"
        raise AssetError(path, problem, fix=fix) from None
    if Path(bpy.data.filepath).name != path.name:
        raise AssetError(path, "Blender did not open it", fix="it is damaged: repair it or save it again")


def _check_library(path: Path, library: Any, files: ExternalFiles, allowance: Allowance) -> None:
    """Refuse a library that stands outside the file's folder, or is missing; allow what reading it takes."""
    name = bpy.path.abspath(library.filepath)
    if Path(name).is_relative_to(bpy.utils.system_resource("DATAFILES")):  # brushes that come with Blender
        return
    if files.is_outside(name):
        raise AssetError(path, f"library {library.filepath!r} is outside the file's folder", fix=ALLOW_OUTSIDE)
    found = files.find(name)
    if found is None or library.is_missing:
        problem = f"library {library.filepath!r} was not found or cannot be read"
        raise AssetError(path, problem, fix="put it there, or make its data local in Blender")
    allowance.add(found.stat().st_size)


def _check_image(image: Any, files: ExternalFiles, allowance: Allowance, log: WarningLog) -> None:
    """Forget an image that stands outside the file's folder; allow what reading another takes."""
    if image.source not in ("FILE", "SEQUENCE", "TILED") or image.packed_file is not None or not image.filepath:
        return
    name = bpy.path.abspath(image.filepath, library=image.library)
    if files.is_outside(name):
        log.add("outside", f"texture {image.name!r} is outside the file's folder and was not opened; {ALLOW_OUTSIDE}")
        image.filepath = ""
        return
    found = files.find(name)
    if found is not None:
        allowance.add(found.stat().st_size)
