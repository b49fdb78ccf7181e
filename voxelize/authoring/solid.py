"""Solids: primitives, booleans and hulls, whose surfaces keep their materials.

manifold3d does the geometry: every solid is closed, and a boolean of closed solids is closed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import manifold3d
import numpy as np

from voxrt.voxelize import arguments, primitive_meshes
from voxrt.voxelize.authoring.transforms import FARTHEST, SolidError, placement
from voxrt.voxelize.mesh import checked_surface
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

Axis: TypeAlias = Literal["x", "y", "z"]

_AXES: tuple[Axis, ...] = ("x", "y", "z")


class Solid(Value, frozen=True, eq=False):
    """A closed solid in metres. Operators: ``a | b`` union, ``a - b`` difference, ``a & b`` intersection.

    :func:`box`, :func:`sphere`, :func:`cylinder`, :func:`cone`, :func:`extrude`, :func:`hull` and :func:`closed` make
    solids. A cut face takes the material of the solid that cut it.

    Examples
    --------
    >>> well = cylinder(1, 1.5, material="stone") - box((1, 2, 1), material="brick")
    >>> round(well.volume, 2)
    3.21
    >>> sorted({material for material, _ in well.surface()[2]})
    ['brick', 'stone']
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
        """Return the solid with `material` on the surfaces that have none."""
        return Solid(self._manifold, {key: material if old is None else old for key, old in self._materials.items()})

    def placed(
        self,
        translate: Sequence[float] = (0, 0, 0),
        rotate: Sequence[float] = (0, 0, 0),
        scale: float | Sequence[float] = 1,
    ) -> Solid:
        """Return the solid scaled, then rotated, then moved, as :func:`placement` describes."""
        return self.transformed(placement(translate, rotate, scale))

    def transformed(self, matrix: NDArray[np.float64]) -> Solid:
        """Return the solid transformed by `matrix` (shape (4, 4), affine, column vectors)."""
        if np.array_equal(matrix, np.eye(4)):
            return self
        return Solid(self._manifold.transform(np.ascontiguousarray(matrix[:3])), self._materials)

    @classmethod
    def around(cls, solids: Sequence[Solid], material: str | None = None) -> Solid:
        """Return the convex hull of `solids`."""
        return _original(manifold3d.Manifold.batch_hull([one._manifold for one in solids]), material)  # noqa: SLF001 -- its own class's

    @property
    def volume(self) -> float:
        """The volume in cubic metres."""
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
            (material, count) of consecutive triangles; None for triangles without a material.

        Raises
        ------
        SolidError
            The solid is empty.
        """
        if self._manifold.is_empty():
            raise SolidError("the solid is empty")
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


def box(size: ArrayLike, *, centre: ArrayLike = (0, 0, 0), material: str | None = None) -> Solid:
    """Return a box.

    Parameters
    ----------
    size
        Metres along x, y and z.
    centre
        Metres: the middle of the box.
    material
        The name of its material; None for none yet.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong kind or shape.
    SolidError
        A size that is not positive.

    Examples
    --------
    >>> box((1, 2, 3)).volume
    6.0
    """
    sides = _lengths("size", size, 3)
    positions, triangles = primitive_meshes.cube(1.0)
    return _made(positions * sides + _point("centre", centre), triangles, material)


def box_between(minimum: ArrayLike, maximum: ArrayLike, *, material: str | None = None) -> Solid:
    """Return the box between two corners, whose coordinates it has exactly.

    Parameters
    ----------
    minimum, maximum
        Metres: the lowest and the highest corner.
    material
        As for :func:`box`.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong kind or shape.
    SolidError
        A side that is not positive.

    Examples
    --------
    >>> box_between((0, 0, 0), (0.1, 0.2, 0.3)).surface()[0].max(axis=0)
    array([0.1, 0.2, 0.3])
    """
    low, high = _point("minimum", minimum), _point("maximum", maximum)
    _lengths("size", high - low, 3)
    positions, triangles = primitive_meshes.cube(2.0)
    return _made(np.where(positions > 0, high, low), triangles, material)


def sphere(radius: float, *, centre: ArrayLike = (0, 0, 0), material: str | None = None) -> Solid:
    """Return a ball.

    Parameters
    ----------
    radius
        Metres.
    centre, material
        As for :func:`box`.

    Examples
    --------
    >>> sphere(1, centre=(0, 5, 0)).surface()[0].max(axis=0)
    array([1., 6., 1.])
    """
    positions, triangles = primitive_meshes.sphere(_length("radius", radius))
    return _made(positions + _point("centre", centre), triangles, material)


def cylinder(
    radius: float, height: float, *, axis: Axis = "y", centre: ArrayLike = (0, 0, 0), material: str | None = None
) -> Solid:
    """Return a cylinder.

    Parameters
    ----------
    radius, height
        Metres.
    axis
        ``"x"``, ``"y"`` or ``"z"``.
    centre, material
        As for :func:`box`; `centre` is half way up.

    Examples
    --------
    >>> cylinder(1, 3, axis="z").surface()[0].max(axis=0)
    array([1. , 1. , 1.5])
    """
    across, along = _length("radius", radius), _length("height", height)
    positions, triangles = primitive_meshes.cylinder(across, across, along, _axis(axis).upper())
    return _made(positions + _point("centre", centre), triangles, material)


def cone(
    radius: float, height: float, *, axis: Axis = "y", centre: ArrayLike = (0, 0, 0), material: str | None = None
) -> Solid:
    """Return a cone whose tip points to the positive end of `axis`.

    Parameters
    ----------
    radius, height
        Metres.
    axis
        ``"x"``, ``"y"`` or ``"z"``.
    centre, material
        As for :func:`box`; `centre` is half way up.

    Examples
    --------
    >>> cone(1, 2).surface()[0].max(axis=0)
    array([1., 1., 1.])
    """
    positions, triangles = primitive_meshes.cone(
        _length("radius", radius), _length("height", height), _axis(axis).upper()
    )
    return _made(positions + _point("centre", centre), triangles, material)


def extrude(outline: ArrayLike, height: float, *, axis: Axis = "y", material: str | None = None) -> Solid:
    """Return a prism over `outline`, from 0 to `height` along `axis`.

    Parameters
    ----------
    outline
        Shape (N, 2), N ≥ 3, metres, in either orientation: (y, z) for the x axis, (x, z) for y, (x, y) for z. An
        outline that crosses itself fills by the even-odd rule.
    height
        Metres.
    axis
        ``"x"``, ``"y"`` or ``"z"``.
    material
        As for :func:`box`.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong kind or shape.
    SolidError
        Fewer than three points, a point beyond :data:`FARTHEST`, or a height that is not positive.

    Examples
    --------
    >>> extrude([(0, 0), (4, 0), (0, 3)], 2).volume
    12.0
    """
    points = arguments.real_array("outline", outline, ("N", 2)).astype(np.float64, copy=False)
    if len(points) < 3 or not (np.abs(points) <= FARTHEST).all():
        raise SolidError(f"an outline needs three points or more, and no coordinate beyond {FARTHEST:g}")
    flat = manifold3d.CrossSection([points], manifold3d.FillRule.EvenOdd)
    prism = manifold3d.Manifold.extrude(flat, _length("height", height))
    # The rows to which the outline's two coordinates and the height go.
    columns = {"x": [1, 2, 0], "y": [0, 2, 1], "z": [0, 1, 2]}[_axis(axis)]
    matrix = np.zeros((3, 4))
    matrix[columns, [0, 1, 2]] = 1.0
    return _original(prism.transform(matrix), material)


def hull(solids: Sequence[Solid], *, material: str | None = None) -> Solid:
    """Return the convex hull of solids.

    Examples
    --------
    >>> hull([box((1, 1, 1)), box((1, 1, 1), centre=(3, 0, 0))]).volume
    4.0
    """
    return Solid.around(solids, material)


def closed(positions: ArrayLike, triangles: ArrayLike, material: str | None = None) -> Solid:
    """Return the solid that a closed surface encloses.

    Parameters
    ----------
    positions, triangles
        As in :class:`voxrt.voxelize.Mesh`.
    material
        As for :func:`box`.

    Raises
    ------
    TypeError, ValueError
        An array of the wrong kind, shape or range.
    SolidError
        The surface has holes, or edges with more than two faces.

    Examples
    --------
    >>> closed([[0, 0, 0], [3, 0, 0], [0, 2, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]).volume
    1.0
    """
    return _made(*checked_surface("closed", positions, triangles), material)


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


def _axis(axis: Axis) -> Axis:
    return arguments.choice("axis", axis, _AXES)


def _point(name: str, value: ArrayLike) -> NDArray[np.float64]:
    return np.array(arguments.vector(name, value))


def _length(name: str, value: float) -> float:
    return float(_lengths(name, [arguments.real(name, value)], 1)[0])


def _lengths(name: str, values: ArrayLike, count: int) -> NDArray[np.float64]:
    lengths = arguments.real_array(name, values, (count,)).astype(np.float64, copy=False)
    if not ((lengths > 0) & (lengths <= FARTHEST)).all():
        many = f"{count} positive lengths" if count > 1 else "a positive length"
        raise SolidError(
            f"{name} {lengths.tolist() if count > 1 else lengths[0]:} is not {many} of at most {FARTHEST:g} m"
        )
    return lengths
