"""The colour of a pixel as docs/shading.md defines it, in rational arithmetic on unit voxels.

Rays are reflected where they are, at a rational point; nothing is unfolded, scaled or mirrored.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import floor

from oracles.ray import FACE_NONE, first_cell


@dataclass
class Shader:
    """What shades: `mirrors` a set of materials, `light` three integers in 1/16 voxel or None.

    `faces` is None, where brightness depends on the angle, or the brightness of the faces along -x, +x, -y, +y, -z, +z
    in 1/255.
    """

    palette: object
    bounces: int = 0
    mirrors: frozenset = frozenset()
    flat: bool = False
    light: tuple | None = None
    ambient: int = 0
    faces: tuple | None = None


def shaded_pixel(voxels, shader, position, direction):
    """Give (colour, material, face) of the ray from `position` (1/16 voxel) along `direction`."""
    point = [Fraction(int(c), 16) for c in position]
    direction = [int(c) for c in direction]
    cell = [first_cell(o, d) for o, d in zip(point, direction, strict=True)]
    met = []
    while True:
        material, face, cell, t = walk(voxels, point, direction, cell)
        own = [int(c) for c in shader.palette[material]]
        if face == FACE_NONE:
            return tuple(own), material, face
        hit = [o + t * d for o, d in zip(point, direction, strict=True)]
        if shader.bounces == 0 or material not in shader.mirrors:
            part = brightness(voxels, shader, hit, direction, face)
            return tuple(floor(c * part + Fraction(1, 2)) for c in own), material, face
        met.append(own)
        if len(met) > shader.bounces:
            mean = tuple(floor(Fraction(sum(channel), len(met)) + Fraction(1, 2)) for channel in zip(*met, strict=True))
            return mean, material, face
        point = hit
        cell[face] -= 1 if direction[face] > 0 else -1
        direction[face] = -direction[face]


def walk(voxels, point, direction, cell):
    """Step from `cell` to the first solid one: (material, face, cell, parameter of the crossing into it)."""
    side = len(voxels)
    cell, t, face = list(cell), Fraction(0), FACE_NONE
    while True:
        if all(0 <= c < side for c in cell) and (material := int(voxels[tuple(cell)])):
            return material, face, cell, t
        ahead = []
        for axis, d in enumerate(direction):
            if (cell[axis] >= side and d >= 0) or (cell[axis] < 0 and d <= 0):
                return 0, FACE_NONE, cell, t
            if d:
                ahead.append(((cell[axis] + (d > 0) - point[axis]) / d, axis))
        if not ahead:
            return 0, FACE_NONE, cell, t
        t, face = min(ahead)
        cell[face] += 1 if direction[face] > 0 else -1


def brightness(voxels, shader, hit, direction, face):
    """Give the factor of the material's colour at a hit."""
    own = of_face(shader, direction, face)
    if shader.light is None:
        return square_of_cosine(direction, face) if own is None else own
    lit = [Fraction(2 * sub_cell(hit[axis] * 16, direction[axis], axis, face) + 1, 32) for axis in range(3)]
    lit[face] = hit[face]
    way = [Fraction(int(light), 16) - own for light, own in zip(shader.light, lit, strict=True)]
    ambient = Fraction(shader.ambient, 256)
    shadow = ambient if own is None else ambient * own
    if way[face] == 0 or (way[face] > 0) == (direction[face] > 0):
        return shadow
    cell = [first_cell(o, d) for o, d in zip(lit, way, strict=True)]
    material, _, _, t = walk(voxels, lit, way, cell)
    if material and t < 1:
        return shadow
    return max(ambient, square_of_cosine(way, face)) if own is None else own


def of_face(shader, direction, face):
    """Give the brightness of a face that a ray along `direction` enters; None where it depends on the angle."""
    if shader.flat:
        return Fraction(1)
    if shader.faces is None:
        return None
    normal = ("-x", "+x", "-y", "+y", "-z", "+z").index(("+" if direction[face] < 0 else "-") + "xyz"[face])
    return Fraction(int(shader.faces[normal]), 255)


def square_of_cosine(direction, face):
    return Fraction(direction[face] ** 2) / sum(c * c for c in direction)


def sub_cell(place, d, axis, face):
    """Give the 1/16 voxel of `axis` in which the ray at `place` (1/16 voxel) crosses a plane of `face`."""
    if place.denominator > 1 or d == 0:
        return floor(place)
    crossed = axis < face  # planes met at the same moment are crossed in the order of the axes
    return int(place) - (crossed if d < 0 else not crossed)
