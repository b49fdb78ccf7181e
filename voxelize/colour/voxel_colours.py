"""Colours per voxel: one palette for the textures and vertex colours of a scene, as finely as a grid can show them.

Each triangle with an appearance gets a raster whose cells are about one voxel wide. Its columns run along one side of
the triangle, its rows towards the opposite corner, so there are about two cells per covered voxel, also on slivers. A
cell has the colour of the appearance at its centre; finer textures are reduced first. All cells of the scene share one
palette. The voxelizer gives each voxel of the shell the material of the cell nearest to its centre
(src/material_raster.h).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import arguments
from voxrt.voxelize.colour.appearance import shade
from voxrt.voxelize.colour.palette import quantize
from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.colour.texture import Texture, halved
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.grid import Grid
from voxrt.voxelize.materials import MATERIAL_LIMIT, Material
from voxrt.voxelize.mesh import MaterialMap
from voxrt.voxelize.object_proxies import GEOMETRIES, proxies
from voxrt.voxelize.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
    from voxrt.voxelize.mesh import Mesh
    from voxrt.voxelize.object_proxies import Geometry

DEFAULT_COLOURS = 32
"""The default number of colours for all textures and vertex colours of a scene. Pictures of test models with 32 colours
differ from those with 254 by 45 to 63 dB (38 dB for a photograph); 64 colours gain 2 to 4 dB and cost up to a quarter
more memory words."""

_MOST_CELLS = 1 << 23
_LONGEST = 1 << 16
_CHUNK = 1 << 18
_RIGHT = 1e-6


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
    meshes = _varied_meshes(scene, grid, geometry)
    if not meshes:
        return scene
    outlines = _outlines(meshes.values())
    reduced: dict[tuple[int, int], Texture] = {}
    cells = [_cells_of(one, outline, reduced) for one, outline in zip(meshes.values(), outlines, strict=True)]
    materials, cell_ids = _materials(scene, cells, colours)
    mapped = {
        key: replace(
            varied.mesh,
            materials=_uniform_materials(varied, ids, own_cells),
            material_map=MaterialMap(outline.sizes, outline.corners.astype(np.float32), ids),
        )
        for (key, varied), outline, own_cells, ids in zip(meshes.items(), outlines, cells, cell_ids, strict=True)
    }
    objects = tuple(replace(item, mesh=mapped.get(id(item.mesh), item.mesh)) for item in scene.objects)
    return replace(scene, objects=objects, materials=materials)


@dataclass(eq=False, slots=True)
class _VariedMesh:
    """A mesh whose colours vary over triangles.

    Attributes
    ----------
    mesh, appearance
        The mesh and its appearance.
    linear
        float64, shape (3, 3): the linear part from its frame to voxels, of the object that shows it largest.
    objects
        The number of objects that show it.
    """

    mesh: Mesh
    appearance: SurfaceAppearance
    linear: NDArray[np.float64]
    objects: int = 0


def _varied_meshes(scene: Scene, grid: Grid, geometry: Geometry) -> dict[int, _VariedMesh]:
    meshes: dict[int, _VariedMesh] = {}
    for item in scene.objects:
        if item.mesh.appearance is None or proxies(item, geometry) is not None:
            continue
        linear = item.transform[:3, :3] / grid.voxel_size
        varied = meshes.setdefault(id(item.mesh), _VariedMesh(item.mesh, item.mesh.appearance, linear))
        varied.objects += 1
        if np.abs(linear).sum() > np.abs(varied.linear).sum():
            varied.linear = linear
    return meshes


@dataclass(eq=False, slots=True)
class _Outline:
    """The placement of a mesh's triangles in their rasters.

    Attributes
    ----------
    lengths
        float64, shape (T, 2): the side along the columns and the height above it, voxels.
    base
        intp, shape (T,): the corner at which that side begins.
    foot
        float64, shape (T,): where the height stands on it, 0 … 1.
    sizes, corners
        As in :class:`MaterialMap`.
    """

    lengths: NDArray[np.float64]
    base: NDArray[np.intp]
    foot: NDArray[np.float64]
    sizes: NDArray[np.int32]
    corners: NDArray[np.float64]


def _outlines(meshes: Iterable[_VariedMesh]) -> list[_Outline]:
    outlines = [_outline(varied) for varied in meshes]
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
        outline.corners[rows, second, 0] = outline.sizes[:, 0]
        outline.corners[rows, apex, 0] = outline.foot * outline.sizes[:, 0]
        outline.corners[rows, apex, 1] = outline.sizes[:, 1]
    return outlines


def _outline(varied: _VariedMesh) -> _Outline:
    with np.errstate(over="ignore", invalid="ignore"):
        corners = (varied.mesh.positions @ varied.linear.T)[varied.mesh.triangles]
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
    mapped = (varied.appearance.rows >= 0)[:, None]
    sizes = np.where(mapped, 1, 0).astype(np.int32) * np.ones((1, 2), np.int32)
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


def _cells_of(varied: _VariedMesh, outline: _Outline, reduced: dict[tuple[int, int], Texture]) -> _Cells:
    counts = np.prod(outline.sizes, axis=1, dtype=np.int64)
    starts = np.cumsum(counts) - counts
    total = int(counts.sum())
    cells = _Cells(
        np.empty((total, 3), np.uint8),
        np.empty(total, np.bool_),
        np.empty(total, np.float32),
        np.repeat(varied.mesh.materials, counts),
    )
    areas = np.prod(outline.lengths, axis=1) / np.maximum(counts, 1) * varied.objects
    for row, appearance in enumerate(varied.appearance.entries):
        members = np.flatnonzero(varied.appearance.rows == row)
        steps = _steps(appearance, varied.appearance, outline, members)
        for step in np.unique(steps).tolist():
            texture = _reduced_texture(appearance, step, reduced)
            for some in _chunks(members[steps == step], counts):
                shares, inside = _centres(outline, some, counts[some])
                colours = _colours(varied.appearance, appearance, texture, np.repeat(some, counts[some]), shares)
                at = np.arange(len(shares)) + np.repeat(
                    starts[some] - (np.cumsum(counts[some]) - counts[some]), counts[some]
                )
                cells.colours[at] = srgb_from_linear(colours[:, :3])
                cells.solid[at] = colours[:, 3] >= appearance.cutoff if appearance.cutoff > 0 else True
                cells.weights[at] = np.repeat(areas[some], counts[some]) * inside
    return cells


def _steps(
    appearance: Appearance, surface: SurfaceAppearance, outline: _Outline, members: NDArray[np.intp]
) -> NDArray[np.int64]:
    """Return the width of each triangle's cells in pixels of the texture, rounded down to a power of two."""
    if appearance.texture is None:
        return np.ones(len(members), np.int64)
    height, width = appearance.texture.pixels.shape[:2]
    with np.errstate(over="ignore", invalid="ignore"):
        uv = surface.uv[members] * (width, height)
        one, other = uv[:, 1] - uv[:, 0], uv[:, 2] - uv[:, 0]
        pixels = np.abs(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])
    across = np.sqrt(np.nan_to_num(pixels) / np.prod(outline.sizes[members], axis=1, dtype=np.int64))
    largest = max(width, height)
    found: NDArray[np.int64] = 1 << np.floor(np.log2(np.clip(across, 1, largest))).astype(np.int64)
    return found


