"""The front of the native voxelizer: a scene becomes voxels.

Each object becomes parts in grid space: its mesh, or one part per collider. Vertices are snapped to 1/4096 voxel; from
there on coverage is exact. Winding numbers tell inside from outside. The first object that covers a voxel keeps it.

Materials: a voxel of the shell takes the material of the first triangle, in authored order, that covers it. Where that
triangle has a material map, it takes the material at the triangle's point nearest to the voxel's centre. The inside,
which no ray from outside can see, takes the material of its object's first triangle. A surface that is cut away still
bounds the inside; voxels that only such a surface covers are empty.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize import _native, arguments
from voxrt.voxelize.scene_parts import SceneParts, unreachable
from voxrt.voxelize.voxels import Voxelization, Voxels

if TYPE_CHECKING:
    from voxrt.voxelize.box_rounding import Pow2
    from voxrt.voxelize.grid import Grid
    from voxrt.voxelize.object_proxies import Geometry
    from voxrt.voxelize.rules import ObjectFill, Rule, Thin
    from voxrt.voxelize.scene import Scene

MOST_THREADS = 1024


def voxelize(
    scene: Scene,
    grid: Grid,
    *,
    fill: ObjectFill = "solid",
    rule: Rule = "touch",
    thin: Thin = "keep",
    geometry: Geometry = "auto",
    pow2: Pow2 = "box",
    threads: int = 0,
) -> Voxelization:
    """Voxelize a scene.

    Parameters
    ----------
    scene, grid
        The scene, and the grid to voxelize it on. What lies outside the grid is cut off.
    fill
        ``"solid"`` fills what surfaces enclose, small holes or not and whichever way each closed piece faces. It does
        not fill open pieces: those with an opening larger than 15 % of their area that other pieces do not close.
        ``"surface"`` keeps the shells alone. ``"auto"`` is ``"solid"``, but leaves open also pieces whose openings
        exceed 5 % of their area together, as those of clothes do.
        Objects with a fill of their own keep that.
    rule
        ``"touch"``: a voxel is solid when an object's closed solid overlaps its interior at all. ``"centre"``: when its
        centre lies in an object's closed solid. ``"half"``: when the volumes of the objects in it add up to half of it;
        surfaces with holes, balls and ellipsoids go by their centres. A surface that encloses nothing keeps each voxel
        that it touches.
        Objects with a rule of their own keep that.
    thin
        What becomes of parts too thin for the rule. ``"keep"``: they keep some of the voxels that they touch, so that
        each of these is solid or has a solid one among its 26 neighbours, and what is connected stays so. ``"drop"``:
        they keep no more than the rule gives.
    geometry
        ``"auto"``: an object's colliders where it has some, else its triangles; ``"render"``: always the triangles;
        ``"collider"``: always colliders, and the box of the mesh where the author gave none (with a warning).
    pow2
        ``"box"`` rounds box colliders that ask for it up to powers of two voxels; ``"none"`` never.
    threads
        The number of threads, 0 … 1024; 0 for as many as the machine has. The result does not depend on it.

    Returns
    -------
    Voxelization
        The voxels, a report per object, and warnings.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong kind or range.
    AssetError
        A coordinate that is not finite.
    DoesNotFitError
        An object that reaches into the grid from more than 2**18 voxels away.

    Examples
    --------
    >>> from voxrt.voxelize import Grid, authoring, voxelize
    >>> yard = authoring.Author("yard")
    >>> _ = yard.material("stone", "#9a9aa0")
    >>> yard.add("block", authoring.box((4, 4, 4), centre=(2, 2, 2)), material="stone")
    >>> result = voxelize(yard.build(), Grid(3, (0, 0, 0), 1.0))
    >>> [(one.name, str(one.mode), one.voxels) for one in result.objects]
    [('block', 'exact', 64)]
    """
    parts = SceneParts(scene, grid, fill=fill, rule=rule, thin=thin, geometry=geometry, pow2=pow2)
    threads = arguments.whole("threads", threads, 0, MOST_THREADS)
    try:
        result = _native.voxelize(_native.SceneParts(**parts.arrays()), **parts.choices, threads=threads)
    except _native.OutOfRangeError as error:
        raise unreachable(scene, int(error.args[0])) from None
    return Voxelization(voxels_of(grid.depth, result), *parts.described(result), result.seconds)


def voxels_of(depth: int, result: _native.Voxelized | _native.VoxelBlock) -> Voxels:
    """Return the voxels of a native result."""
    return Voxels(depth, *(getattr(result, name) for name in Voxels.__struct_fields__[1:]))
