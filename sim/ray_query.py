"""Many rays at once through an octree, exactly as the hardware traces them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import Octree
from voxrt.octree.camera import DIRECTION_LIMIT, POSITION_UNITS
from voxrt.sim import _model
from voxrt.sim.frame import FACE_NONE
from voxrt.voxelize.arguments import instance, real_array, whole, whole_array
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_CHUNK = 1 << 20  # rays at a time: 24 MB of registers
_MOST_EXACT = 1 << 53  # integers that float64 holds


class RayHits(Value, frozen=True, eq=False):
    """What N rays hit.

    Attributes
    ----------
    hit
        bool, shape (N,): whether the ray hits a solid voxel.
    material
        uint8, shape (N,): the material of that voxel, 0 for a miss.
    face
        uint8, shape (N,): axis of the face that the ray crosses into it (0 x, 1 y, 2 z). :data:`FACE_NONE` for a miss,
        or if the ray starts in a solid voxel.
    voxel
        int32, shape (N, 3): the voxel (x, y, z), grid frame; -1, -1, -1 for a miss.
    parameter
        float64, shape (N,): the hit is at origin + parameter * direction. It is the exact quotient of two integers,
        rounded once. 0 if the ray starts in a solid voxel, infinite for a miss.
    distance
        float64, shape (N,): voxels from the origin to the hit; infinite for a miss.
    """

    hit: NDArray[np.bool_]
    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    voxel: NDArray[np.int32]
    parameter: NDArray[np.float64]
    distance: NDArray[np.float64]


def cast_rays(octree: Octree, origins: ArrayLike, directions: ArrayLike, *, threads: int = 0) -> RayHits:
    """Find the first solid voxel on each of many rays. The interpreter lock is free meanwhile.

    Parameters
    ----------
    octree
        The memory.
    origins
        Numbers, shape (N, 3) or (3,) for all rays alike: voxels, grid frame, multiples of 1/16 below 2**27. They may
        lie outside the world.
    directions
        Numbers, shape (N, 3) or (3,): integers below 2**20, or such integers times a power of two, as
        (0.5, -1.0, 0.25). Any length; not zero.
    threads
        Threads to use; 0 takes one per core.

    Returns
    -------
    RayHits
        One row per ray.

    Raises
    ------
    TypeError, ValueError
        Arrays of another type or shape, a direction of zero, or numbers that the ray tracer cannot hold exactly:
        round them first, for example ``np.rint(1000 * directions)`` and ``np.rint(16 * origins) / 16``.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import from_points
    >>> tree = from_points([[5, 2, 2]], [7], depth=3)
    >>> hits = cast_rays(tree, [[0, 2.5, 2.5], [0, 6.5, 2.5]], [1, 0, 0])
    >>> hits.hit.tolist(), hits.voxel[0].tolist(), hits.material[0].item(), hits.distance[0].item()
    ([True, False], [5, 2, 2], 7, 5.0)
    """
    instance("octree", octree, Octree)
    threads = whole("threads", threads, 0, 1024)
    starts, ways = _triples("origins", origins), _triples("directions", directions)
    if len(starts) != len(ways) and 1 not in (len(starts), len(ways)):
        raise ValueError(f"{len(starts)} origins do not go with {len(ways)} directions")
    starts, ways = np.broadcast_arrays(starts, ways)
    count = len(starts)
    memory = _model.Memory(octree.words, octree.depth)
    material, face = np.zeros(count, np.uint8), np.full(count, FACE_NONE, np.uint8)
    voxel, parameter = np.full((count, 3), -1, np.int32), np.full(count, np.inf)
    distance = np.full(count, np.inf)
    for first in range(0, count, _CHUNK):
        some = slice(first, min(first + _CHUNK, count))
        places, (steps, doublings) = _places(starts[some], first), _steps(ways[some], first)
        traced = memory.trace(places, steps, threads)
        material[some], face[some], voxel[some] = traced.material, traced.face, traced.cell
        in_steps = _parameters(places, steps, material[some], face[some], voxel[some])
        parameter[some] = np.ldexp(in_steps, doublings)
        distance[some] = in_steps * np.linalg.norm(steps.astype(np.float64), axis=1)
    return RayHits(material != 0, material, face, voxel, parameter, distance)


def register_rays(origins: ArrayLike, directions: ArrayLike) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return the origins and directions of a few rays as the registers hold them, int32, shapes (N, 3).

    They are refused as :func:`cast_rays` says.
    """
    return _places(_triples("origins", origins), 0), _steps(_triples("directions", directions), 0)[0]


def _triples(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """Return finite numbers, float64, shape (N, 3)."""
    numbers = np.asarray(value)
    numbers = numbers[None] if numbers.ndim == 1 else numbers
    if numbers.dtype.kind in "iu":
        numbers = whole_array(name, numbers, ("N", 3), np.int64, low=-_MOST_EXACT, high=_MOST_EXACT).astype(np.float64)
    return real_array(name, numbers, ("N", 3)).astype(np.float64, copy=False)


def _places(origins: NDArray[np.float64], first: int) -> NDArray[np.int32]:
    """Return origins as the registers hold them, in 1/16 voxels; `first` is the number of the first ray."""
    scaled = origins * POSITION_UNITS
    wrong = ((np.rint(scaled) != scaled) | (np.abs(scaled) >= 1 << 31)).any(axis=1)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ValueError(
            f"origins[{first + row}] must be multiples of 1/16 voxel below 2**27, not {origins[row].tolist()}; round "
            "it: np.rint(16 * origins) / 16"
        )
    return scaled.astype(np.int32)


def _steps(directions: NDArray[np.float64], first: int) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return directions as integers below 2**20, and how often each was doubled to become whole (shape (N,))."""
    if not (moving := directions.any(axis=1)).all():
        raise ValueError(f"directions[{first + int(np.argmin(moving))}] must not be zero")
    # The largest component gets 20 bits. If another still has a fraction then, no power of two makes both whole.
    _, exponents = np.frexp(np.abs(directions).max(axis=1))
    whole_already = (np.rint(directions) == directions).all(axis=1) & (exponents <= 20)
    doublings = np.where(whole_already, 0, 20 - exponents).astype(np.int32)
    steps = np.ldexp(directions, doublings[:, None])
    wrong = (np.rint(steps) != steps).any(axis=1) | (np.abs(steps).max(axis=1) >= DIRECTION_LIMIT)
    if wrong.any():
        row = int(np.argmax(wrong))
        raise ValueError(
            f"directions[{first + row}] must be integers below 2**20, or such times a power of two, not "
            f"{directions[row].tolist()}; round it: np.rint(1000 * directions)"
        )
    return steps.astype(np.int32), doublings


def _parameters(
    places: NDArray[np.int32],
    steps: NDArray[np.int32],
    material: NDArray[np.uint8],
    face: NDArray[np.uint8],
    voxel: NDArray[np.int32],
) -> NDArray[np.float64]:
    """Return where rays cross into the voxels they hit, in steps from their origins."""
    found = np.where(material != 0, 0.0, np.inf)
    crossed = np.flatnonzero((material != 0) & (face != FACE_NONE))
    axis = face[crossed].astype(np.intp)
    along = steps[crossed, axis].astype(np.float64)
    # The plane crossed is the near one of the voxel. All numbers but the quotient are exact.
    plane = voxel[crossed, axis].astype(np.float64) + (along < 0)
    found[crossed] = (POSITION_UNITS * plane - places[crossed, axis]) / (POSITION_UNITS * along)
    return found
