"""Meshes of Blender as arrays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import Struct

from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.formats.blend.axes import turned_points

if TYPE_CHECKING:
    from numpy.typing import NDArray


class MeshArrays(Struct, frozen=True, eq=False):
    """The triangles of a mesh, those of one material slot after those of another, in the scene's axes."""

    positions: NDArray[np.float32]  # shape (V, 3)
    triangles: NDArray[np.int32]  # shape (T, 3): rows of `positions`
    corners: NDArray[np.int32]  # shape (T, 3): the mesh's corners, for what differs from face to face
    slots: NDArray[np.int32]  # shape (T,): material slots, ascending
    normals: CornerNormals

    def spans(self) -> list[tuple[int, int, int]]:
        """Return the slot of each run of triangles, its start, and the row after its end."""
        slots, starts = np.unique(self.slots, return_index=True)
        stops = [*starts[1:].tolist(), len(self.slots)]
        return list(zip(slots.tolist(), starts.tolist(), stops, strict=True))


def read_triangles(mesh: Any) -> MeshArrays:
    """Read the triangles of a mesh, as Blender itself cuts its polygons."""
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    triangles = _read(mesh.loop_triangles, "vertices", count * 3, np.int32).reshape(-1, 3)
    corners = _read(mesh.loop_triangles, "loops", count * 3, np.int32).reshape(-1, 3)
    slots = _read(mesh.loop_triangles, "material_index", count, np.int32)
    if (count and slots[0] != slots[-1]) or (slots[1:] < slots[:-1]).any():
        order = np.argsort(slots, kind="stable")
        triangles, corners, slots = triangles[order], corners[order], slots[order]
    positions = turned_points(_read(mesh.vertices, "co", len(mesh.vertices) * 3, np.float32).reshape(-1, 3))
    directions = _read(mesh.corner_normals, "vector", len(mesh.corner_normals) * 3, np.float32).reshape(-1, 3)
    return MeshArrays(positions, triangles, corners, slots, CornerNormals(turned_points(directions), corners))


def coordinates(mesh: Any, name: str) -> NDArray[np.float64] | None:
    """Return the texture coordinates of a mesh's corners, v upwards: shape (L, 2); None where it has no such map.

    Without a name they are those of the map that is active for renders.
    """
    layers = mesh.uv_layers
    layer = layers.get(name) if name else next((one for one in layers if one.active_render), None)
    if layer is None:
        return None
    return _read(layer.uv, "vector", len(layer.uv) * 2, np.float32).reshape(-1, 2).astype(np.float64)


def colours(mesh: Any, name: str, arrays: MeshArrays) -> NDArray[np.float32] | None:
    """Return the linear colours of the corners of a mesh's triangles: shape (T, 3, 4); None where it has no such ones.

    Without a name they are those of the attribute that is active for renders.
    """
    layers = mesh.color_attributes
    index = layers.render_color_index
    layer = layers.get(name) if name else layers[index] if 0 <= index < len(layers) else None
    if layer is None or layer.domain not in ("POINT", "CORNER"):
        return None
    values = _read(layer.data, "color", len(layer.data) * 4, np.float32).reshape(-1, 4)
    found: NDArray[np.float32] = values[arrays.triangles if layer.domain == "POINT" else arrays.corners]
    return np.clip(np.nan_to_num(found), 0, 1)


def _read(items: Any, name: str, count: int, kind: Any) -> NDArray[Any]:
    values = np.empty(count, kind)
    if count:
        items.foreach_get(name, values)
    return values
