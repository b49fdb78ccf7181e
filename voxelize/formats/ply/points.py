"""PLY files without faces: point clouds, and the centres of Gaussians."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.ply.colours import stored_colours
from voxrt.voxelize.formats.ply.format import ListColumn, Table
from voxrt.voxelize.formats.points.cloud_scene import cloud_scene
from voxrt.voxelize.formats.scene_frame import scene_transform

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.scene import Scene
    from voxrt.voxelize.warning_log import WarningLog

_GAUSSIAN = {"f_dc_0", "f_dc_1", "f_dc_2", "opacity"}
_HALF_TURN = np.diag([-1.0, -1.0, 1.0, 1.0])  # about z, as viewers of splats turn them
_CONSTANT_HARMONIC = 0.28209479177387814
"""The spherical harmonic that is the same in all directions: Kerbl et al., "3D Gaussian Splatting", 2023."""


def load_points(
    path: Path,
    vertices: Table,
    up: str | None,
    unit: float | None,
    log: WarningLog,
    *,
    opaque_from: float,
    least: int | None,
) -> Scene:
    """Return the scene of vertices that are points: those of an opacity of `opaque_from` or more.

    `up` and `unit` are as for :func:`load_ply`; `least` points make a voxel solid. AssetError where there are none.
    """
    positions, transform = places(path, vertices), scene_transform(up, unit)
    colours: NDArray[np.uint8] | None
    if not len(positions):
        raise AssetError(path, "has neither faces nor points", fix="export it again")
    if vertices.keys() >= _GAUSSIAN:
        log.add("gaussian-splat", "the file is a Gaussian splat: the centres of its Gaussians were taken as points")
        if up is None:
            log.add("up-axis", "y points down in most Gaussian splats: the scene was turned; --up y leaves it as it is")
            transform = transform @ _HALF_TURN
        colours, opacity = _of_gaussians(vertices)
    else:
        colours, opacity = stored_colours(vertices, log) or (None, np.ones(len(positions)))
    shown = opacity >= opaque_from
    if not shown.any():
        raise AssetError(path, "has no visible points", fix="build with a lower --opaque-from")
    if not shown.all():
        log.add("transparent", f"points of an opacity below {opaque_from:g} were left out", int((~shown).sum()))
        positions, colours = positions[shown], None if colours is None else colours[shown]
    return cloud_scene(path, positions, colours, transform, least=least, log=log)


def places(path: Path, vertices: Table) -> NDArray[np.floating]:
    """Return the places of vertices, shape (N, 3), of the type that the file has; AssetError where they have none."""
    axes = [vertices.get(axis) for axis in "xyz"]
    if any(axis is None or isinstance(axis, ListColumn) for axis in axes):
        problem = "has vertices without x, y and z" if vertices else "has neither faces nor points"
        raise AssetError(path, problem, fix="export it again")
    kind = np.float32 if all(axis.dtype.str[1:] == "f4" for axis in axes) else np.float64  # type: ignore[union-attr]
    return np.stack([np.asarray(axis, kind) for axis in axes], axis=1)


def _of_gaussians(vertices: Table) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """Return the colours of Gaussians, the same in all directions, and their opacities: files hold its log odds."""
    constant = np.stack([np.asarray(vertices[f"f_dc_{channel}"], np.float64) for channel in range(3)], axis=1)
    with np.errstate(over="ignore"):
        opacity = 1 / (1 + np.exp(-np.asarray(vertices["opacity"], np.float64)))
    colours = np.clip(np.nan_to_num(0.5 + _CONSTANT_HARMONIC * constant), 0, 1)
    return np.round(colours * 255).astype(np.uint8), np.nan_to_num(opacity)
