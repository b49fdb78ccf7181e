"""A scene of the points of a file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import asset_name
from voxrt.voxelize.formats.scene_frame import FARTHEST, in_range
from voxrt.voxelize.materials import EMPTY
from voxrt.voxelize.point_cloud import PointCloud
from voxrt.voxelize.scene import Scene, SceneObject

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray

    from voxrt.voxelize.warning_log import WarningLog


def cloud_scene(
    path: Path,
    positions: NDArray[np.floating],
    colours: NDArray[np.uint8] | None,
    transform: NDArray[np.float64],
    *,
    least: int | None,
    log: WarningLog,
) -> Scene:
    """Return a scene of one point cloud; AssetError where no point has a place.

    `positions` have shape (N, 3), `colours` (N, 3), sRGB; `transform` leads from the file's frame to the scene's;
    `least` points make a voxel solid, 1 where it is None.
    """
    usable = in_range(positions)
    if not usable.all():
        message = f"points whose coordinates are not numbers below {FARTHEST:g} were left out"
        log.add("broken-point", message, int((~usable).sum()))
        positions, colours = positions[usable], None if colours is None else colours[usable]
    if not len(positions):
        raise AssetError(path, "has no points", fix="export it again")
    name = asset_name(path)
    one = SceneObject(name, transform=transform, points=PointCloud(positions, colours, least or 1))
    return Scene(name, (one,), (EMPTY,), log.warnings())
