"""How much of each voxel the objects of an asset fill: found, and written for other programs."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np
from msgspec.structs import replace

from voxrt import octree
from voxrt.export.atomic import write_atomically
from voxrt.export.outputs import OutputError, check_file, writing
from voxrt.options.build_options import BuildOptions
from voxrt.options.option import merge
from voxrt.plans.plan import fit_plan
from voxrt.plans.stage_clock import StageClock
from voxrt.sources.source import open_source
from voxrt.view.cells import import_pyvista
from voxrt.view.octant_files import write_image
from voxrt.voxelize import DoesNotFitError, voxelize
from voxrt.voxelize import volume_fractions as fractions_on_grid

if TYPE_CHECKING:
    import os

    from numpy.typing import NDArray

    from voxrt.options.keywords import BuildKeywords
    from voxrt.sources.source import Asset
    from voxrt.voxelize import Scene, VolumeFractions

FRACTION_SUFFIXES = (".npz", ".vti")
_DEEPEST_IMAGE = 8


def volume_fractions(
    asset: Asset, options: BuildOptions | None = None, **keywords: Unpack[BuildKeywords]
) -> VolumeFractions:
    """Find how much of each voxel the objects of an asset fill.

    Parameters
    ----------
    asset
        As :func:`build` takes it.
    options
        How to build; None for the defaults. Only those count that say what is voxelized and on which grid.
    **keywords
        The options of :class:`BuildOptions` by name. They take precedence over `options`.

    Returns
    -------
    VolumeFractions
        A fraction per object and voxel with surface of the object.

    Raises
    ------
    TypeError, ValueError, AssetError, DoesNotFitError
        As :func:`build` does.

    Examples
    --------
    >>> import voxrt
    >>> found = voxrt.volume_fractions("examples/house.obj", depth=5)
    >>> found.names[0], round(float(found.volumes[0]), 2)
    ('door', 74.25)
    """
    options = merge("volume_fractions", BuildOptions, options, keywords)
    source = open_source(asset, options)
    scene = source.load()
    source.refuse_warnings(scene.warnings)
    grid = fit_plan(scene, options, StageClock(None), on_disk=False).grid
    return fractions_on_grid(scene, grid, geometry=options.geometry, pow2=options.pow2, threads=options.threads)


def write_fractions(found: VolumeFractions, scene: Scene, path: str | os.PathLike[str]) -> None:
    """Write fractions as a NumPy archive (``.npz``) or as an image for ParaView (``.vti``).

    An archive holds the arrays of :class:`VolumeFractions`, ``depth``, ``origin`` (metres) and ``voxel_size`` (metres).
    An image holds ``fraction`` per cell: the sum over all objects, which exceeds 1 where they overlap.

    Raises
    ------
    DoesNotFitError
        An image of more than 256 voxels per side.
    OutputError
        The file cannot be written, or has another suffix.
    ViewerError
        ``.vti`` needs PyVista, which is not installed.

    Examples
    --------
    >>> import voxrt
    >>> scene = voxrt.load("examples/house.obj")
    >>> write_fractions(voxrt.volume_fractions(scene, depth=4), scene, "house-fractions.npz")
    """
    path = Path(path)
    check_fractions_file(path, found.grid.depth)
    with writing(path):
        if path.suffix.lower() == ".vti":
            write_image(path, fraction_image(found, scene), found.grid)
            return
        archive = io.BytesIO()
        np.savez_compressed(
            archive,
            names=np.array(found.names),
            objects=found.objects,
            voxels=found.voxels,
            fractions=found.fractions,
            whole=found.whole,
            without=np.array(found.without, np.str_),
            depth=found.grid.depth,
            origin=np.array(found.grid.origin),
            voxel_size=found.grid.voxel_size,
        )
        write_atomically(path, archive.getvalue())


def check_fractions_file(path: Path, depth: int | None) -> None:
    """Refuse a file that fractions cannot be written to, as :func:`write_fractions` does. `depth`: None if unknown."""
    check_file(path)
    if path.suffix.lower() not in FRACTION_SUFFIXES:
        raise OutputError(f"{path}: fractions are written as {' or '.join(FRACTION_SUFFIXES)}; name such a file")
    if path.suffix.lower() != ".vti":
        return
    if depth is not None and depth > _DEEPEST_IMAGE:
        raise DoesNotFitError(f"{path}: an image has at most 256 voxels per side; write .npz, or take depth 8")
    import_pyvista()


def fraction_image(found: VolumeFractions, scene: Scene) -> NDArray[np.float64]:
    """Return the sum of the fractions of all objects in each voxel: float64, shape (S, S, S), [x, y, z].

    Examples
    --------
    >>> import voxrt
    >>> scene = voxrt.load("examples/house.obj")
    >>> found = voxrt.volume_fractions(scene, depth=4)
    >>> fraction_image(found, scene).shape
    (16, 16, 16)
    """
    side = found.grid.size
    image = np.zeros((side,) * 3)
    for number, item in enumerate(scene.objects):
        if item.name in found.without:
            continue
        alone = voxelize(replace(scene, objects=(replace(item, rule="touch", fill="solid"),)), found.grid).voxels
        whole = octree.to_dense(octree.build(alone)) != 0
        listed = found.objects == number
        places = tuple(found.voxels[listed].T)
        whole[places] = False
        image += whole
        image[places] += found.fractions[listed]
    return image
