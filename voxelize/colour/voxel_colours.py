"""Colours per voxel: one palette for the textures and vertex colours of a scene, as finely as a grid can show them.

Each triangle with an appearance gets a raster of cells that are about one voxel wide, and all cells of the scene share
one palette (src/colour/assign_colours.h).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.voxelize import _native, arguments
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.grid import Grid
from voxrt.voxelize.materials import MATERIAL_LIMIT, Material
from voxrt.voxelize.mesh import MaterialMap
from voxrt.voxelize.object_proxies import GEOMETRIES, proxies
from voxrt.voxelize.scene import Scene

if TYPE_CHECKING:
    from voxrt.voxelize.mesh import Mesh
    from voxrt.voxelize.object_proxies import Geometry

DEFAULT_COLOURS = 32
"""The default number of colours for all textures and vertex colours of a scene. On test models, 64 colours gain 2.5 to
5.6 dB and cost up to 30 % more memory words (docs/colours.md)."""


def assign_colours(scene: Scene, grid: Grid, *, colours: int = DEFAULT_COLOURS, geometry: Geometry = "auto") -> Scene:
    """Give textured and vertex-coloured triangles materials that vary as finely as a grid shows.

    The voxels that are covered stay the same, except where the alpha of a surface is below its cutoff: there it is cut
    away.

    Parameters
    ----------
    scene
        A scene as it was loaded.
    grid
        The grid on which it will be voxelized.
    colours
        The most materials to add, 1 … 254; fewer where the scene's own materials leave fewer of the 255 ids. Where
        there are no more sRGB colours than that, each is kept exactly.
    geometry
        As for :func:`voxrt.voxelize.voxelize`: objects that colliders represent keep their materials.

    Returns
    -------
    Scene
        The scene with :attr:`Mesh.material_map <voxrt.voxelize.Mesh>` set, and the palette appended to its materials.
        A palette entry is named after the material that it covers most of, and its colour. Materials of the scene keep
        their ids.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong kind or range.
    DoesNotFitError
        The scene's own materials leave no id for the palette.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.voxelize import EMPTY, Appearance, Grid, Material, Mesh, Scene, SceneObject, SurfaceAppearance
    >>> red, blue = (1, 0, 0, 1), (0, 0, 1, 1)
    >>> surface = SurfaceAppearance([Appearance("flag")], [0, 0], np.zeros((2, 3, 2)), [[red] * 3, [blue] * 3])
    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2], [0, 1, 3]], [1, 1], surface)
    >>> scene = Scene("flag", [SceneObject("flag", mesh)], [EMPTY, Material("flag", (128, 0, 128))])
    >>> [material.name for material in assign_colours(scene, Grid(2, (0, 0, 0), 0.25)).materials]
    ['empty', 'flag', 'flag #0000ff', 'flag #ff0000']
    """
    arguments.instance("scene", scene, Scene)
    arguments.instance("grid", grid, Grid)
    arguments.choice("geometry", geometry, GEOMETRIES)
    colours = arguments.whole("colours", colours, 1, MATERIAL_LIMIT - 1)
    shown = [item for item in scene.objects if item.mesh.appearance is not None and proxies(item, geometry) is None]
    if not shown:
        return scene
    meshes = list({id(item.mesh): item.mesh for item in shown}.values())
    numbers = {id(mesh): number for number, mesh in enumerate(meshes)}
    try:
        table, maps = _native.assign_colours(
            [_arrays(mesh) for mesh in meshes],
            [(numbers[id(item.mesh)], np.ascontiguousarray(item.transform, np.float64)) for item in shown],
            [(one.name, one.colour, one.mirror, one.authored) for one in scene.materials],
            _used_ids(scene),
            grid.voxel_size,
            colours,
        )
    except _native.TooManyMaterialsError as error:
        raise DoesNotFitError(f"{scene.name}: {error}") from None
    mapped = {
        id(mesh): replace(mesh, materials=materials, material_map=MaterialMap(sizes, corners, cells))
        for mesh, (sizes, corners, cells, materials) in zip(meshes, maps, strict=True)
    }
    objects = tuple(
        replace(item, mesh=mapped[id(item.mesh)]) if id(item.mesh) in mapped else item for item in scene.objects
    )
    return replace(scene, objects=objects, materials=tuple(Material(*one) for one in table))


def _arrays(mesh: Mesh) -> _native.VariedMeshArrays:
    assert mesh.appearance is not None
    return (
        np.ascontiguousarray(mesh.positions),
        np.ascontiguousarray(mesh.triangles),
        np.ascontiguousarray(mesh.materials),
        mesh.appearance.arrays(),
    )


def _used_ids(scene: Scene) -> list[bool]:
    """Tell which ids triangles and colliders have."""
    used = np.zeros(MATERIAL_LIMIT + 1, np.bool_)
    for item in scene.objects:
        used[item.collider_material] = True
    for mesh in {id(item.mesh): item.mesh for item in scene.objects}.values():
        used[mesh.materials] = True
    return used.tolist()
