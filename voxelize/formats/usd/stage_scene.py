"""A USD stage to a scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

from pxr import Sdf

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import ExternalFiles, asset_name
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.formats.scene_frame import scene_transform
from voxrt.voxelize.formats.usd.cameras import read_cameras
from voxrt.voxelize.formats.usd.diagnostics import caught
from voxrt.voxelize.formats.usd.layers import open_layers, refuse_layers_opened_outside
from voxrt.voxelize.formats.usd.stage import (
    metres_per_unit,
    note_animation,
    note_layers_that_disagree,
    open_stage,
    time_code,
    up_axis,
)
from voxrt.voxelize.formats.usd.traversal import StageTraversal
from voxrt.voxelize.scene import Scene
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from voxrt.voxelize.formats.reader_process.limits import Allowance


def read_stage(
    path: Path,
    allowance: Allowance,
    *,
    variants: Sequence[str] = (),
    time: float | None = None,
    allow_outside: bool = False,
    opaque_from: float = OPAQUE_FROM,
) -> Scene:
    """Read a USD stage in this process; :func:`voxrt.voxelize.formats.usd.isolated.read_isolated` says how.

    `allowance` is told of each file before it is opened.
    """
    log = WarningLog()
    external_files = ExternalFiles.of(path, allow_outside=allow_outside)
    before = set(Sdf.Layer.GetLoadedLayers())
    with caught(path, log):
        layers = open_layers(path, external_files, allowance)
        stage = open_stage(path, variants)
        note_layers_that_disagree(stage, log)
        if time is None:
            note_animation(stage, log)
        to_scene = scene_transform(up_axis(stage, log), metres_per_unit(stage, path))
        moment = time_code(stage, time)
        traversal = StageTraversal(path, stage, external_files, log, allowance, moment, opaque_from)
        objects = traversal.objects(to_scene)
        cameras = read_cameras(stage, moment, to_scene, log)
        refuse_layers_opened_outside(path, external_files, before)
        del layers  # kept open until here, so that the stage need not parse them again
    if not objects:
        reasons = "; ".join(one.message for one in log.warnings())
        raise AssetError(path, "shows nothing" + (f" ({reasons})" if reasons else ""), fix="check it with usdview")
    viewpoint = cameras[0] if cameras else None
    return Scene(
        asset_name(path),
        objects,
        traversal.materials.table.materials(),
        log.warnings(),
        viewpoint=viewpoint,
        cameras=cameras,
    )
