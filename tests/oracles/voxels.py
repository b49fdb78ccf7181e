"""Voxelization by brute force: every triangle against every voxel, exactly, and winding numbers by solid angles.

Knows nothing of columns, tiles or bricks. Vertices are snapped to 1/4096 voxel in exact rationals; overlap with a
voxel's open interior is thirteen separating axes in int64, which is exact for grids up to 32 voxels per side.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

UNIT = 4096


def snap(positions, transform, origin, voxel_size):
    """Vertices in grid space, 1/4096 voxel, rounded half to even from the exact value."""
    matrix = [[Fraction(float(v)) for v in row] for row in np.asarray(transform, float)]
    shift = [Fraction(float(v)) for v in origin]
    size = Fraction(float(voxel_size))
    out = []
    for point in np.asarray(positions, float):
        p = [Fraction(float(v)) for v in point]
        world = [sum(m * v for m, v in zip(row[:3], p, strict=True)) + row[3] for row in matrix[:3]]
        out.append([round((w - o) / size * UNIT) for w, o in zip(world, shift, strict=True)])
    return np.array(out, dtype=np.int64).reshape(-1, 3)


def _cells(side):
    axis = np.arange(side, dtype=np.int64)
    return np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)


def triangle_cover(corners, side):
    """Voxels (bool, [x, y, z]) whose open interior the closed triangle meets."""
    low = _cells(side) * UNIT
    edges = np.roll(corners, -1, axis=0) - corners
    axes = [np.eye(3, dtype=np.int64)[i] for i in range(3)]
    tests = [*axes, np.cross(edges[0], edges[1]), *(np.cross(e, a) for e in edges for a in axes)]
    covered = np.ones((side,) * 3, bool)
    for n in tests:
        if not n.any():
            continue
        reach = corners @ n
        base = low @ n
        bottom = base + UNIT * np.minimum(n, 0).sum()
        top = base + UNIT * np.maximum(n, 0).sum()
        covered &= (reach.max() > bottom) & (reach.min() < top)
    return covered


def flat_cover(corners, side, *, inverted=False):
    """Voxels behind a triangle that lies in a plane between voxels (against its normal), clamped into the grid."""
    covered = np.zeros((side,) * 3, bool)
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    for axis in range(3):
        plane = corners[0, axis]
        if (corners[:, axis] != plane).any() or plane % UNIT or not normal[axis]:
            continue
        layer = plane // UNIT
        if not 0 <= layer <= side:
            continue
        if (normal[axis] > 0) != inverted:
            layer -= 1
        layer = min(max(layer, 0), side - 1)
        # Thickened across the plane, the flat triangle meets the cells that it meets in the plane.
        nudged = corners.copy()
        nudged[:, axis] = layer * UNIT + UNIT // 2
        covered |= triangle_cover(nudged, side)
    return covered


def winding(vertices, triangles, side):
    """Generalized winding number at voxel centres, beside them by a little so that no surface is hit: float64."""
    return winding_at(
        (_cells(side) * UNIT + UNIT // 2).astype(float) + np.array([0.31, 0.17, 0.23]), vertices, triangles
    )


def winding_at(at, vertices, triangles):
    """Generalized winding number, summed triangle by triangle: float64, shape of `at` (..., 3) but for its last."""
    total = np.zeros(at.shape[:-1])
    for a, b, c in vertices[triangles].astype(float):
        u, v, w = a - at, b - at, c - at
        lu, lv, lw = (np.linalg.norm(x, axis=-1) for x in (u, v, w))
        over = np.einsum("...i,...i", u, np.cross(v, w))
        under = (
            lu * lv * lw
            + np.einsum("...i,...i", u, v) * lw
            + np.einsum("...i,...i", v, w) * lu
            + np.einsum("...i,...i", w, u) * lv
        )
        total += 2 * np.arctan2(over, under)
    return total / (4 * np.pi)


def volume6(vertices, triangles):
    """Six times the signed volume, exact."""
    return sum(_det(corners) for corners in vertices[triangles].tolist())


def _det(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def shell(vertices, triangles, side, *, inverted=False):
    """For each voxel ([x, y, z]) the first triangle that covers it, or -1."""
    first = np.full((side,) * 3, -1)
    for index, corners in enumerate(vertices[triangles]):
        covered = triangle_cover(corners, side) | flat_cover(corners, side, inverted=inverted)
        first[covered & (first < 0)] = index
    return first


def voxelize_mesh(vertices, triangles, materials, side, *, solid, closed):
    """Materials ([x, y, z], uint8, 0 empty) of one object."""
    inverted = solid and closed and volume6(vertices, triangles) < 0
    first = shell(vertices, triangles, side, inverted=inverted)
    out = np.where(first >= 0, materials[np.maximum(first, 0)], 0).astype(np.uint8)
    if solid:
        inside = np.abs(winding(vertices, triangles, side)) > 0.5
        out[(out == 0) & inside] = materials[0]
    return out


def compete(layers):
    """The first layer keeps a voxel."""
    out = np.zeros_like(layers[0])
    for layer in layers:
        out = np.where(out == 0, layer, out)
    return out


def _demorton(codes):
    codes = np.asarray(codes, dtype=np.uint64)
    xyz = np.zeros((len(codes), 3), dtype=np.int64)
    for bit in range(20):
        for axis in range(3):
            xyz[:, axis] |= ((codes >> np.uint64(3 * bit + axis)) & np.uint64(1)).astype(np.int64) << bit
    return xyz


def voxel_colours(voxels, materials):
    """The sRGB colour of every voxel, [x, y, z, channel], -1 where it is empty."""
    table = np.array([material.colour for material in materials], int)
    table[0] = -1
    return table[dense(voxels)]


def dense(voxels):
    """Voxels as an array of materials, [x, y, z]; checks what the class promises."""
    side = 1 << voxels.depth
    full = max(side, 8)
    out = np.zeros((full,) * 3, np.uint8)
    codes = voxels.brick_codes
    assert (np.diff(codes.astype(object)) > 0).all()
    place = _demorton(np.arange(512))
    for code, mask, material, row in zip(
        codes, voxels.brick_masks, voxels.brick_materials, voxels.brick_rows, strict=True
    ):
        bits = (mask[np.arange(512) // 64] >> (np.arange(512) % 64).astype(np.uint64)) & np.uint64(1)
        assert bits.any()
        assert (material == 0) == (row >= 0)
        cells = np.where(bits, material, 0) if row < 0 else voxels.cells[row]
        assert ((cells != 0) == (bits != 0)).all()
        if row >= 0:
            assert len(np.unique(cells[cells != 0])) > 1
        assert not (row < 0 and bits.all() and voxels.depth >= 3)
        at = _demorton([code])[0] * 8 + place
        assert not out[at[:, 0], at[:, 1], at[:, 2]].any()
        out[at[:, 0], at[:, 1], at[:, 2]] = cells
    corners = []
    for code, level, material in zip(voxels.octant_codes, voxels.octant_levels, voxels.octant_materials, strict=True):
        assert 3 <= level <= voxels.depth
        assert material
        size = 1 << int(level)
        x, y, z = _demorton([code])[0] * size
        block = out[x : x + size, y : y + size, z : z + size]
        assert block.shape == (size,) * 3
        assert not block.any()
        block[:] = material
        corners.append(int(code) << (3 * int(level)))
    assert corners == sorted(corners)
    assert not out[side:].any()
    assert not out[:, side:].any()
    assert not out[:, :, side:].any()
    return out[:side, :side, :side]
