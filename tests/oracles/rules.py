"""Rules by brute force, on whole arrays: which voxels of `touch` they fill, and with which materials.

Written from the manual's chapter on voxels. Knows nothing of bricks, blocks or bits.
"""

from __future__ import annotations

import itertools
from collections import defaultdict, deque
from fractions import Fraction

import numpy as np
from oracles.exposed import exposed_areas
from oracles.voxels import UNIT, shell, volume6, winding, winding_at

AROUND = [d for d in itertools.product((-1, 0, 1), repeat=3) if any(d)]
SIDES = [(-1, 0, 0), (1, 0, 0), (0, -1, 0), (0, 1, 0), (0, 0, -1), (0, 0, 1)]


def on_triangle(corners, side):
    """Voxels whose centre lies on a closed triangle: exact."""
    found = np.zeros((side,) * 3, bool)
    axis = np.arange(side, dtype=np.int64) * UNIT + UNIT // 2
    centres = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    if not normal.any():
        return found
    for place in np.argwhere(((centres - corners[0]) @ normal) == 0):
        point = [int(v) for v in centres[tuple(place)]]
        turns = []
        for a, b in itertools.pairwise([*corners.tolist(), corners[0].tolist()]):
            u, v = [q - p for p, q in zip(a, b, strict=True)], [q - p for p, q in zip(a, point, strict=True)]
            cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            turns.append(sum(int(n) * c for n, c in zip(normal, cross, strict=True)))
        found[tuple(place)] = all(turn >= 0 for turn in turns)
    return found


def centres_inside(vertices, triangles, side):
    """Voxels whose centre lies in the closed solid of a closed mesh."""
    held = np.zeros((side,) * 3, bool)
    for corners in vertices[triangles]:
        held |= on_triangle(corners, side)
    axis = np.arange(side, dtype=float) * UNIT + UNIT // 2
    centres = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)
    with np.errstate(invalid="ignore"):
        inside = np.abs(winding_at(centres, vertices, triangles)) > 0.5
    return held | (inside & ~held)


def padded(voxels):
    return np.pad(voxels, 3)


def shifted(voxels, step):
    """The voxels at `step` from each: what lies beyond the grid is empty."""
    out = np.zeros_like(voxels)
    to = tuple(slice(max(0, -d), n - max(0, d)) for d, n in zip(step, voxels.shape, strict=True))
    at = tuple(slice(max(0, d), n - max(0, -d)) for d, n in zip(step, voxels.shape, strict=True))
    out[to] = voxels[at]
    return out


def dilated(voxels):
    out = voxels.copy()
    for step in AROUND:
        out |= shifted(voxels, step)
    return out


def in_cubes(voxels):
    """Those in a cube of 2 x 2 x 2 voxels that all belong to the set."""
    corners = voxels.copy()
    for step in itertools.product((0, 1), repeat=3):
        corners &= shifted(voxels, step)
    out = np.zeros_like(voxels)
    for step in itertools.product((0, -1), repeat=3):
        out |= shifted(corners, step)
    return out


def pieces(cells, steps):
    """How many connected pieces a set of positions has, and which."""
    left, found = set(cells), []
    while left:
        queue = deque([left.pop()])
        piece = set(queue)
        while queue:
            at = queue.popleft()
            for step in steps:
                to = tuple(a + d for a, d in zip(at, step, strict=True))
                if to in left:
                    left.remove(to)
                    piece.add(to)
                    queue.append(to)
        found.append(piece)
    return found


def is_simple(cube):
    """Whether the middle of 3 x 3 x 3 voxels can go without changing a connection."""
    full = [tuple(p) for p in np.argwhere(cube) if tuple(p) != (1, 1, 1)]
    empty = [tuple(p) for p in np.argwhere(~cube) if sum(abs(v - 1) for v in p) in (1, 2)]
    at_side = [piece for piece in pieces(empty, SIDES) if any(sum(abs(v - 1) for v in p) == 1 for p in piece)]
    return len(pieces(full, AROUND)) == 1 and len(at_side) == 1


