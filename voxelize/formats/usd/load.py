"""One USD file to one scene."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.companions import Companions
from voxrt.voxelize.formats.usd.diagnostics import caught
from voxrt.voxelize.formats.usd.drawing import Drawing
from voxrt.voxelize.formats.usd.layers import refuse_layers_outside, refuse_layers_used_outside
from voxrt.voxelize.formats.usd.stage import (
    metres_per_unit,
    note_animation,
    note_layers_that_disagree,
    open_stage,
    time_code,
    up_axis,
)
from voxrt.voxelize.frames import scene_transform
from voxrt.voxelize.notes import Notes
from voxrt.voxelize.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Sequence


def load_usd(
    path: str | Path, *, variants: Sequence[str] = (), time: float | None = None, allow_outside: bool = False
) -> Scene:
    """Read a USD stage.

    Drawn are the active, visible prims of purpose ``default`` and ``render``, with instances and the copies of point
    instancers, skinned meshes in their pose. The unit and the up axis are the root layer's, as USD has it: layers that
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
        One object a prim and copy, named by its prim path; materials in order of first use.

    Raises
    ------
    AssetError
        The stage cannot be opened, contradicts itself, or draws nothing.
    DoesNotFitError
        More than 255 materials.
    """
    path = Path(path)
    notes = Notes()
    companions = Companions.of(path, allow_outside=allow_outside)
    with caught(path, notes):
        refuse_layers_outside(path, companions)
        stage = open_stage(path, variants)
        refuse_layers_used_outside(path, stage, companions)
        note_layers_that_disagree(stage, notes)
        if time is None:
            note_animation(stage, notes)
        to_scene = scene_transform(up_axis(stage, notes), metres_per_unit(stage, path))
        drawing = Drawing(path, stage, companions, notes, time_code(stage, time))
        objects = drawing.objects(to_scene)
    if not objects:
        said = "; ".join(one.message for one in notes.warnings())
        raise AssetError(path, "draws nothing" + (f" ({said})" if said else ""), fix="check it with usdview")
    return Scene(path.stem, objects, drawing.materials.table.materials(), notes.warnings())
