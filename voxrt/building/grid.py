"""The grid of a build."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt import voxelize
from voxrt.options.build_options import DEFAULT_DEPTH

if TYPE_CHECKING:
    from voxrt.options.build_options import BuildOptions
    from voxrt.voxelize import Grid, Scene


def build_grid(scene: Scene, options: BuildOptions) -> Grid:
    """Fit the grid that options ask for to a scene.

    Raises
    ------
    AssetError
        The scene has nothing to voxelize, or a coordinate that is not finite.
    DoesNotFitError
        The scene needs more than 2**16 voxels per side.

    Examples
    --------
    >>> from voxrt import BuildOptions, load
    >>> build_grid(load("examples/house.obj"), BuildOptions()).depth
    7
    """
    return voxelize.fit_grid(
        scene,
        depth=DEFAULT_DEPTH if options.depth is None and options.voxel_size is None else options.depth,
        voxel_size=options.voxel_size,
        geometry=options.geometry,
        pow2=options.pow2,
        bounds=None if options.bounds is None else (options.bounds[:3], options.bounds[3:]),
    )
