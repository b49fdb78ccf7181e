"""Bake the light of a sun and a sky into the colours of surface voxels.

The native code is the manual: ``src/bake/baked_light.h``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from voxrt.octree import Octree, Rom
from voxrt.octree.morton import positions
from voxrt.sim import _bake
from voxrt.sim.baking.daylight import Daylight
from voxrt.voxelize import Material
from voxrt.voxelize.arguments import instance, whole
from voxrt.voxelize.object_proxies import proxies

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize import Grid, Mesh, Scene
    from voxrt.voxelize.object_proxies import Geometry

MOST_COLOURS = 254
"""The most colours of baked light in one memory."""


class BakedLight(Struct, frozen=True, eq=False):
    """The light on the surface of a memory, before colours are reduced to a palette.

    Attributes
    ----------
    rom
        The memory as it was.
    voxels
        int32, shape (N, 3): the exposed voxels, grid frame, in Morton order. Mirrors are not among them.
    sun, sky
        float64, shape (N,): the sun's light on each, 0 … 0.65, and the share of an open sky's light, 0 … 1.
    colours
        uint8, shape (N, 3): the colour of each, sRGB.
    """

    rom: Rom
    voxels: NDArray[np.int32]
    sun: NDArray[np.float64]
    sky: NDArray[np.float64]
    colours: NDArray[np.uint8]
    _surface: _bake.Surface
    _rows: NDArray[np.uint64]

    def memory(self, colours: int = MOST_COLOURS, *, threads: int = 0) -> Rom:
        """Return the memory with baked colours: the same voxels are solid, shown with ``Lighting(flat=True)``.

        At most `colours` of them, 1 … 254; fewer where voxels that are not exposed, and mirrors, need more than one
        material. TypeError or ValueError for other numbers.
        """
        colours = whole("colours", colours, 1, MOST_COLOURS)
        depth, surface = self.rom.octree.depth, self._surface
        words, table = _bake.bake_memory(
            depth,
            surface.brick_codes,
            surface.cells,
            surface.octant_codes,
            surface.octant_levels,
            surface.octant_materials,
            self._rows,
            self.colours,
            _fields(self.rom),
            colours,
            threads,
        )
        return replace(self.rom, octree=Octree(depth, words), materials=tuple(Material(*one) for one in table))


def bake_light(
    rom: Rom, scene: Scene, daylight: Daylight | None = None, *, geometry: Geometry = "auto", threads: int = 0
) -> BakedLight:
    """Find the light on the surface of a memory under a sun and a sky; None takes the default ones.

    The memory knows its place in `scene`, from which it was built: the scene's triangles give the normals. `geometry`
    is that of :func:`voxrt.voxelize.voxelize`. TypeError or ValueError for other arguments.
    """
    daylight = Daylight() if daylight is None else instance("daylight", daylight, Daylight)
    threads = whole("threads", threads, 0, 1024)
    if rom.grid is None:
        raise ValueError("rom has no grid: its place in the scene must be known")
    words, depth = rom.octree.words, rom.octree.depth
    corners, normals = surface_triangles(scene, rom.grid, geometry)
    surface = _bake.measure_surface(words, depth, corners, normals, threads)
    points, sun, sky, open_sky = _bake.measure_light(
        words,
        depth,
        surface.brick_codes,
        surface.voxels,
        surface.origins,
        surface.normals,
        daylight.sun,
        daylight.sky,
        daylight.samples,
        threads,
    )
    lit = _bake.light_voxels(points, surface.cells, sun, sky, open_sky, _fields(rom), daylight.sun, daylight.sky)
    rows = lit.rows.astype(np.int64)
    voxels = positions(surface.brick_codes[rows >> 9].astype(np.int64) << 9 | rows & 511)
    return BakedLight(rom, voxels, lit.sun, lit.sky, lit.colours, surface, lit.rows)


def _fields(rom: Rom) -> list[tuple[str, tuple[int, int, int], bool, bool]]:
    return [(one.name, one.colour, one.mirror, one.authored) for one in rom.materials]


def surface_triangles(scene: Scene, grid: Grid, geometry: Geometry) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    """Return the triangles of all objects that are voxelized from their triangles (``src/bake/placed_triangles.h``).

    The corners are float64, shape (T, 3, 3): voxels, grid frame. The normals are float32, shape (T, 3, 3): unit normals
    of the corners, the author's, turned to the triangle's side. Where the mesh has none, they are smooth over edges
    with an angle below 45 degrees.
    """
    shown = [item for item in scene.objects if proxies(item, geometry) is None and len(item.mesh.triangles)]
    meshes = {id(item.mesh): item.mesh for item in shown}
    numbers = {key: number for number, key in enumerate(meshes)}
    objects = [(numbers[id(item.mesh)], np.ascontiguousarray(item.transform[:3], np.float64)) for item in shown]
    return _bake.place_triangles([_arrays(mesh) for mesh in meshes.values()], objects, grid.origin, grid.voxel_size)


def _arrays(mesh: Mesh) -> tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.float64], NDArray[np.int32]]:
    positions = np.ascontiguousarray(mesh.positions, np.float64)
    normals = mesh.normals
    directions = np.zeros((0, 3)) if normals is None else np.ascontiguousarray(normals.vectors, np.float64)
    rows = np.zeros((0, 3), np.int32) if normals is None else np.ascontiguousarray(normals.rows)
    return positions, np.ascontiguousarray(mesh.triangles), directions, rows