def _reduced_texture(appearance: Appearance, step: int, reduced: dict[tuple[int, int], Texture]) -> Texture | None:
    """Return an appearance's texture with `step` pixels averaged into one; `reduced` keeps it for other meshes."""
    if appearance.texture is None or step == 1:
        return appearance.texture
    key = id(appearance.texture), step
    if key not in reduced:
        finer = _reduced_texture(appearance, step // 2, reduced)
        assert finer is not None
        reduced[key] = halved(finer)
    return reduced[key]


def _chunks(triangles: NDArray[np.intp], counts: NDArray[np.int64]) -> Iterator[NDArray[np.intp]]:
    """Cut triangles into runs of about :data:`_CHUNK` cells."""
    ends = np.cumsum(counts[triangles])
    cuts = np.searchsorted(ends, np.arange(_CHUNK, int(ends[-1]) if len(ends) else 0, _CHUNK))
    yield from (some for some in np.split(triangles, np.unique(cuts)) if len(some))


def _centres(
    outline: _Outline, triangles: NDArray[np.intp], counts: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Return the cells' centres, moved into their triangles (barycentric coordinates), and which needed no move."""
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
    surface: SurfaceAppearance,
    appearance: Appearance,
    texture: Texture | None,
    triangles: NDArray[np.intp],
    shares: NDArray[np.float64],
) -> NDArray[np.float64]:
    uv = np.einsum("nk,nkc->nc", shares, surface.uv[triangles])
    mixed = np.einsum("nk,nkc->nc", shares, surface.colours[triangles].astype(np.float64))
    return shade(appearance, texture, uv, mixed)


def _materials(scene: Scene, cells: list[_Cells], colours: int) -> tuple[tuple[Material, ...], list[NDArray[np.uint8]]]:
    """Return the scene's materials with the palette appended, and the material ids of the cells, mesh by mesh."""
    solid = np.concatenate([one.solid for one in cells])
    owners = np.concatenate([one.owners for one in cells])[solid]
    weights = np.concatenate([one.weights for one in cells])[solid].astype(np.float64)
    mirrors = np.array([material.mirror for material in scene.materials])[owners]
    kinds = max(1, len(np.unique(mirrors)))
    free = _free_ids(scene)
    if len(free) < kinds:
        raise DoesNotFitError(
            f"{scene.name}: its own materials take all {MATERIAL_LIMIT} ids and leave none for textures and vertex "
            "colours; merge some in the asset"
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
    of_cells = np.zeros(len(solid), np.uint8)
    of_cells[solid] = ids[entries]
    return tuple(materials.values()), np.split(of_cells, np.cumsum([len(one.solid) for one in cells])[:-1])


def _uniform_materials(varied: _VariedMesh, ids: NDArray[np.uint8], cells: _Cells) -> NDArray[np.uint8]:
    """Return one material per triangle: the inside of an object takes that of its first triangle."""
    cover = np.bincount(ids, cells.weights + np.float32(1e-12), minlength=256)
    most = int(cover[1:].argmax()) + 1
    if not cover[most]:  # all is cut away
        return varied.mesh.materials
    return np.where(varied.appearance.rows >= 0, np.uint8(most), varied.mesh.materials)


def _free_ids(scene: Scene) -> list[int]:
    """Return the ids above the scene's materials, then unused ids among them."""
    used = {item.collider_material for item in scene.objects}
    for mesh in {id(item.mesh): item.mesh for item in scene.objects}.values():
        used.update(np.unique(mesh.materials).tolist())
    gaps = [number for number, one in enumerate(scene.materials) if not one.authored and number not in used]
    return [*range(len(scene.materials), MATERIAL_LIMIT + 1), *gaps]
