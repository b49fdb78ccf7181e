"""Memories as NumPy archives, for programs that work with arrays."""

from __future__ import annotations

import io
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.export.atomic import write_atomically
from voxrt.octree import to_points

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.octree import Rom


def write_npz(path: Path, rom: Rom, high: tuple[int, int, int] | None = None) -> None:
    """Write the solid voxels of a memory as a NumPy archive. Equal memories give equal bytes.

    The archive holds ``coordinates`` (uint16, shape (N, 3), x, y, z, in Morton order), ``material_ids`` (uint8, shape
    (N,)), ``colours`` (uint8, shape (M, 3), sRGB by material id), ``names`` (text, shape (M,)), ``depth``, and if the
    memory knows its place in the scene ``origin`` (float64, shape (3,), metres) and ``voxel_size`` (metres).

    Parameters
    ----------
    path
        The file.
    rom
        The memory and its materials.
    high
        Only voxels below this; None for all.

    Raises
    ------
    DoesNotFitError
        The solid voxels take more than 2 GiB one by one.
    OSError
        The file cannot be written.

    Examples
    --------
    >>> import numpy as np, voxrt
    >>> from pathlib import Path
    >>> write_npz(Path("house.npz"), voxrt.build("examples/house.obj", depth=4).rom)
    >>> np.load("house.npz")["coordinates"].shape
    (2504, 3)
    """
    coordinates, material_ids = to_points(rom.octree)
    if high is not None:
        kept = (coordinates < high).all(axis=1)
        coordinates, material_ids = coordinates[kept], material_ids[kept]
    arrays: dict[str, NDArray[Any]] = {
        "coordinates": coordinates.astype(np.uint16),
        "material_ids": material_ids,
        "colours": np.array([material.colour for material in rom.materials], np.uint8),
        "names": np.array([material.name for material in rom.materials]),
        "depth": np.array(rom.octree.depth),
    }
    if rom.grid is not None:
        arrays |= {"origin": np.array(rom.grid.origin), "voxel_size": np.array(rom.grid.voxel_size)}
    packed = io.BytesIO()
    np.savez_compressed(packed, allow_pickle=False, **arrays)
    write_atomically(path, packed.getvalue())
