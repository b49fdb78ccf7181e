"""The mesh of a COLLADA geometry, with the materials that a node binds to the symbols of its primitives."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from voxrt.voxelize.arguments import real_array
from voxrt.voxelize.colour.appearance import SurfaceAppearance
from voxrt.voxelize.formats.colour_range import clamped
from voxrt.voxelize.formats.dae.materials import COLOURED
from voxrt.voxelize.formats.mesh_materials import LoadedMesh
from voxrt.voxelize.formats.triangulation import triangulate_corners

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from voxrt.voxelize.colour.appearance import Appearance
    from voxrt.voxelize.formats.dae.materials import Materials
    from voxrt.voxelize.formats.material_table import MaterialTable

Bound: TypeAlias = "tuple[Any, str | None]"
"""A material of pycollada, and the set of texture coordinates that its texture takes."""


def read_geometry(
    geometry: Any,  # noqa: ANN401 - pycollada has no types
    bound: Mapping[str, Bound],
    materials: Materials,
    table: MaterialTable,
) -> LoadedMesh:
    """Return the mesh of a geometry. `bound`: by the symbols of its primitives.

    ValueError or IndexError where it names what is not there.
    """
    positions: list[NDArray[np.float64]] = []
    triangles: list[NDArray[np.int64]] = []
    entries: list[Appearance] = []
    rows: list[NDArray[np.int32]] = []
    uv: list[NDArray[np.float64]] = []
    colours: list[NDArray[np.float64]] = []
    start = 0
    for primitive in geometry.primitives:
        counts, corners = _polygons(primitive)
        if counts is None:
            materials.log.add("no-triangles", "points and lines were left out")
            continue
        if not len(corners):
            continue
        here = _positions(primitive)
        vertices = corners[:, primitive.sources["VERTEX"][0][0]]
        if not 0 <= vertices.min() <= vertices.max() < len(here):
            raise IndexError(f"vertex {vertices.max()} of {len(here)}")
        cut, _ = triangulate_corners(here, counts, vertices)
        positions.append(here)
        triangles.append(vertices[cut] + start)
        start += len(here)
        material, channel = bound.get(primitive.material or "", (None, None))
        appearance = None if material is None else materials.appearance(material)
        own = _attribute(primitive, ("COLOR", None), corners, cut, 3)
        if own is not None:
            linear = materials.linear(clamped(own, materials.log))
            own = np.concatenate([linear, own[:, :, 3:4] if own.shape[2] > 3 else np.ones((*linear.shape[:2], 1))], 2)
        is_plain = appearance is None and own is None
        if not is_plain:
            entries.append(appearance or COLOURED)
        rows.append(np.full(len(cut), -1 if is_plain else len(entries) - 1, np.int32))
        coordinates = _attribute(primitive, ("TEXCOORD", channel), corners, cut, 2)
        uv.append(np.zeros((len(cut), 3, 2)) if coordinates is None else coordinates[:, :, :2] * (1, -1) + (0, 1))
        colours.append(np.ones((len(cut), 3, 4)) if own is None else own)
    if not rows:
        return LoadedMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int32), np.zeros(0, np.uint8))
    all_rows = np.concatenate(rows)
    bare = all_rows < 0
    ids = np.zeros(len(all_rows), np.uint8)
    if bare.any():
        ids[bare] = table.default(materials.log if bound else None, int(bare.sum()))
    surface = None
    if entries:
        surface = SurfaceAppearance(tuple(entries), all_rows, np.concatenate(uv), np.concatenate(colours))
    return LoadedMesh(np.concatenate(positions), np.concatenate(triangles).astype(np.int32), ids, surface)


def _positions(primitive: Any) -> NDArray[np.float64]:  # noqa: ANN401
    source = primitive.sources["VERTEX"][0][4]
    if "nan" in (source.xmlnode.findtext("{*}float_array") or "").lower():  # pycollada reads it as 0
        raise ValueError("a coordinate is not a number")
    return real_array("positions", source.data, ("V", 3)).astype(np.float64)


def _polygons(primitive: Any) -> tuple[NDArray[np.int64] | None, NDArray[np.int64]]:  # noqa: ANN401
    """Return the corners per polygon and the rows of indices of each corner; None for what has no area."""
    rows = np.asarray(primitive.index, np.int64).reshape(-1, primitive.nindices)
    if isinstance(primitive, import_module("collada.triangleset").TriangleSet):
        return np.full(len(rows) // 3, 3, np.int64), rows
    if not isinstance(primitive, import_module("collada.polylist").Polylist):
        return None, rows
    counts = np.asarray(primitive.vcounts, np.int64)
    if (counts < 0).any() or counts.sum() != len(rows):
        raise ValueError(f"polygons of {counts.sum()} corners have {len(rows)}")
    whole = counts >= 3
    return counts[whole], rows[np.repeat(whole, counts)]


def _attribute(
    primitive: Any,  # noqa: ANN401
    kind: tuple[str, str | None],
    corners: NDArray[np.int64],
    cut: NDArray[np.int64],
    least: int,
) -> NDArray[np.float64] | None:
    """Return an attribute of the corners of triangles, float64, shape (T, 3, C); None where there is none.

    `kind`: its name, and the set of several; None, or one that is not there, for the first. `least`: of C.
    """
    semantic, channel = kind
    inputs = primitive.sources.get(semantic) or []
    if not inputs:
        return None
    offset, _, _, _, source = next((one for one in inputs if channel is not None and one[3] == channel), inputs[0])
    values = np.asarray(source.data, np.float64)
    rows = corners[:, offset][cut]
    if values.ndim != 2 or values.shape[1] < least or not 0 <= rows.min() <= rows.max() < len(values):
        raise IndexError(f"{semantic} {rows.max()} of {len(values)}")
    return values[rows]
