"""Parts far away from nearly all of the surface: they decide the size of a voxel, and leave few to the rest."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from voxrt.voxelize import _native
from voxrt.voxelize.object_proxies import proxies

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from voxrt.voxelize.object_proxies import Geometry
    from voxrt.voxelize.scene import Scene, SceneObject

_BULKS = ((0.99, 1 / 8), (0.9, 1 / 64))
"""The least share of the surface, and how wide a box holds it at most, of the scene's width. Wider ones keep enough
voxels. Of a few triangles a stray one may be a larger share."""

_BINS = 64

_ENOUGH = 100_000
"""Triangles among which a bulk is sought."""

_CHUNK = 1 << 18


class StrayParts(Struct, frozen=True):
    """Where nearly all of the surface is, and what lies elsewhere.

    `low` and `high` are the corners of a box that holds a share of the surface, `width` is the longest side of all, in
    metres. `names` are the objects that reach beyond the box, of which `whole` have nothing within it. `place` is the
    farthest corner of their triangles.
    """

    low: tuple[float, float, float]
    high: tuple[float, float, float]
    share: float
    width: float
    names: tuple[str, ...]
    whole: tuple[str, ...]
    place: tuple[float, float, float]


def find_stray_parts(scene: Scene, geometry: Geometry) -> StrayParts | None:
    """Find what lies outside a box that is an eighth as wide as the scene and holds 99 % of its surface.

    Or outside one that is 1/64 as wide and holds 90 %. None where no such box is found: it is sought between quantiles
    of the triangles' middles. Objects that colliders stand for are not looked at; nor is a scene that has some.

    >>> from voxrt.voxelize import EMPTY, Material, Mesh, Scene, SceneObject
    >>> corners = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [900, 0, 0], [900, 1, 0], [900, 0, 0.1]])
    >>> scan = SceneObject("scan", Mesh(corners, [[0, 1, 2], [3, 4, 5]], [1, 1]))
    >>> found = find_stray_parts(Scene("hill", [scan], [EMPTY, Material("earth", (90, 80, 70))]), "auto")
    >>> found.names, found.high, found.place
    (('scan',), (4.0, 4.0, 0.0), (900.0, 0.0, 0.0))
    """
    shown = [item for item in scene.objects if not item.hidden]
    if any(proxies(item, geometry) is not None for item in shown):
        return None
    groups = _groups(shown)
    if sum(one.count for one in groups) < 2:
        return None
    areas, width = _native.areas_by_place([(one.positions, one.triangles, one.transforms) for one in groups], _BINS)
    for share, narrow in _BULKS:
        # The share of the surface between the quantiles of both ends is larger than this, whatever is rounded.
        if not all(_may_be_narrow(axis, narrow, 2 * share - 1.001) for axis in areas):
            continue
        ends = _bulk_ends(_some_corners(groups), share)
        if ends is not None and (ends[1] - ends[0]).max() < width * narrow:
            found = _strays(shown, groups, *ends)
            if found is not None and found.share >= share and _width_of(found) < found.width * narrow:
                return found
    return None


def _width_of(found: StrayParts) -> float:
    return max(high - low for low, high in zip(found.low, found.high, strict=True))


class _Group(Struct, frozen=True, eq=False, dict=True):
    """The objects that share a mesh. Its triangles are numbered object by object."""

    positions: NDArray[np.floating]  # shape (P, 3), in the mesh's frame
    triangles: NDArray[np.int32]  # shape (T, 3)
    transforms: NDArray[np.float64]  # shape (N, 3, 4)
    owners: NDArray[np.int64]  # shape (N,): which objects they are

    @cached_property
    def _axes(self) -> NDArray[np.float64]:
        """The positions with shape (3, P): NumPy is slow along short rows."""
        return np.ascontiguousarray(self.positions.T, np.float64)

    @property
    def count(self) -> int:
        return len(self.owners) * len(self.triangles)

    def some(self, step: int) -> NDArray[np.int64]:
        """Return every `step`-th triangle. The first depends on the group: small ones must not all be left out."""
        return np.arange(int(self.owners[0]) % step, self.count, step)

    def corners(self, numbers: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the corners of triangles in the scene frame: float64, shape (3 corners, 3 axes, T)."""
        which, rows = np.divmod(numbers, len(self.triangles))
        own = (self._axes.take(corner, axis=1) for corner in self.triangles.take(rows, axis=0).T)
        if len(self.owners) == 1:  # by einsum: the threads of `@` cost more than they gain
            turn, move = self.transforms[0, :3, :3], self.transforms[0, :3, 3, None]
            return np.stack([np.einsum("ij,jt->it", turn, one) + move for one in own])
        turns, moves = self.transforms[which, :3, :3], self.transforms[which, :3, 3].T
        return np.stack([np.einsum("tij,jt->it", turns, one) + moves for one in own])

    def chunks(self) -> Iterator[tuple[NDArray[np.int64], NDArray[np.float64]]]:
        """Yield numbers and corners of all triangles, without those that have no area, which stretch no grid.

        Where no triangle has an area, all of them count.
        """
        pieces = [np.arange(begin, min(begin + _CHUNK, self.count)) for begin in range(0, self.count, _CHUNK)]
        any_area = any(bool(_areas(self.corners(numbers)).any()) for numbers in pieces)
        for numbers in pieces:
            corners = self.corners(numbers)
            kept = _areas(corners) > 0 if any_area else np.ones(len(numbers), np.bool_)
            yield numbers[kept], corners[..., kept]


