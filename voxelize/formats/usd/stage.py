"""Opening a stage: variants, unit, up axis, and layers that disagree with the root layer."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from pxr import Tf, Usd, UsdGeom

from voxrt.voxelize import arguments
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.usd.values import numbers

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from voxrt.voxelize.warning_log import WarningLog


def open_stage(path: Path, variants: Sequence[str]) -> Usd.Stage:
    """Open a stage with all payloads, and select variants in the order given. The file stays unchanged.

    A selection is ``"/prim/path:set=name"``. Raise AssetError where it names a prim, a set or a variant that does not
    exist.
    """
    stage = Usd.Stage.Open(str(path))
    stage.SetEditTarget(stage.GetSessionLayer())
    for selection in variants:
        key, _, name = selection.partition("=")
        prim_path, _, set_name = key.rpartition(":")
        prim = stage.GetPrimAtPath("/" + prim_path.strip("/")) if prim_path.strip("/") else None
        if not prim:
            raise AssetError(path, f"variant {selection!r}: no such prim", fix="write it as /prim/path:set=name")
        sets = prim.GetVariantSets().GetNames()
        if set_name not in sets:
            known = ", ".join(sets) or "none"
            raise AssetError(path, f"no variant set {set_name!r}", place=str(prim.GetPath()), fix=f"it has {known}")
        names = prim.GetVariantSet(set_name).GetVariantNames()
        if name not in names:
            known = ", ".join(names) or "none"
            raise AssetError(
                path, f"no variant {name!r} of {set_name!r}", place=str(prim.GetPath()), fix=f"it has {known}"
            )
        prim.GetVariantSet(set_name).SetVariantSelection(name)
    return stage


def time_code(stage: Usd.Stage, seconds: float | None) -> Usd.TimeCode:
    """Return the time to read at: `seconds` after the stage's start, or the start for None."""
    if not stage.HasAuthoredTimeCodeRange():
        # Without a range: the earliest samples, and values without samples.
        return Usd.TimeCode(seconds * stage.GetTimeCodesPerSecond()) if seconds else Usd.TimeCode.EarliestTime()
    return Usd.TimeCode(stage.GetStartTimeCode() + (seconds or 0.0) * stage.GetTimeCodesPerSecond())


def note_animation(stage: Usd.Stage, log: WarningLog) -> None:
    """Count the animated layers, of which one moment is shown."""
    moving = sum(len(layer.ListAllTimeSamples()) > 1 for layer in stage.GetUsedLayers())
    if moving:
        log.add("animation", "animated layers are shown at the stage's start", moving)


def up_axis(stage: Usd.Stage, log: WarningLog) -> str:
    """Return ``"x"``, ``"y"`` or ``"z"``; USD's default y, with a warning, for any other value."""
    up = str(UsdGeom.GetStageUpAxis(stage))
    if up.lower() not in ("x", "y", "z"):
        log.add("up-axis", f"upAxis {up!r} is not X, Y or Z; Y was used")
        return "y"
    return up.lower()


def metres_per_unit(stage: Usd.Stage, path: Path) -> float:
    """Return the root layer's unit in metres; raise AssetError where it is no positive number, or out of range."""
    try:
        unit = float(UsdGeom.GetStageMetersPerUnit(stage))
    except Tf.ErrorException:  # some exporters store a float where USD wants a double
        unit = (numbers(stage.GetRootLayer().pseudoRoot.GetInfo("metersPerUnit"), 1) or (math.nan,))[0]
    if not (math.isfinite(unit) and unit > 0):
        raise AssetError(path, f"metersPerUnit {unit} is not a positive number", fix="set it to the metres per unit")
    try:
        return arguments.metres_per_unit("metersPerUnit", unit)
    except ValueError as error:
        raise AssetError(path, str(error), fix="set it to the metres per unit") from None


def note_layers_that_disagree(stage: Usd.Stage, log: WarningLog) -> None:
    """Count layers whose unit or up axis differs from the root layer's: USD does not convert their content."""
    root = stage.GetRootLayer()
    for key, kind in (("metersPerUnit", "unit"), ("upAxis", "up axis")):
        own = root.pseudoRoot.GetInfo(key)
        others = [
            layer
            for layer in stage.GetUsedLayers()
            if layer != root and layer.pseudoRoot.HasInfo(key) and layer.pseudoRoot.GetInfo(key) != own
        ]
        log.add(
            "layers-disagree", f"layers with another {kind} were read in the root layer's, as USD does", len(others)
        )
