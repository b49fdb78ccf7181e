"""From paint to materials voxel by voxel: a palette for what a grid can show of a scene's textures and vertex colours.

Each painted triangle gets a raster whose cells are about a voxel wide: its columns run along a side of the triangle,
its rows towards the corner across. So there are about two cells a voxel that it covers, slivers included. A cell has
the colour of the paint in its middle; textures finer than cells are reduced first. All cells of the scene share one
palette. Then the voxelizer gives each voxel of the shell the material of the cell nearest to it
(src/material_raster.h).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colliders import stand_ins
from voxrt.voxelize.colour.paint import shade
from voxrt.voxelize.colour.palette import quantize
from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.colour.texture import Texture, halved
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.scene import MATERIAL_LIMIT, Material, Tints

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from voxrt.voxelize.colliders import Geometry
    from voxrt.voxelize.colour.paint import Coat, Paint
    from voxrt.voxelize.grid import Grid
    from voxrt.voxelize.scene import Mesh, Scene

DEFAULT_COLOURS = 32
"""How many colours painted surfaces get together, where nobody says: pictures of models then differ from those with all
254 by 45 to 63 dB (38 for a photograph); twice as many take up to a quarter more words for 2 to 4 dB."""

_MOST_CELLS = 1 << 23
_LONGEST = 1 << 16
_CHUNK = 1 << 18
_RIGHT = 1e-6


def tint(scene: Scene, grid: Grid, *, colours: int = DEFAULT_COLOURS, geometry: Geometry = "auto") -> Scene:
    """Give painted surfaces materials that vary over triangles as finely as a grid shows.

    What the voxelizer covers does not change, but for surface below its paint's alpha cutoff, which is cut away.

    Parameters
    ----------
    scene
        As it was loaded.
    grid
        The grid that it will be voxelized on.
    colours
        The most materials to add, 1 … 254: they share what the scene's own leave of 255. Where there are fewer
        colours of 8 bits, each keeps its own.
    geometry
        As for :func:`voxrt.voxelize.voxelize`: objects whose colliders stand for them are not tinted.

    Returns
    -------
    The scene with :attr:`Mesh.tints`, and its materials with the palette appended, each named after the paint that it
    covers most of. Its own materials keep their ids.

    Raises
    ------
    ValueError
        `colours` is out of range.
    DoesNotFitError
        The scene's own materials leave no id to the palette.
    """
    if not 1 <= colours < MATERIAL_LIMIT:
        raise ValueError(f"colours must be 1 … {MATERIAL_LIMIT - 1}, not {colours}")
    frames = _frames(scene, grid, geometry)
    if not frames:
        return scene
    outlines = _outlines(frames.values())
    brushes: dict[tuple[int, int], Texture] = {}
    cells = [_paint_cells(one, outline, brushes) for one, outline in zip(frames.values(), outlines, strict=True)]
    materials, ids = _materials(scene, cells, colours)
    tinted = {
        key: replace(
            frame.mesh,
            materials=_inner(frame, worn, painted),
            tints=Tints(outline.sizes, outline.places.astype(np.float32), worn),
        )
        for (key, frame), outline, painted, worn in zip(frames.items(), outlines, cells, ids, strict=True)
    }
    objects = tuple(replace(item, mesh=tinted.get(id(item.mesh), item.mesh)) for item in scene.objects)
    return replace(scene, objects=objects, materials=materials)


@dataclass(eq=False, slots=True)
class _Frame:
    """A painted mesh, the largest of the ways from it to voxels, shape (3, 3), and how many objects show it."""

    mesh: Mesh
    coat: Coat
    linear: NDArray[np.float64]
    objects: int = 0


def _frames(scene: Scene, grid: Grid, geometry: Geometry) -> dict[int, _Frame]:
    frames: dict[int, _Frame] = {}
    for item in scene.objects:
        if item.mesh.coat is None or stand_ins(item, geometry) is not None:
            continue
        linear = item.transform[:3, :3] / grid.voxel_size
        frame = frames.setdefault(id(item.mesh), _Frame(item.mesh, item.mesh.coat, linear))
        frame.objects += 1
        if np.abs(linear).sum() > np.abs(frame.linear).sum():
            frame.linear = linear
    return frames


@dataclass(eq=False, slots=True)
class _Outline:
    """How the triangles of a mesh lie in their rasters.

    Attributes
    ----------
    lengths
        float64, shape (T, 2): the side along the columns and the height above it, voxels.
    base
        intp, shape (T,): the corner at which that side begins.
    foot
        float64, shape (T,): where the height stands on it, 0 … 1.
    sizes, places
        As in :class:`Tints`.
    """

    lengths: NDArray[np.float64]
    base: NDArray[np.intp]
    foot: NDArray[np.float64]
    sizes: NDArray[np.int32]
    places: NDArray[np.float64]


def _outlines(frames: Iterable[_Frame]) -> list[_Outline]:
    outlines = [_outline(frame) for frame in frames]
    scale = 1.0
    while True:
        for outline in outlines:
            fitted = np.clip(np.ceil(outline.lengths * scale), 1, _LONGEST)
            outline.sizes = np.where(outline.sizes > 0, fitted, 0).astype(np.int32)
        cells = sum(int(np.prod(outline.sizes, axis=1, dtype=np.int64).sum()) for outline in outlines)
        if cells <= _MOST_CELLS or scale < 1e-9:
            break
        scale *= 0.9
    for outline in outlines:
        rows = np.arange(len(outline.base))
        second, apex = (outline.base + 1) % 3, (outline.base + 2) % 3
        outline.places[rows, second, 0] = outline.sizes[:, 0]
        outline.places[rows, apex, 0] = outline.foot * outline.sizes[:, 0]
        outline.places[rows, apex, 1] = outline.sizes[:, 1]
    return outlines


def _outline(frame: _Frame) -> _Outline:
    with np.errstate(over="ignore", invalid="ignore"):
        corners = (frame.mesh.positions @ frame.linear.T)[frame.mesh.triangles]
        corners = np.clip(np.nan_to_num(corners), -1e9, 1e9)
    sides = np.roll(corners, -1, axis=1) - corners
    squares = np.einsum("tki,tki->tk", sides, sides)
    feet = -np.einsum("tki,tki->tk", sides, np.roll(sides, 1, axis=1)) / np.where(squares > 0, squares, 1.0)
    # Of the sides on which the height stands, the longest always among them, the shortest: where there is a right
    # angle, rows and columns run along it, as those of voxels often do.
    stands = (feet > -_RIGHT) & (feet < 1 + _RIGHT)
    stands[np.arange(len(squares)), squares.argmax(axis=1)] = True
    base = np.where(stands, squares, np.inf).argmin(axis=1)
    rows = np.arange(len(base))
    foot = np.clip(feet[rows, base], 0.0, 1.0)
    along, across = sides[rows, base], -sides[rows, (base + 2) % 3]
    height = np.linalg.norm(across - foot[:, None] * along, axis=1)
    painted = (frame.coat.rows >= 0)[:, None]
    sizes = np.where(painted, 1, 0).astype(np.int32) * np.ones((1, 2), np.int32)
    lengths = np.stack([np.sqrt(squares[rows, base]), height], axis=1)
    return _Outline(lengths, base, foot, sizes, np.zeros((len(base), 3, 2)))


@dataclass(eq=False, slots=True)
class _Cells:
    """The cells of a mesh's rasters.

    Attributes
    ----------
    colours
        uint8, shape (C, 3): sRGB.
    solid
        bool, shape (C,): those that are not cut away.
    weights
        float32, shape (C,): how much of the surface each covers.
    owners
        uint8, shape (C,): the materials of their triangles.
    """

    colours: NDArray[np.uint8]
    solid: NDArray[np.bool_]
    weights: NDArray[np.float32]
    owners: NDArray[np.uint8]


def _paint_cells(frame: _Frame, outline: _Outline, brushes: dict[tuple[int, int], Texture]) -> _Cells:
    counts = np.prod(outline.sizes, axis=1, dtype=np.int64)
    starts = np.cumsum(counts) - counts
    total = int(counts.sum())
    cells = _Cells(
        np.empty((total, 3), np.uint8),
        np.empty(total, np.bool_),
        np.empty(total, np.float32),
        np.repeat(frame.mesh.materials, counts),
    )
    areas = np.prod(outline.lengths, axis=1) / np.maximum(counts, 1) * frame.objects
    for row, paint in enumerate(frame.coat.paints):
        members = np.flatnonzero(frame.coat.rows == row)
        steps = _steps(paint, frame.coat, outline, members)
        for step in np.unique(steps).tolist():
            texture = _brush(paint, step, brushes)
            for some in _chunks(members[steps == step], counts):
                shares, inside = _centres(outline, some, counts[some])
                colours = _colours(frame.coat, paint, texture, np.repeat(some, counts[some]), shares)
                at = np.arange(len(shares)) + np.repeat(
                    starts[some] - (np.cumsum(counts[some]) - counts[some]), counts[some]
                )
                cells.colours[at] = srgb_from_linear(colours[:, :3])
                cells.solid[at] = colours[:, 3] >= paint.cutoff if paint.cutoff > 0 else True
                cells.weights[at] = np.repeat(areas[some], counts[some]) * inside
    return cells


def _steps(paint: Paint, coat: Coat, outline: _Outline, members: NDArray[np.intp]) -> NDArray[np.int64]:
    """Tell how many pixels of its texture are as wide as the cells of triangles: powers of two."""
    if paint.texture is None:
        return np.ones(len(members), np.int64)
    height, width = paint.texture.pixels.shape[:2]
    with np.errstate(over="ignore", invalid="ignore"):
        uv = coat.uv[members] * (width, height)
        one, other = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
        pixels = np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
    across = np.sqrt(np.nan_to_num(pixels) / np.prod(outline.sizes[members], axis=1, dtype=np.int64))
    largest = max(width, height)
    found: NDArray[np.int64] = 1 << np.floor(np.log2(np.clip(across, 1, largest))).astype(np.int64)
    return found


def _brush(paint: Paint, step: int, brushes: dict[tuple[int, int], Texture]) -> Texture | None:
    """Return the texture of a paint, reduced; it is kept in `brushes`, since triangles and meshes share it."""
    if paint.texture is None or step == 1:
        return paint.texture
    key = id(paint.texture), step
    if key not in brushes:
        finer = _brush(paint, step // 2, brushes)
        assert finer is not None
        brushes[key] = halved(finer)
    return brushes[key]


def _chunks(triangles: NDArray[np.intp], counts: NDArray[np.int64]) -> Iterator[NDArray[np.intp]]:
    """Cut triangles into runs of about :data:`_CHUNK` cells."""
    ends = np.cumsum(counts[triangles])
    cuts = np.searchsorted(ends, np.arange(_CHUNK, int(ends[-1]) if len(ends) else 0, _CHUNK))
    yield from (some for some in np.split(triangles, np.unique(cuts)) if len(some))


def _centres(
    outline: _Outline, triangles: NDArray[np.intp], counts: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return the middles of the triangles' cells as barycentric coordinates, and which lay inside of themselves."""
    first = np.cumsum(counts) - counts
    number = np.arange(int(counts.sum())) - np.repeat(first, counts)
    columns = np.repeat(outline.sizes[triangles, 0], counts)
    rows = np.repeat(outline.sizes[triangles, 1], counts)
    foot = np.repeat(outline.foot[triangles], counts)
    row = number // columns
    height = (row + 0.5) / rows
    along = (number - row * columns + 0.5) / columns
    lowest, highest = height * foot, 1.0 - height * (1.0 - foot)
    inside = (along >= lowest) & (along <= highest)
    along = np.minimum(np.maximum(along, lowest), highest)
    shares = np.empty((len(number), 3))
    base = np.repeat(outline.base[triangles], counts)
    at = np.arange(len(number))
    shares[at, base] = highest - along
    shares[at, (base + 1) % 3] = along - lowest
    shares[at, (base + 2) % 3] = height
    return shares, inside