def keep_thin(touched, filled):
    """What is filled of `touched` when thin parts stay."""
    touched, filled = padded(touched), padded(filled)
    thin = touched & ~dilated(in_cubes(filled))
    candidates = dilated(thin) & touched & ~filled
    filled = filled | candidates
    places = sorted(map(tuple, np.argwhere(candidates) - 3), key=lambda p: (p[2] % 3, p[1] % 3, p[0] % 3))
    for place in places:
        x, y, z = (v + 3 for v in place)
        cube = tuple(slice(v - 1, v + 2) for v in (x, y, z))
        if not is_simple(filled[cube]):
            continue
        filled[x, y, z] = False
        for dx, dy, dz in [(0, 0, 0), *AROUND]:
            u, v, w = x + dx, y + dy, z + dz
            if touched[u, v, w] and not filled[u - 1 : u + 2, v - 1 : v + 2, w - 1 : w + 2].any():
                filled[x, y, z] = True
                break
    return filled[3:-3, 3:-3, 3:-3]


def ruled(meshes, side, *, thin="keep"):
    """Materials ([x, y, z]) by the rule `centre`, of closed meshes: (vertices, triangles, materials) each.

    Also says where two materials have areas so equal that rounding decides.
    """
    touched = np.zeros((side,) * 3, np.uint8)
    owner = np.full((side,) * 3, -1)
    filled, surface = np.zeros((side,) * 3, bool), np.zeros((side,) * 3, bool)
    several = np.zeros((side,) * 3, bool)  # may have surface of several materials
    own_surface = np.zeros((side,) * 3, bool)  # of the object that has the voxel
    for number, (vertices, triangles, materials) in enumerate(meshes):
        first = shell(vertices, triangles, side, inverted=volume6(vertices, triangles) < 0)
        inside = (np.abs(winding(vertices, triangles, side)) > 0.5) & (first < 0)
        mine = np.where(first >= 0, materials[np.maximum(first, 0)], np.where(inside, materials[0], 0))
        free = (touched == 0) & (mine != 0)
        touched[free], owner[free] = mine[free], number
        own_surface |= free & (first >= 0)
        several |= (first >= 0) & (surface | (len(set(materials.tolist())) > 1))
        surface |= first >= 0
        filled |= centres_inside(vertices, triangles, side) & (mine != 0)
    solid = touched != 0
    filled &= solid
    if thin == "keep":
        filled = keep_thin(solid, filled)
    lost = solid & ~filled
    orphan = np.zeros_like(lost)
    bare = np.zeros_like(lost)
    for step in SIDES:
        bare |= shifted(filled & ~surface, step)
    for number in range(len(meshes)):
        near = dilated(own_surface & (owner == number) & filled)
        orphan |= lost & (owner == number) & ~near & ~bare
    out = np.where(filled, touched, 0)
    visible, open_to_doubt = np.zeros_like(lost), np.zeros_like(lost)
    for step in SIDES:
        visible |= filled & ~shifted(filled, step)
    done = np.zeros_like(lost)
    for step in SIDES:
        takes = shifted(orphan, step) & filled & surface & ~done
        out[takes] = shifted(touched, step)[takes]
        done |= takes
    for voxel in map(tuple, np.argwhere(visible & ~done)):
        beside = [tuple(v + d for v, d in zip(voxel, step, strict=True)) for step in SIDES]
        of = [voxel] * bool(surface[voxel]) + [v for v in beside if all(0 <= c < side for c in v) and lost[v]]
        out[voxel] = first = touched[of[0]] if of else touched[voxel]
        if any(several[v] or touched[v] != first for v in of):
            out[voxel], open_to_doubt[voxel] = largest(meshes, of, side, first)
    return out, open_to_doubt


def largest(meshes, voxels, side, default):
    """The material with the largest exposed area in some voxels, and whether rounding decides it."""
    areas = defaultdict(Fraction)
    for voxel in voxels:
        for material, area in exposed_areas(meshes, voxel, side).items():
            areas[material] += area
    most = max(areas.values(), default=0)
    material = next((m for m, area in areas.items() if area == most), default)
    return material, sum(most - area < 2**-18 for area in areas.values()) > 1
