"""Loading USD files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import ExternalFiles
from voxrt.voxelize.formats.scene_frame import scene_transform
from voxrt.voxelize.formats.usd.diagnostics import caught
from voxrt.voxelize.formats.usd.layers import refuse_layers_outside, refuse_layers_used_outside
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


def load_usd(
    path: str | Path, *, variants: Sequence[str] = (), time: float | None = None, allow_outside: bool = False
) -> Scene:
    """Read a USD stage.

    The scene shows the active, visible prims of purpose ``default`` and ``render``, with instances, the copies of point
    instancers, and skinned meshes in their pose. The unit and the up axis are the root layer's, as in USD: layers that
    it refers to are not rescaled, and counted where they disagree.

    Parameters
    ----------
    path
        A ``.usd``, ``.usda``, ``.usdc`` or ``.usdz`` file.
    variants
        Variants to select, in this order: ``"/prim/path:set=name"``.
    time
        Seconds after the stage's start; None for the start.
    allow_outside
        Whether layers and textures may stand outside the file's folder.

    Returns
    -------
    Scene
        One object per prim and copy, named by its prim path; materials in order of first use.

    Raises
    ------
    AssetError
        The stage cannot be opened, contradicts itself, or shows nothing.
    DoesNotFitError
        More than 255 materials.
    """
    path = Path(path)
    log = WarningLog()
    external_files = ExternalFiles.of(path, allow_outside=allow_outside)
    with caught(path, log):
        refuse_layers_outside(path, external_files)
        stage = open_stage(path, variants)
        refuse_layers_used_outside(path, stage, external_files)
        note_layers_that_disagree(stage, log)
        if time is None:
            note_animation(stage, log)
        to_scene = scene_transform(up_axis(stage, log), metres_per_unit(stage, path))
        traversal = StageTraversal(path, stage, external_files, log, time_code(stage, time))
        objects = traversal.objects(to_scene)
    if not objects:
        reasons = "; ".join(one.message for one in log.warnings())
        raise AssetError(path, "shows nothing" + (f" ({reasons})" if reasons else ""), fix="check it with usdview")
    return Scene(path.stem, objects, traversal.materials.table.materials(), log.warnings())