def _colours(
    coat: Coat, paint: Paint, texture: Texture | None, triangles: NDArray[np.intp], shares: NDArray[np.float64]
) -> NDArray[np.float64]:
    uv = np.einsum("nk,nkc->nc", shares, coat.uv[triangles])
    mixed = np.einsum("nk,nkc->nc", shares, coat.colours[triangles].astype(np.float64))
    return shade(paint, texture, uv, mixed)


def _materials(scene: Scene, cells: list[_Cells], colours: int) -> tuple[tuple[Material, ...], list[NDArray[np.uint8]]]:
    """Return the scene's materials with a palette appended, and the cells' ids, mesh by mesh."""
    solid = np.concatenate([one.solid for one in cells])
    owners = np.concatenate([one.owners for one in cells])[solid]
    weights = np.concatenate([one.weights for one in cells])[solid].astype(np.float64)
    mirrors = np.array([material.mirror for material in scene.materials])[owners]
    kinds = max(1, len(np.unique(mirrors)))
    free = _free_ids(scene)
    if len(free) < kinds:
        raise DoesNotFitError(
            f"{scene.name}: the scene's own materials leave none of the {MATERIAL_LIMIT} to its painted surfaces; "
            "merge some in the asset"
        )
    found = np.concatenate([one.colours for one in cells])[solid]
    palette, rows = quantize(found, weights, min(colours, len(free) // kinds))
    entries = rows.astype(np.intp) * 2 + mirrors
    cover = np.bincount(entries * 256 + owners, weights + 1e-12, minlength=len(palette) * 512).reshape(-1, 256)
    materials = dict(enumerate(scene.materials))
    ids = np.zeros(2 * len(palette), np.uint8)
    used = np.flatnonzero(cover.any(axis=1))
    most = cover[used].argmax(axis=1)
    for entry, owner in sorted(zip(used.tolist(), most.tolist(), strict=True), key=lambda one: (one[1], one[0])):
        red, green, blue = palette[entry // 2].tolist()
        named = scene.materials[owner]
        ids[entry] = owner if named.colour == (red, green, blue) else free.pop(0)
        if ids[entry] != owner:
            name = f"{named.name} #{red:02x}{green:02x}{blue:02x}"
            materials[int(ids[entry])] = Material(name, (red, green, blue), named.mirror)
    worn = np.zeros(len(solid), np.uint8)
    worn[solid] = ids[entries]
    return tuple(materials.values()), np.split(worn, np.cumsum([len(one.solid) for one in cells])[:-1])


def _inner(frame: _Frame, worn: NDArray[np.uint8], cells: _Cells) -> NDArray[np.uint8]:
    """Return the materials of a mesh's triangles where they have one each: its inside takes the first of them."""
    cover = np.bincount(worn, cells.weights + np.float32(1e-12), minlength=256)
    most = int(cover[1:].argmax()) + 1
    if not cover[most]:  # all is cut away
        return frame.mesh.materials
    return np.where(frame.coat.rows >= 0, np.uint8(most), frame.mesh.materials)


def _free_ids(scene: Scene) -> list[int]:
    """Return the ids behind the scene's materials, then those that it left out between them."""
    used = {item.collider_material for item in scene.objects}
    for mesh in {id(item.mesh): item.mesh for item in scene.objects}.values():
        used.update(np.unique(mesh.materials).tolist())
    gaps = [number for number, one in enumerate(scene.materials) if not one.authored and number not in used]
    return [*range(len(scene.materials), MATERIAL_LIMIT + 1), *gaps]
