"""Bake the light of a sun and a sky into the colours of surface voxels.

How it works: the native code finds the exposed voxels, the normal of each, and the voxel before the surface from whose
centre rays go towards the sun and the sky (``src/bake/surface_points.h``). It tells exactly which of them hit nothing
(``src/bake/received_light.h``). The sum over the sky is weighted by the cosine (Lambert's law). A voxel that is exposed
on both sides, as in a sheet, takes the side with more light. Its colour is the material's in linear light times the
light; the quantizer chooses a palette for all of them, and the octree is built again. Voxels that are not exposed keep
their materials.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree import Rom, build
from voxrt.sim import _bake
from voxrt.sim.baking.daylight import Daylight, sky_directions, sun_direction
from voxrt.sim.baking.surface_triangles import surface_triangles
from voxrt.voxelize import Material, Voxels
from voxrt.voxelize.arguments import instance, whole
from voxrt.voxelize.colour.palette import quantize
from voxrt.voxelize.colour.srgb import linear_from_srgb, srgb_from_linear

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize import Scene
    from voxrt.voxelize.object_proxies import Geometry

MOST_COLOURS = 254
"""The most colours of baked light in one memory."""

_MOST_INSIDE = 16  # materials of voxels that are not exposed
_SUM_OF_UNIT_LIGHT = float(1 << 44)  # of light 1 from one direction that a surface faces
_WEIGHT = float(1 << 16)


@dataclass(frozen=True, eq=False, slots=True)
class BakedLight:
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
    _rows: NDArray[np.int64]

    def memory(self, colours: int = MOST_COLOURS, *, threads: int = 0) -> Rom:
        """Return the memory with baked colours.

        Parameters
        ----------
        colours
            The most colours of the palette, 1 … 254. There are fewer where voxels that are not exposed, and mirrors,
            need more than one material.
        threads
            Threads to use; 0 takes one per core. The result does not depend on it.

        Returns
        -------
        Rom
            The same voxels are solid. Shown flat, with ``Lighting(flat=True)``, they have their baked colours.

        Raises
        ------
        TypeError, ValueError
            An argument of the wrong type or out of range.
        """
        colours = whole("colours", colours, 1, MOST_COLOURS)
        cells, levels = self._surface.cells.copy(), self._surface.octant_materials
        flat = cells.reshape(-1)
        inside = np.bincount(flat, minlength=256)
        inside -= np.bincount(flat[self._rows], minlength=256)
        volumes = np.int64(1) << 3 * self._surface.octant_levels.astype(np.int64)
        inside = inside + np.bincount(levels, volumes, minlength=256).astype(np.int64)
        nearest, kept = self._nearest_kept(inside)
        free = [number for number in range(1, 256) if number not in kept]
        palette, rows = quantize(self.colours, np.ones(len(self.colours)), min(colours, len(free)))
        materials = {0: self.rom.materials[0]} | {number: self.rom.materials[number] for number in kept}
        names = {one.name for one in materials.values()}
        for number, (red, green, blue) in zip(free, palette.tolist(), strict=False):
            name = f"lit #{red:02x}{green:02x}{blue:02x}"
            while name in names:
                name += "'"
            names.add(name)
            materials[number] = Material(name, (red, green, blue))
        for number in set(range(max(materials))) - set(materials):  # ids that nothing uses any more
            materials[number] = self.rom.materials[number]
        flat[:] = nearest[flat]
        if len(palette):
            flat[self._rows] = np.array(free[: len(palette)], np.uint8)[rows]
        tree = build(_voxels(self.rom.octree.depth, self._surface, cells, nearest[levels]), threads=threads)
        table = tuple(materials[number] for number in sorted(materials))
        return replace(self.rom, octree=tree, materials=table)

    def _nearest_kept(self, inside: NDArray[np.int64]) -> tuple[NDArray[np.uint8], list[int]]:
        """Return the id that each id becomes where it is not exposed, and the ids that stay: mirrors and the commonest.

        An id that does not stay becomes the one with the nearest colour.
        """
        used = np.flatnonzero(inside[1:]) + 1
        table = np.array([one.colour for one in self.rom.materials], np.int64)
        mirror = np.array([one.mirror for one in self.rom.materials])
        order = sorted(used.tolist(), key=lambda number: (not mirror[number], -inside[number], number))
        kept = order[: max(_MOST_INSIDE, int(mirror[used].sum()))]
        nearest = np.arange(256).astype(np.uint8)
        for number in order[len(kept) :]:
            nearest[number] = kept[int(((table[kept] - table[number]) ** 2).sum(axis=1).argmin())]
        return nearest, kept


def bake_light(
    rom: Rom, scene: Scene, daylight: Daylight | None = None, *, geometry: Geometry = "auto", threads: int = 0
) -> BakedLight:
    """Find the light on the surface of a memory under a sun and a sky.

    Parameters
    ----------
    rom
        The memory, with its place in the scene.
    scene
        The scene from which it was built: its triangles give the normals.
    daylight
        The sun and the sky; None for the default ones.
    geometry
        As for :func:`voxrt.voxelize.voxelize`.
    threads
        Threads to use; 0 takes one per core. The result does not depend on it.

    Returns
    -------
    BakedLight
        ``memory()`` makes the memory with these colours.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong type or range, or a memory whose place in the scene is not known.

    Examples
    --------
    >>> import voxrt
    >>> built = voxrt.build("examples/house.obj", depth=5)
    >>> light = bake_light(built.rom, built.scene)
    >>> light.memory().octree.depth, bool(light.sky.max() <= 1)
    (5, True)
    """
    daylight = Daylight() if daylight is None else instance("daylight", daylight, Daylight)
    threads = whole("threads", threads, 0, 1024)
    if rom.grid is None:
        raise ValueError("rom has no grid: its place in the scene must be known")
    words, depth = rom.octree.words, rom.octree.depth
    corners, normals = surface_triangles(scene, rom.grid, geometry)
    surface = _bake.measure_surface(words, depth, corners, normals, threads)
    mirror = np.zeros(256, np.bool_)
    mirror[: len(rom.materials)] = [one.mirror for one in rom.materials]
    sun, sky = _light(words, depth, surface, daylight, threads)
    # Both sides of a voxel follow one another; the side with more light counts.
    rows, first = np.unique(surface.voxels.astype(np.int64), return_index=True)
    total = daylight.sun_light * sun + float(np.mean(daylight.sky)) * sky
    second = np.minimum(first + 1, len(total) - 1)
    has_second = np.diff(np.append(first, len(total))) > 1
    best = np.where(has_second & (total[second] > total[first]), second, first)
    seen = ~mirror[surface.cells.reshape(-1)[rows]]
    rows, best = rows[seen], best[seen]
    own = linear_from_srgb(np.array([one.colour for one in rom.materials]))[surface.cells.reshape(-1)[rows]]
    light = daylight.sun_light * sun[best, None] + sky[best, None] * np.array(daylight.sky)
    return BakedLight(
        rom,
        _positions(surface.brick_codes, rows),
        daylight.sun_light * sun[best],
        sky[best],
        srgb_from_linear(own * light),
        surface,
        rows,
    )


def _light(
    words: NDArray[np.uint32], depth: int, surface: _bake.Surface, daylight: Daylight, threads: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the cosine of the sun where it is seen, else 0, and the sky's share, of each point."""
    found = []
    for directions in (sun_direction(daylight), sky_directions(daylight.samples)):
        steps, units, weights = directions.steps, directions.units, directions.weights
        found.append(
            _bake.receive_light(words, depth, surface.origins, surface.normals, steps, units, weights, threads)
        )
    sun, sky = found
    return sun.received / _SUM_OF_UNIT_LIGHT, sky.received / (_WEIGHT * np.maximum(sky.full, 1))


def _positions(codes: NDArray[np.uint64], rows: NDArray[np.int64]) -> NDArray[np.int32]:
    """Return voxel coordinates from rows of cells: int32, shape (N, 3)."""
    code = codes[rows >> 9].astype(np.int64) << 9 | rows & 511
    found = np.zeros((len(rows), 3), np.int32)
    for bit in range(16):
        for axis in range(3):
            found[:, axis] |= (code >> (3 * bit + axis) & 1).astype(np.int32) << bit
    return found


def _voxels(depth: int, surface: _bake.Surface, cells: NDArray[np.uint8], octants: NDArray[np.uint8]) -> Voxels:
    bricks = len(cells)
    masks = np.packbits(cells != 0, axis=1, bitorder="little").view("<u8").astype(np.uint64)
    return Voxels(
        depth,
        surface.brick_codes,
        masks.reshape(bricks, 8),
        np.zeros(bricks, np.uint8),
        np.arange(bricks, dtype=np.int32),
        cells,
        surface.octant_codes,
        surface.octant_levels,
        octants,
    )
