"""From which opacity a surface is solid, and the words for what is left out because it is less opaque."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.errors import AssetError

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from voxrt.voxelize.errors import SceneWarning
    from voxrt.voxelize.warning_log import WarningLog

OPAQUE_FROM = 0.5
"""The default: surfaces of lower opacity are left out. Voxels are solid or empty; half of the light decides."""


def log_left_out(log: WarningLog, opacity: float, cutoff: float, opaque_from: float, faces: int) -> None:
    """Count faces that are left out in a log: `opacity` is the highest that they have, `cutoff` what they needed."""
    if opacity <= 0:
        message = "fully transparent faces were left out"
    elif cutoff == opaque_from:
        message = (
            f"faces less opaque than {opaque_from:g} were left out: a lower --opaque-from keeps them, "
            "unless their material has a threshold"
        )
    else:
        message = "faces below the opacity threshold of their material were left out"
    log.add("transparent", message, faces)


def nothing_shown(path: Path, warnings: Iterable[SceneWarning]) -> AssetError:
    """Return the error for a file without triangles; it says whether all of them were left out."""
    for warning in warnings:
        if warning.kind == "transparent":
            return AssetError(path, f"shows nothing: {warning.message}", fix="make its colours opaque")
    return AssetError(path, "has no triangles", fix="export it with its surface")
