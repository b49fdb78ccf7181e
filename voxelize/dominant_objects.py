"""Objects so much larger than the others that they alone decide the size of a voxel."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.collider_shapes import bounding_points
from voxrt.voxelize.mesh import Mesh
from voxrt.voxelize.object_proxies import proxies

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.object_proxies import Geometry
    from voxrt.voxelize.scene import Scene

_MOST = 8
_NARROW = 1 / 16
"""Wider parts of the scene are no details beside the large objects: a coarse grid is coarse for all."""

_FEWEST_VOXELS = 8


def dominant_objects(scene: Scene, voxels: int, geometry: Geometry) -> tuple[tuple[str, ...], float]:
    """Find the few largest objects beside which all others together span fewer than eight voxels.

    `voxels` is the number of voxels per side of a grid that is as wide as the scene. Return the names of the objects,
    the largest first, at most eight and none where there are no such objects, and the longest side of the others'
    bounding box in metres.

    >>> from voxrt.voxelize import EMPTY, Material, Mesh, Scene, SceneObject
    >>> sail = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], [1])
    >>> ground = SceneObject("ground", sail, np.diag([500.0, 500, 500, 1]))
    >>> scene = Scene("boat", [ground, SceneObject("sail", sail)], [EMPTY, Material("cloth", (240, 240, 230))])
    >>> dominant_objects(scene, 128, "auto")
    (('ground',), 1.0)
    """
    if len(scene.objects) < 2:
        return (), 0.0
    owners, low, high = _object_bounds(scene, geometry)
    if len(owners) < 2:
        return (), 0.0
    sides = (high - low).max(axis=1)
    order = np.argsort(-sides, kind="stable")
    # Row k bounds the objects from place k of that order on.
    lowest = np.minimum.accumulate(low[order][::-1], axis=0)[::-1]
    highest = np.maximum.accumulate(high[order][::-1], axis=0)[::-1]
    widths = (highest - lowest).max(axis=1)
    narrow = widths[0] * min(_FEWEST_VOXELS / voxels, _NARROW)
    for count in range(1, min(_MOST, len(order) - 1) + 1):
        if sides[order[count - 1]] < narrow:
            break  # a small object far from the others is not to blame
        if 0 < widths[count] < narrow:
            return tuple(scene.objects[owners[row]].name for row in order[:count]), float(widths[count])
    return (), 0.0


def _object_bounds(scene: Scene, geometry: Geometry) -> tuple[list[int], NDArray[np.float64], NDArray[np.float64]]:
    """Return the objects that have something to voxelize, and boxes that hold them: float64, shape (N, 3)."""
    boxes: dict[int, tuple[object, NDArray[np.float64], list[int]]] = {}
    for index, item in enumerate(scene.objects):
        for shape in proxies(item, geometry) or (() if item.hidden else (item.mesh,)):
            if id(shape) not in boxes:
                points = (
                    shape.positions[shape.triangles.reshape(-1)] if isinstance(shape, Mesh) else bounding_points(shape)
                )
                if not len(points):
                    continue
                ends = np.stack([points.min(axis=0), points.max(axis=0)]).astype(np.float64)
                corners = np.array([[ends[i & 1, 0], ends[i >> 1 & 1, 1], ends[i >> 2, 2]] for i in range(8)])
                boxes[id(shape)] = (shape, corners, [])
            boxes[id(shape)][2].append(index)
    low = np.full((len(scene.objects), 3), np.inf)
    high = -low
    for _, corners, owners in boxes.values():
        transforms = np.stack([scene.objects[index].transform for index in owners])
        placed = corners @ transforms[:, :3, :3].transpose(0, 2, 1) + transforms[:, None, :3, 3]
        np.minimum.at(low, owners, placed.min(axis=1))
        np.maximum.at(high, owners, placed.max(axis=1))
    there = np.flatnonzero((low <= high).all(axis=1))
    return there.tolist(), low[there], high[there]
