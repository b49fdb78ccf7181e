"""What voxrt_ray_setup makes of a direction, in whole numbers of any size; for its bench and the lane's."""

import random
from typing import NamedTuple

FACE_NONE = 3
OVERFLOW = 1 << 20


class Ray(NamedTuple):
    """A ray in the mirrored frame; one that is resolved meets nothing, and only that is told."""

    resolved: bool
    overflow: bool
    mirrored: int
    dead: int
    octant: int
    weight: tuple
    entry_time: int
    entry_face: int
    origin: tuple


def bits(flags):
    return sum(bool(flag) << axis for axis, flag in enumerate(flags))


def ray_of(position, direction, side, *, unit=16, inside=False):
    """Mirror, weigh and enter; `position` counts 1/unit voxel. A ray that starts `inside` has crossed no plane yet."""
    mirrored = [d < 0 for d in direction]
    dead = [d == 0 for d in direction]
    origin = [unit * side - p if mirror else p for p, mirror in zip(position, mirrored, strict=True)]
    size = [abs(d) or 1 for d in direction]
    weight = tuple(size[(a + 1) % 3] * size[(a + 2) % 3] for a in range(3))

    def key(plane, axis):
        return (unit * plane - origin[axis]) * weight[axis], axis

    live = [axis for axis in range(3) if not dead[axis]]
    entered = [] if inside else [key(0, axis) for axis in live if key(0, axis)[0] > 0]
    entry = max(entered, default=(0, FACE_NONE))
    missed = any(dead[a] and not 0 <= origin[a] < unit * side for a in range(3))
    missed |= any(key(side, axis) <= entry for axis in live)
    past = [origin[a] >= unit * side // 2 if dead[a] else key(side // 2, a) <= entry for a in range(3)]
    overflow = any(s >= OVERFLOW for s in size)
    resolved = missed or overflow
    return Ray(resolved, overflow, bits(mirrored), bits(dead), bits(past), weight, *entry, tuple(origin))


def some_direction():
    """Make a direction: small, of ties, of dead axes, large, or too large."""
    largest = random.choice([2, 5, 1000, OVERFLOW - 1])
    direction = [random.choice([0, 1, -1, largest, random.randint(-largest, largest)]) for _ in range(3)]
    if random.random() < 0.05:
        direction[random.randrange(3)] = random.choice([1, -1]) * random.choice([OVERFLOW, OVERFLOW + 1, (1 << 28) - 1])
    return direction


def edge_direction(position, side):
    """Make a direction from a position, 1/16 voxel, to an edge of the world: both planes are crossed at once."""
    aims = [0 if place < 0 else 16 * side for place in position]
    aims[random.randrange(3)] = random.randint(0, 16 * side)
    return [aim - place for aim, place in zip(aims, position, strict=True)]


def aimed_direction(position, side):
    """Make a direction from a position, 1/16 voxel, to a point in the world, or near its planes and edges."""
    near = random.randint(-1, 1)
    aims = [random.choice([near, 16 * side + near, random.randint(0, 16 * side)]) for _ in range(3)]
    return some_length(position, aims)


def tied_direction(position, side, *, apart=1):
    """Make a direction from a position through a point where two or three planes meet, as many voxels apart."""
    aims = [16 * apart * random.randint(0, side // apart) for _ in range(3)]
    if random.random() < 0.7:
        aims[random.randrange(3)] = random.randint(0, 16 * side)
    return some_length(position, aims)


def some_length(position, aims):
    """Make a direction from a position to another, of any length that is allowed."""
    way = [aim - place for aim, place in zip(aims, position, strict=True)]
    longest = max(map(abs, way)) or 1
    scale = random.choice([1, (OVERFLOW - 1) // longest, random.randint(1, (OVERFLOW - 1) // longest)])
    return [scale * step for step in way]
