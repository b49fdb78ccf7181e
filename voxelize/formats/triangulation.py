"""Triangulation of polygons: a fan where a polygon is convex, ear clipping (manifold3d) where it is not."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.errors import DoesNotFitError

if TYPE_CHECKING:
    from numpy.typing import NDArray

_FREE_CORNERS = 1000
_MOST_WORK = 4_000_000_000
"""Cutting concave polygons takes time by the squares of their corners: those of all that have more than the free
corners, together. One polygon of 63,000 corners takes some ten seconds."""


def triangulate(
    positions: NDArray[np.float64], counts: NDArray[np.integer], corners: NDArray[np.integer]
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Cut polygons into triangles with the polygons' own corners and orientation.

    A concave quadrilateral is cut at its reflex corner; a concave polygon of more corners is cut in its plane (the
    Newell normal's dominant axis dropped, so coordinates stay exact). Polygons should be planar; one without area is
    cut as a fan. DoesNotFitError where concave polygons have so many corners that it would take long. `counts` are the
    corners per polygon, each at least 3, and `corners` rows of `positions` (float64, shape (V, 3), finite where used),
    polygon after polygon. Return the triangles (int32, shape (T, 3), rows of `positions`) and the polygon of each
    (int64, shape (T,)).
    """
    triangles, faces = triangulate_corners(positions, counts, corners)
    return np.asarray(corners)[triangles].astype(np.int32, copy=False), faces


def triangulate_corners(
    positions: NDArray[np.float64], counts: NDArray[np.integer], corners: NDArray[np.integer]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """As :func:`triangulate`, but the triangles index `corners` (int64, shape (T, 3)), for looking up attributes."""
    if not len(counts) or (counts[0] == 3 and (counts == 3).all()):
        return np.arange(3 * len(counts), dtype=np.int64).reshape(-1, 3), np.arange(len(counts), dtype=np.int64)
    starts = np.cumsum(counts) - counts
    per_face = counts - 2
    first_triangle = np.cumsum(per_face) - per_face
    faces = np.repeat(np.arange(len(counts)), per_face)
    step = np.arange(len(faces)) - first_triangle[faces]
    anchor, reflex = _fan_anchors(positions, counts, starts, corners)
    wrapped = (anchor[faces, None] + np.stack([np.zeros_like(step), step + 1, step + 2], axis=1)) % counts[faces, None]
    triangles = starts[faces, None] + wrapped
    sizes = np.array([counts[face] for face, _ in reflex], np.float64)
    if (sizes[sizes > _FREE_CORNERS] ** 2).sum() > _MOST_WORK:
        raise DoesNotFitError(
            f"its concave polygons have too many corners to cut them into triangles (one has {int(sizes.max()):,}); "
            "export it as triangles"
        )
    for face, normal in reflex:
        begin, count = starts[face], counts[face]
        cut = _cut_in_plane(positions[corners[begin : begin + count]], normal)
        if len(cut) == count - 2:
            triangles[first_triangle[face] : first_triangle[face] + count - 2] = begin + cut
    return triangles, faces


def _fan_anchors(
    positions: NDArray[np.float64], counts: NDArray[np.integer], starts: NDArray[np.int64], corners: NDArray[np.integer]
) -> tuple[NDArray[np.int64], list[tuple[int, NDArray[np.float64]]]]:
    """Return where each polygon's fan starts, and the concave polygons that no fan cuts, with their normals."""
    anchor = np.zeros(len(counts), dtype=np.int64)
    chosen = np.flatnonzero(counts > 3)
    sizes = counts[chosen]
    local = np.cumsum(sizes) - sizes
    owner = np.repeat(np.arange(len(chosen)), sizes)
    place = np.arange(int(sizes.sum())) - local[owner]
    at = starts[chosen][owner]
    points = positions[corners[at + place]]
    points = points - points[local][owner]  # near the origin, so that cross products keep their digits
    after = points[local[owner] + (place + 1) % sizes[owner]]
    before = points[local[owner] + (place - 1) % sizes[owner]]
    normals = np.add.reduceat(np.cross(points, after), local, axis=0)
    turn = np.einsum("ij,ij->i", np.cross(points - before, after - points), normals[owner])
    # A corner that turns back by less than this is straight: float32 files round polygons by this much.
    tolerance = 1e-9 * np.einsum("ij,ij->i", normals, normals)
    turns_back = turn < -tolerance[owner]
    concave = np.maximum.reduceat(turns_back, local)
    odd = turns_back[local + 1] | turns_back[local + 3]
    anchor[chosen] = (sizes == 4) & concave & odd
    reflex = [(int(chosen[index]), normals[index]) for index in np.flatnonzero(concave & (sizes > 4))]
    return anchor, reflex


def _cut_in_plane(points: NDArray[np.float64], normal: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the triangles of one concave polygon, int64, shape (T, 3), over `points` (float64, shape (N, 3))."""
    import manifold3d  # noqa: PLC0415 -- only concave polygons need it

    axis = int(np.argmax(np.abs(normal)))
    flat = points[:, [(axis + 1) % 3, (axis + 2) % 3]]
    if normal[axis] < 0:
        flat = flat[:, ::-1]
    flat = flat - flat.mean(axis=0)
    return np.asarray(manifold3d.triangulate([np.ascontiguousarray(flat)]), dtype=np.int64).reshape(-1, 3)
