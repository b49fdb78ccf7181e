"""The voxel that a pointer means, in a world that is edited."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import World
from voxrt.octree.camera import DIRECTION_LIMIT, POSITION_UNITS
from voxrt.octree.query import Corner  # noqa: TC001 - the manual resolves the annotations of this module
from voxrt.sim import _model
from voxrt.sim.frame import FACE_NONE
from voxrt.sim.ray_query import register_rays
from voxrt.voxelize.arguments import instance, vector
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


class Picked(Value, frozen=True):
    """A voxel and its face, as :func:`pick` returns them.

    Attributes
    ----------
    voxel
        The first solid voxel on the ray (x, y, z): what a tool digs.
    beside
        The voxel at the face that the ray crosses, where a tool builds; it may lie outside of the world. None if the
        ray starts in a solid voxel.
    material
        Material id of the voxel, 1 … 255.
    """

    voxel: Corner
    beside: Corner | None
    material: int


def pick(world: World, origin: ArrayLike, direction: ArrayLike) -> Picked | None:
    """Find the first solid voxel on a ray through a world, exactly as the hardware does. None if there is none.

    Unlike :func:`cast_rays`, it copies no words, so that it is fast after every edit.

    Parameters
    ----------
    world
        The world.
    origin
        Numbers, shape (3,): voxels, grid frame, multiples of 1/16 below 2**27.
    direction
        Numbers, shape (3,): integers below 2**20, or such integers times a power of two; not zero.

    Raises
    ------
    TypeError, ValueError
        A value of another type or shape, or numbers that the ray tracer cannot hold exactly: see :func:`cast_rays`.

    Examples
    --------
    >>> from voxrt.octree import Rom, World, from_points
    >>> from voxrt.voxelize import EMPTY, Material
    >>> tree = from_points([[5, 2, 2]], [1], depth=3)
    >>> world = World(Rom("dot", tree, (EMPTY, Material("oak", (160, 110, 60)))))
    >>> pick(world, [0, 2.5, 2.5], [1, 0, 0])
    Picked(voxel=(5, 2, 2), beside=(4, 2, 2), material=1)
    """
    native = instance("world", world, World).native
    place, step = _registers(origin, direction)
    material, axis, cell = _model.pick(native, place, step)
    if material == 0:
        return None
    if axis == FACE_NONE:
        return Picked(cell, None, material)
    beside = list(cell)
    beside[axis] -= 1 if step[axis] > 0 else -1
    return Picked(cell, (beside[0], beside[1], beside[2]), material)


def _registers(origin: ArrayLike, direction: ArrayLike) -> tuple[list[int], list[int]]:
    """Return a ray as the registers hold it. One that they hold as it stands needs no arrays, which take longer."""
    place, step = _whole(origin, POSITION_UNITS, 1 << 31), _whole(direction, 1, DIRECTION_LIMIT)
    if place is not None and step is not None and any(step):
        return place, step
    (places,), (steps,) = register_rays(vector("origin", origin), vector("direction", direction))
    return places.tolist(), steps.tolist()


def _whole(value: object, scale: int, limit: int) -> list[int] | None:
    """Return three numbers times `scale`, if they are whole and below `limit`; None for whatever else."""
    if type(value) is np.ndarray:
        value = value.tolist()
    if not isinstance(value, list | tuple) or len(value) != 3:
        return None
    found = []
    for one in value:
        if type(one) is not float and type(one) is not int:
            return None
        scaled = scale * one
        if not -limit < scaled < limit or scaled != (whole := int(scaled)):
            return None
        found.append(whole)
    return found
