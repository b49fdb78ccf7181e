"""Objects that are parts of one surface, such as a box and its lid, joined to one object."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.voxelize.colour.appearance import SurfaceAppearance
from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.mesh import Mesh
from voxrt.voxelize.scene import SceneObject

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from voxrt.voxelize.scene import Scene

_MOST_NAMES = 3


def join_open_objects(scene: Scene) -> Scene:
    """Return a scene in which one object has the triangles of all objects whose surface does not close alone.

    CAD programs write the faces of one solid as several objects, by material or by part. The joined object stands where
    the first of them stood. Objects that close, that have colliders or a fill of their own, or that are hidden, stay as
    they are.

    Examples
    --------
    >>> from voxrt.voxelize import authoring
    >>> yard = authoring.Author("yard")
    >>> _ = yard.material("stone", "#9a9aa0")
    >>> block = authoring.box((4, 4, 4))
    >>> yard.add("block", block, material="stone")
    >>> [one.name for one in join_open_objects(yard.build()).objects]
    ['block']
    """
    chosen = [
        i for i, one in enumerate(scene.objects) if not (one.hidden or one.colliders or one.fill) and is_open(one.mesh)
    ]
    if len(chosen) < 2:
        return scene
    parts = [scene.objects[i] for i in chosen]
    names = [one.name for one in parts]
    name = " + ".join(names[:_MOST_NAMES]) + (f" + {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else "")
    rules = {one.rule for one in parts}
    joined = SceneObject(name, _joined([_placed(one) for one in parts]), rule=rules.pop() if len(rules) == 1 else None)
    left = set(chosen[1:])
    objects = (joined if i == chosen[0] else one for i, one in enumerate(scene.objects) if i not in left)
    return replace(scene, objects=tuple(objects))


def is_open(mesh: Mesh) -> bool:
    """Return whether some edge of a mesh has more faces on one side than on the other."""
    if len(mesh.triangles) == 0:
        return False
    _, welded = np.unique(mesh.positions + 0.0, axis=0, return_inverse=True)
    corners = welded.reshape(-1)[mesh.triangles]
    from_, to = corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)
    kept = from_ != to
    low, high = np.minimum(from_, to)[kept], np.maximum(from_, to)[kept]
    _, edges = np.unique(low.astype(np.int64) << 32 | high, return_inverse=True)
    return bool(np.bincount(edges.reshape(-1), np.where((from_ < to)[kept], 1.0, -1.0)).any())


def _placed(item: SceneObject) -> Mesh:
    """Return an object's mesh in the scene frame, counter-clockwise seen from outside as before."""
    mesh, linear = item.mesh, item.transform[:3, :3]
    if (item.transform == np.eye(4)).all():
        return mesh
    normals = mesh.normals
    if normals is not None:
        cofactors = np.column_stack([np.cross(linear[:, 1], linear[:, 2]), np.cross(linear[:, 2], linear[:, 0]),
                                     np.cross(linear[:, 0], linear[:, 1])])  # fmt: skip
        normals = CornerNormals(normals.vectors @ cofactors.T, normals.rows)
    placed = replace(mesh, positions=mesh.positions @ linear.T + item.transform[:3, 3], normals=normals)
    return _mirrored(placed) if np.linalg.det(linear) < 0 else placed


def _mirrored(mesh: Mesh) -> Mesh:
    """Return the same triangles, wound the other way."""
    turned, appearance, normals = [0, 2, 1], mesh.appearance, mesh.normals
    if appearance is not None:
        appearance = replace(appearance, uv=appearance.uv[:, turned], colours=appearance.colours[:, turned])
    if normals is not None:
        normals = CornerNormals(-normals.vectors, normals.rows[:, turned])
    return replace(mesh, triangles=mesh.triangles[:, turned], appearance=appearance, normals=normals)


def _joined(meshes: Sequence[Mesh]) -> Mesh:
    """Return one mesh with the triangles of all, which are in one frame."""
    return Mesh(
        np.concatenate([one.positions.astype(np.float64) for one in meshes]),
        _stacked([one.triangles for one in meshes], [len(one.positions) for one in meshes]),
        np.concatenate([one.materials for one in meshes]),
        appearance=_joined_appearance(meshes),
        normals=_joined_normals(meshes),
    )


def _stacked(rows: Sequence[NDArray[np.int32]], counts: Sequence[int]) -> NDArray[np.int32]:
    """Return index arrays one below the other, each shifted by the counts before it; -1 stays."""
    starts = np.cumsum([0, *counts[:-1]])
    return np.concatenate([np.where(one < 0, one, one + start) for one, start in zip(rows, starts, strict=True)])


def _joined_appearance(meshes: Sequence[Mesh]) -> SurfaceAppearance | None:
    if all(one.appearance is None for one in meshes):
        return None
    each = [
        one.appearance or SurfaceAppearance((), np.full(n, -1), np.zeros((n, 3, 2)), np.ones((n, 3, 4)))
        for one in meshes
        for n in (len(one.triangles),)
    ]
    return SurfaceAppearance(
        tuple(entry for one in each for entry in one.entries),
        _stacked([one.rows for one in each], [len(one.entries) for one in each]),
        np.concatenate([one.uv for one in each]),
        np.concatenate([one.colours for one in each]),
    )


def _joined_normals(meshes: Sequence[Mesh]) -> CornerNormals | None:
    if all(one.normals is None for one in meshes):
        return None
    each = [one.normals or CornerNormals(np.empty((0, 3)), np.full_like(one.triangles, -1)) for one in meshes]
    return CornerNormals(
        np.concatenate([one.vectors for one in each]),
        _stacked([one.rows for one in each], [len(one.vectors) for one in each]),
    )
