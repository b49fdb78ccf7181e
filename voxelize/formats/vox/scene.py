"""MagicaVoxel files as scenes: the surface of their voxels, so that they build like any asset.

Each side of a voxel that lies open is a square. The squares close, so what they enclose is solid. A side on the border
of two voxels of the grid lies in neither: a small tetrahedron in the middle of each voxel that can be seen gives that
voxel its colour.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import arguments
from voxrt.voxelize.formats.external_files import asset_name
from voxrt.voxelize.formats.vox.load import load_vox
from voxrt.voxelize.mesh import Mesh
from voxrt.voxelize.primitive_meshes import VOXEL_MARK, VOXEL_MARK_TRIANGLES
from voxrt.voxelize.scene import Scene, SceneObject

if TYPE_CHECKING:
    from numpy.typing import NDArray

# The corners of the side that faces each of six ways, counter-clockwise seen from outside.
_SIDES = (
    ((-1, 0, 0), ((0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0))),
    ((1, 0, 0), ((1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1))),
    ((0, -1, 0), ((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1))),
    ((0, 1, 0), ((0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0))),
    ((0, 0, -1), ((0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0))),
    ((0, 0, 1), ((0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))),
)
_SQUARE = np.array([[0, 1, 2], [0, 2, 3]], np.int32)


def load_vox_scene(path: str | Path, *, unit: float | None = None, time: float | None = None) -> Scene:
    """Read a MagicaVoxel file.

    Parameters
    ----------
    path
        The file.
    unit
        Metres per voxel; None for 1.
    time
        Which frame of an old animation (``PACK``): its number, counted from 0; None for the first.

    Returns
    -------
    Scene
        One object, of one triangle mesh; its voxel size is that of the file.

    Raises
    ------
    AssetError
        The file cannot be read, breaks the format, or holds no visible voxel.
    DoesNotFitError
        The scene holds more than 2**25 voxels.
    """
    path = Path(path)
    size = 1.0 if unit is None else arguments.metres_per_unit("unit", unit)
    voxels = load_vox(path, frame=0 if time is None else max(0, int(time)))
    mesh = _surface(voxels.coordinates, voxels.material_ids)
    transform = np.diag([size, size, size, 1.0])
    name = asset_name(path)
    objects = (SceneObject(name, mesh, transform),)
    return Scene(name, objects, voxels.materials, voxels.warnings, voxel_size=size)


def _surface(coordinates: NDArray[np.int64], ids: NDArray[np.uint8]) -> Mesh:
    low = coordinates.min(axis=0) - 1
    spans = coordinates.max(axis=0) - low + 2
    steps = np.array([spans[1] * spans[2], spans[2], 1])
    keys, first = np.unique((coordinates - low) @ steps, return_index=True)  # where voxels repeat, the first counts
    corners, ids = coordinates[first].astype(np.float64), ids[first]
    positions, triangles, materials = [], [], []
    seen = np.zeros(len(keys), np.bool_)
    count = 0

    def add(where: NDArray[np.bool_], shape: NDArray[np.float64], faces: NDArray[np.int32]) -> None:
        nonlocal count
        points = (corners[where][:, None] + shape).reshape(-1, 3)
        begins = count + len(shape) * np.arange(len(points) // len(shape))
        positions.append(points)
        triangles.append((begins[:, None, None] + faces).reshape(-1, 3))
        materials.append(np.repeat(ids[where], len(faces)))
        count += len(points)

    for way, square in _SIDES:
        beside = keys + np.array(way) @ steps
        place = np.minimum(np.searchsorted(keys, beside), len(keys) - 1)
        is_open = keys[place] != beside
        seen |= is_open
        add(is_open, np.array(square, np.float64), _SQUARE)
    add(seen, VOXEL_MARK, VOXEL_MARK_TRIANGLES)
    return Mesh(np.concatenate(positions), np.concatenate(triangles).astype(np.int32), np.concatenate(materials))
