"""Solids to build scenes from: primitives, booleans and hulls, each surface remembering its material.

The geometry is manifold3d's: every solid is closed, and a boolean of closed solids is closed again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

import manifold3d
import numpy as np

from voxrt.voxelize import primitives

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

Axis: TypeAlias = Literal["x", "y", "z"]


FARTHEST = 1e9
"""Metres: no scene goes beyond, and products of three lengths stay finite."""


class SolidError(ValueError):
    """Measures or a surface of which no solid can be made; one line, without full stop."""


@dataclass(frozen=True, eq=False, slots=True)
class Solid:
    """A closed solid in metres. Operators: ``a | b`` union, ``a - b`` difference, ``a & b`` intersection.

    Make one with :func:`box`, :func:`sphere`, :func:`cylinder`, :func:`cone`, :func:`extrude`, :func:`hull` or
    :func:`closed`. A cut face takes the material of the solid that cut it.
    """

    _manifold: manifold3d.Manifold
    _materials: dict[int, str | None]

    def __or__(self, other: Solid) -> Solid:
        return Solid(self._manifold + other._manifold, self._materials | other._materials)

    def __sub__(self, other: Solid) -> Solid:
        return Solid(self._manifold - other._manifold, self._materials | other._materials)

    def __and__(self, other: Solid) -> Solid:
        return Solid(self._manifold ^ other._manifold, self._materials | other._materials)

    def of(self, material: str) -> Solid:
        """Return the solid with `material` where it has none yet."""
        return Solid(self._manifold, {key: material if old is None else old for key, old in self._materials.items()})

    def placed(
        self,
        translate: Sequence[float] = (0, 0, 0),
        rotate: Sequence[float] = (0, 0, 0),
        scale: float | Sequence[float] = 1,
    ) -> Solid:
        """Return the solid scaled, then turned, then moved; see :func:`placement`."""
        return self.transformed(placement(translate, rotate, scale))

    def transformed(self, matrix: NDArray[np.float64]) -> Solid:
        """Return the solid moved by `matrix` (float64, shape (4, 4), affine, column vectors)."""
        if np.array_equal(matrix, np.eye(4)):
            return self
        return Solid(self._manifold.transform(np.ascontiguousarray(matrix[:3])), self._materials)

    @classmethod
    def around(cls, solids: Sequence[Solid], material: str | None = None) -> Solid:
        """Return the convex hull around `solids`."""
        return _original(manifold3d.Manifold.batch_hull([one._manifold for one in solids]), material)  # noqa: SLF001 -- its own class's

    @property
    def volume(self) -> float:
        """Cubic metres."""
        return float(self._manifold.volume())

    def surface(self) -> tuple[NDArray[np.float64], NDArray[np.int32], list[tuple[str | None, int]]]:
        """Return the boundary.

        Returns
        -------
        positions
            float64, shape (V, 3).
        triangles
            int32, shape (T, 3), counter-clockwise seen from outside.
        runs
            (material, count): the materials of the triangles in their order; None where none was given.

        Raises
        ------
        SolidError
            There is nothing left of it.
        """
        if self._manifold.is_empty():
            raise SolidError("nothing is left of the solid")
        mesh = self._manifold.to_mesh64()
        triangles = mesh.tri_verts.astype(np.int32)
        same = np.arange(len(mesh.vert_properties), dtype=np.int32)
        same[mesh.merge_from_vert] = np.asarray(mesh.merge_to_vert, dtype=np.int32)
        counts = np.diff(np.asarray(mesh.run_index, dtype=np.int64)) // 3
        runs = [
            (self._materials[key], int(count))
            for key, count in zip(mesh.run_original_id, counts.tolist(), strict=True)
            if count
        ]
        return np.ascontiguousarray(mesh.vert_properties[:, :3]), same[triangles], runs


def placement(
    translate: Sequence[float] = (0, 0, 0), rotate: Sequence[float] = (0, 0, 0), scale: float | Sequence[float] = 1
) -> NDArray[np.float64]:
    """Return the matrix that scales, then turns, then moves: float64, shape (4, 4), column vectors.

    Parameters
    ----------
    translate
        Metres along x, y and z.
    rotate
        Degrees about x, then y, then z, each counter-clockwise seen against the axis. Quarter turns are exact.
    scale
        One factor, or one an axis; a negative one mirrors.

    Raises
    ------
    SolidError
        A scale of 0, or of two numbers.
    """
    factors = np.asarray(scale, dtype=np.float64)
    if factors.shape not in ((), (3,)) or not factors.all():
        raise SolidError(f"scale {factors.tolist()} is not one number or three, none of them 0")
    for name, values in (("translate", translate), ("rotate", rotate), ("scale", np.atleast_1d(factors))):
        if not (np.abs(np.asarray(values, dtype=np.float64)) <= FARTHEST).all():
            raise SolidError(f"{name} {np.asarray(values).tolist()} goes beyond {FARTHEST:g}")
    turn = np.eye(3)
    for axis, degrees in enumerate(rotate):
        cosine, sine = _exact_cosine(degrees), _exact_cosine(degrees - 90)
        one = np.eye(3)
        after, last = (axis + 1) % 3, (axis + 2) % 3
        one[[after, after, last, last], [after, last, after, last]] = cosine, -sine, sine, cosine
        turn = one @ turn
    matrix = np.eye(4)
    matrix[:3, :3] = turn * np.broadcast_to(factors, 3)
    matrix[:3, 3] = translate
    return matrix


def box(size: ArrayLike, *, centre: ArrayLike = (0, 0, 0), material: str | None = None) -> Solid:
    """Return a box of `size` metres along x, y and z."""
    sides = _lengths("size", size, 3)
    positions, triangles = primitives.cube(1.0)
    return _made(positions * sides + np.asarray(centre, dtype=np.float64), triangles, material)


def box_between(minimum: ArrayLike, maximum: ArrayLike, *, material: str | None = None) -> Solid:
    """Return the box from corner `minimum` to corner `maximum`, which it meets exactly."""
    low, high = np.asarray(minimum, dtype=np.float64), np.asarray(maximum, dtype=np.float64)
    _lengths("size", high - low, 3)
    positions, triangles = primitives.cube(2.0)
    return _made(np.where(positions > 0, high, low), triangles, material)


def sphere(radius: float, *, centre: ArrayLike = (0, 0, 0), material: str | None = None) -> Solid:
    """Return a ball of `radius` metres."""
    positions, triangles = primitives.sphere(_length("radius", radius))
    return _made(positions + np.asarray(centre, dtype=np.float64), triangles, material)


def cylinder(
    radius: float, height: float, *, axis: Axis = "y", centre: ArrayLike = (0, 0, 0), material: str | None = None
) -> Solid:
    """Return a cylinder along `axis`."""
    across, along = _length("radius", radius), _length("height", height)
    positions, triangles = primitives.cylinder(across, across, along, axis.upper())
    return _made(positions + np.asarray(centre, dtype=np.float64), triangles, material)


def cone(
    radius: float, height: float, *, axis: Axis = "y", centre: ArrayLike = (0, 0, 0), material: str | None = None
) -> Solid:
    """Return a cone along `axis`, tip towards its positive end; `centre` is half way up."""
    positions, triangles = primitives.cone(_length("radius", radius), _length("height", height), axis.upper())
    return _made(positions + np.asarray(centre, dtype=np.float64), triangles, material)


def extrude(outline: ArrayLike, height: float, *, axis: Axis = "y", material: str | None = None) -> Solid:
    """Return a prism over `outline`, from 0 to `height` along `axis`.

    Parameters
    ----------
    outline
        Shape (N, 2), metres, either way round: (y, z) for the x axis, (x, z) for y, (x, y) for z. Where it crosses
        itself, what it goes around an odd number of times is inside.
    """
    points = np.asarray(outline, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3 or not (np.abs(points) <= FARTHEST).all():
        raise SolidError("an outline needs three points of two numbers or more")
    flat = manifold3d.CrossSection([points], manifold3d.FillRule.EvenOdd)
    prism = manifold3d.Manifold.extrude(flat, _length("height", height))
    # Rows: where the outline's two coordinates and the height go; each mirrors nothing or is turned back below.
    columns = {"x": [1, 2, 0], "y": [0, 2, 1], "z": [0, 1, 2]}[axis]
    matrix = np.zeros((3, 4))
    matrix[columns, [0, 1, 2]] = 1.0
    return _original(prism.transform(matrix), material)


def hull(solids: Sequence[Solid], *, material: str | None = None) -> Solid:
    """Return the convex hull around `solids`."""
    return Solid.around(solids, material)


def closed(positions: NDArray[np.floating], triangles: NDArray[np.int32], material: str | None = None) -> Solid:
    """Return the solid that a closed surface encloses.

    Raises
    ------
    SolidError
        The surface has holes, or edges with more than two faces.
    """
    return _made(positions, triangles, material)


def _made(positions: NDArray[np.floating], triangles: NDArray[np.int32], material: str | None) -> Solid:
    mesh = manifold3d.Mesh64(np.ascontiguousarray(positions, dtype=np.float64), triangles.astype(np.uint64))
    mesh.merge()
    made = manifold3d.Manifold(mesh)
    if made.status() != manifold3d.Error.NoError:
        raise SolidError(f"the surface is not closed ({made.status().name})")
    return _original(made, material)


def _original(made: manifold3d.Manifold, material: str | None) -> Solid:
    original = made.as_original()
    return Solid(original, {original.original_id(): material})


def _exact_cosine(degrees: float) -> float:
    quarter, rest = divmod(degrees % 360.0, 90.0)
    if rest == 0:
        return (1.0, 0.0, -1.0, 0.0)[int(quarter) % 4]
    return float(np.cos(np.deg2rad(degrees)))


def _length(name: str, value: float) -> float:
    return float(_lengths(name, [value], 1)[0])


def _lengths(name: str, values: ArrayLike, count: int) -> NDArray[np.float64]:
    lengths = np.asarray(values, dtype=np.float64)
    if lengths.shape != (count,) or not ((lengths > 0) & (lengths <= FARTHEST)).all():
        many = f"{count} positive lengths" if count > 1 else "a positive length"
        raise SolidError(f"{name} {np.asarray(values).tolist()} is not {many}")
    return lengths