def _groups(shown: list[SceneObject]) -> list[_Group]:
    owners: dict[int, list[int]] = {}
    for index, item in enumerate(shown):
        if len(item.mesh.triangles):
            owners.setdefault(id(item.mesh), []).append(index)
    return [
        _Group(
            np.ascontiguousarray(mesh.positions),
            np.ascontiguousarray(mesh.triangles, np.int32),
            np.stack([shown[i].transform[:3] for i in own]),
            np.array(own, np.int64),
        )
        for own in owners.values()
        for mesh in (shown[own[0]].mesh,)
    ]


def _some_corners(groups: list[_Group]) -> NDArray[np.float64]:
    """Return the corners of many triangles, or of all."""
    step = max(1, sum(one.count for one in groups) // _ENOUGH)
    return np.concatenate([one.corners(one.some(step)) for one in groups], axis=2)


def _areas(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    with np.errstate(over="ignore", invalid="ignore"):
        one, two = corners[1] - corners[0], corners[2] - corners[0]
        squares = ((one[i - 2] * two[i - 1] - one[i - 1] * two[i - 2]) ** 2 for i in range(3))
        return np.asarray(np.sqrt(sum(squares)) / 2)


def _may_be_narrow(areas: NDArray[np.float64], narrow: float, least: float) -> bool:
    """Tell whether _bulk_ends may find a narrow bulk on an axis: without its room, half as wide as is narrow.

    Such a bulk meets few of the bins. At least the share `least` must lie in so many beside each other.
    """
    most = math.ceil(_BINS * narrow / 2) + 1
    sums = np.append(0.0, np.cumsum(areas))
    return bool(0 < sums[-1] < np.inf and (sums[most:] - sums[:-most]).max() >= least * sums[-1])


def _bulk_ends(corners: NDArray[np.float64], share: float) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Return the ends of where the middles of a share of the surface are, with some room. None for no surface."""
    area = _areas(corners)
    if not 0 < area.sum() < np.inf:
        return None
    middles = corners.mean(axis=0)
    order = np.argsort(middles, axis=1, kind="stable")
    sums = np.cumsum(area[order], axis=1) / area.sum()
    tail = 1 - share
    first, last = (sums <= tail).sum(axis=1), np.minimum((sums < 1 - tail).sum(axis=1), len(area) - 1)
    axes = np.arange(3)
    low, high = middles[axes, order[axes, first]], middles[axes, order[axes, last]]
    room = (high - low).max() / 2  # quantiles leave ends out
    return low - room, high + room


def _strays(
    shown: list[SceneObject], groups: list[_Group], start: NDArray[np.float64], end: NDArray[np.float64]
) -> StrayParts | None:
    """Look at all triangles: those whose middles lie between `start` and `end`, and the others."""
    bulk, whole = _Box(), _Box()
    inside, outside = (np.zeros(len(shown), np.bool_) for _ in range(2))
    farthest, place = 0.0, start
    for one in groups:
        for numbers, corners in one.chunks():
            middles = corners.mean(axis=0)
            within = ((middles >= start[:, None]) & (middles <= end[:, None])).all(axis=0)
            owners = one.owners[numbers // len(one.triangles)]
            inside[owners[within]] = outside[owners[~within]] = True
            whole.add(corners)
            bulk.add(corners[..., within])
            points = np.moveaxis(corners[..., ~within], 1, 2).reshape(-1, 3)
            if len(points):
                away = np.maximum(start - points, points - end).max(axis=1)
                if away.max() > farthest:
                    farthest, place = float(away.max()), points[np.argmax(away)]
    width = float((whole.high - whole.low).max())
    share = bulk.area / whole.area if 0 < whole.area < np.inf else 0.0
    if share == 0 or not outside.any():
        return None
    names, alone = (tuple(shown[i].name for i in np.flatnonzero(which)) for which in (outside, outside & ~inside))
    return StrayParts(_triple(bulk.low), _triple(bulk.high), share, width, names, alone, _triple(place))


class _Box:
    """The bounds and the area of triangles."""

    def __init__(self) -> None:
        self.low, self.high, self.area = np.full(3, np.inf), np.full(3, -np.inf), 0.0

    def add(self, corners: NDArray[np.float64]) -> None:
        if corners.size:
            self.low = np.minimum(self.low, corners.min(axis=(0, 2)))
            self.high = np.maximum(self.high, corners.max(axis=(0, 2)))
            self.area += float(_areas(corners).sum())


def _triple(vector: NDArray[np.float64]) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), float(vector[2])
