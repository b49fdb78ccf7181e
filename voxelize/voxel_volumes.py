"""How much of each voxel an object fills."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import _native, arguments
from voxrt.voxelize.scene_parts import SceneParts, unreachable
from voxrt.voxelize.value import Value
from voxrt.voxelize.voxelizer import MOST_THREADS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.box_rounding import Pow2
    from voxrt.voxelize.grid import Grid
    from voxrt.voxelize.object_proxies import Geometry
    from voxrt.voxelize.scene import Scene


class VolumeFractions(Value, frozen=True, eq=False):
    """How much of each voxel an object fills, whatever other objects there are.

    A voxel is listed where the surface of an object passes it. All others are filled whole, or not at all.

    Attributes
    ----------
    names
        Of the objects, O of them.
    grid
        The grid.
    objects
        uint32, shape (N,), ascending: numbers of objects.
    voxels
        int32, shape (N, 3): the voxels, x, y, z in the grid; tile by tile per object.
    fractions
        float64, shape (N,), 0 to 1, within 2**-40 of the true value.
    whole
        int64, shape (O,): how many voxels without surface an object fills.
    without
        Names of objects without volumes: those with open surfaces, balls or ellipsoids.

    Examples
    --------
    >>> from voxrt.voxelize import Grid, load, volume_fractions
    >>> volume_fractions(load("examples/house.obj"), Grid(3, (-8, 0, -8), 2.0))
    VolumeFractions(objects=5, voxels=102)
    """

    names: tuple[str, ...]
    grid: Grid
    objects: NDArray[np.uint32]
    voxels: NDArray[np.int32]
    fractions: NDArray[np.float64]
    whole: NDArray[np.int64]
    without: tuple[str, ...]

    @property
    def volumes(self) -> NDArray[np.float64]:
        """The volume of each object within the grid, in voxels: float64, shape (O,); NaN for those without."""
        found = self.whole.astype(np.float64)
        np.add.at(found, self.objects, self.fractions)
        found[[self.names.index(name) for name in self.without]] = np.nan
        return found

    def __repr__(self) -> str:
        return f"VolumeFractions(objects={len(self.names)}, voxels={len(self.voxels)})"


def volume_fractions(
    scene: Scene, grid: Grid, *, geometry: Geometry = "auto", pow2: Pow2 = "box", threads: int = 0
) -> VolumeFractions:
    """Find how much of each voxel the objects of a scene fill.

    Triangles are cut by the planes between voxels, and one sweep per column adds up what lies above them. Where the
    surface of an object cuts itself, a point counts as often as its winding number says, and a voxel once at most.

    Parameters
    ----------
    scene, grid, geometry, pow2, threads
        As :func:`voxelize` takes them.

    Returns
    -------
    VolumeFractions
        A fraction per object and voxel with surface of the object.

    Raises
    ------
    TypeError, ValueError, AssetError, DoesNotFitError
        As :func:`voxelize` does.

    Examples
    --------
    >>> from voxrt.voxelize import Grid, authoring, volume_fractions
    >>> yard = authoring.Author("yard")
    >>> yard.add("block", authoring.box((3, 3, 2.5), centre=(3, 3, 3)))
    >>> found = volume_fractions(yard.build(), Grid(3, (0, 0, 0), 1.0))
    >>> found.volumes.tolist(), found.fractions.min().item()
    ([22.5], 0.0625)
    """
    parts = SceneParts(scene, grid, fill="solid", rule="half", thin="drop", geometry=geometry, pow2=pow2)
    threads = arguments.whole("threads", threads, 0, MOST_THREADS)
    try:
        found = _native.find_volumes(_native.SceneParts(**parts.arrays()), threads=threads)
    except _native.OutOfRangeError as error:
        raise unreachable(scene, int(error.args[0])) from None
    names = tuple(one.name for one in scene.objects)
    without = tuple(name for name, known in zip(names, found.known, strict=True) if not known)
    return VolumeFractions(names, grid, found.objects, found.voxels, found.volumes, found.whole, without)
