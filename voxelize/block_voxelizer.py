"""Scenes whose voxels do not fit the memory at once: voxelized in squares of columns."""

from __future__ import annotations

from copy import copy
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from voxrt.voxelize import _native, arguments
from voxrt.voxelize.scene_parts import SceneParts, unreachable
from voxrt.voxelize.voxelizer import MOST_THREADS, voxels_of
from voxrt.voxelize.voxels import VoxelizationReport

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from voxrt.voxelize.box_rounding import Pow2
    from voxrt.voxelize.grid import Grid
    from voxrt.voxelize.object_proxies import Geometry
    from voxrt.voxelize.rules import ObjectFill, Rule, Thin
    from voxrt.voxelize.scene import Scene
    from voxrt.voxelize.voxels import Voxels

TALLIES = 6
"""The counts of an object that squares add up to: a row of tallies."""


class ColumnBlock(NamedTuple):
    """A square of columns over the grid's whole height.

    Attributes
    ----------
    x, y
        Its lowest column, in voxels along the grid's axes.
    side
        Columns per side.

    Examples
    --------
    >>> ColumnBlock(x=0, y=512, side=256).side
    256
    """

    x: int
    y: int
    side: int


class BlockVoxelizer:
    """A scene that is ready to be voxelized, one square of columns at a time and in any order.

    What is done for all squares together, the analysis of the meshes and the binning of their triangles, is done once,
    when it is first needed.

    Parameters
    ----------
    scene, grid, fill, rule, thin, geometry, pow2, threads
        As :func:`voxrt.voxelize.voxelize` takes them.
    objects
        Numbers of the objects to voxelize, for squares that no other object reaches; None for all.

    Raises
    ------
    TypeError, ValueError, AssetError, DoesNotFitError
        As :func:`voxrt.voxelize.voxelize` does.

    Examples
    --------
    >>> from voxrt.voxelize import BlockVoxelizer, fit_grid, load
    >>> scene = load("examples/house.obj")
    >>> voxelizer = BlockVoxelizer(scene, fit_grid(scene, depth=7))
    >>> blocks = voxelizer.blocks(64)
    >>> blocks[:2]
    (ColumnBlock(x=0, y=0, side=64), ColumnBlock(x=64, y=0, side=64))
    >>> voxels, tallies = voxelizer.voxelize(blocks[0])
    >>> tallies.shape
    (5, 6)
    """

    def __init__(
        self,
        scene: Scene,
        grid: Grid,
        *,
        fill: ObjectFill = "solid",
        rule: Rule = "touch",
        thin: Thin = "keep",
        geometry: Geometry = "auto",
        pow2: Pow2 = "box",
        threads: int = 0,
        objects: Iterable[int] | None = None,
    ) -> None:
        threads = arguments.whole("threads", threads, 0, MOST_THREADS)
        self._parts = SceneParts(scene, grid, fill=fill, rule=rule, thin=thin, geometry=geometry, pow2=pow2)
        self._arrays = self._parts.arrays()
        self._threads = threads
        self._objects = None if objects is None else tuple(objects)

    def restricted(self, objects: Iterable[int]) -> BlockVoxelizer:
        """Return a voxelizer of the same scene for squares that no other object than these reaches."""
        made = copy(self)
        made.__dict__.pop("_native", None)
        made._objects = tuple(objects)  # noqa: SLF001 - one of us
        return made

    def prepare(self) -> None:
        """Analyse the meshes and bin their triangles now."""
        _ = self._native

    def use_threads(self, threads: int) -> None:
        """Use so many threads from now on; 0 takes as many as the machine has."""
        self._threads = arguments.whole("threads", threads, 0, MOST_THREADS)
        self._native.use_threads(self._threads)

    @cached_property
    def _native(self) -> _native.BlockVoxelizer:
        wanted = np.zeros(0 if self._objects is None else len(self._parts.scene.objects), np.uint8)
        if self._objects is not None:
            wanted[list(self._objects)] = 1
        try:
            parts = _native.SceneParts(**self._arrays)
            return _native.BlockVoxelizer(parts, **self._parts.choices, threads=self._threads, wanted=wanted)
        except _native.OutOfRangeError as error:
            raise unreachable(self._parts.scene, int(error.args[0])) from None

    @property
    def key(self) -> str:
        """A digest of all that decides the voxels, as 32 hexadecimal digits."""
        from hashlib import blake2b  # noqa: PLC0415 - slow to import, and most builds have no tiles

        digest = blake2b(digest_size=16)
        for argument in (*self._parts.choices.values(), *self._arrays.values()):
            _feed(digest, argument)
        return digest.hexdigest()

    def blocks(self, side: int) -> tuple[ColumnBlock, ...]:
        """Return the squares with geometry, in Morton order.

        Parameters
        ----------
        side
            Columns per side of a square, a multiple of 64.
        """
        side = arguments.whole("side", side, 64, 1 << 16)
        return tuple(ColumnBlock(int(x), int(y), side) for x, y in self._native.blocks(side))

    def objects_of(self, block: ColumnBlock) -> tuple[int, ...]:
        """Return the numbers of the objects that may have a voxel in a square."""
        return tuple(int(one) for one in np.flatnonzero(self._native.objects_of(*block)))

    def voxelize(self, block: ColumnBlock) -> tuple[Voxels, NDArray[np.int64]]:
        """Voxelize a square.

        Returns
        -------
        voxels
            Its voxels.
        tallies
            What it found of each object, for :meth:`report`: int64, shape (O, 6).
        """
        result = self._native.block(*block)
        return voxels_of(self._parts.grid.depth, result), result.object_tallies

    def report(self, tallies: NDArray[np.int64]) -> VoxelizationReport:
        """Tell what became of the objects.

        Parameters
        ----------
        tallies
            The sum of the tallies of all squares, whichever process made them.
        """
        result = self._native.report(np.ascontiguousarray(tallies, np.int64))
        return VoxelizationReport(*self._parts.described(result), result.seconds)


def voxelize_in_blocks(
    scene: Scene,
    grid: Grid,
    take: Callable[[Voxels], None],
    *,
    block_side: int,
    fill: ObjectFill = "solid",
    rule: Rule = "touch",
    thin: Thin = "keep",
    geometry: Geometry = "auto",
    pow2: Pow2 = "box",
    threads: int = 0,
) -> VoxelizationReport:
    """Voxelize a scene whose voxels do not fit the memory at once, square by square of columns.

    Parameters
    ----------
    scene, grid, fill, rule, thin, geometry, pow2, threads
        As :func:`voxelize` takes them.
    take
        Called with the voxels of each square that has geometry, in Morton order. Squares are disjoint, so the octrees
        of their voxels are joined by :class:`voxrt.octree.Assembly`.
    block_side
        Columns per side of a square, a multiple of 64. It reaches over the whole height of the grid.

    Returns
    -------
    VoxelizationReport
        What :func:`voxelize` returns besides the voxels.

    Raises
    ------
    TypeError, ValueError, AssetError, DoesNotFitError
        As :func:`voxelize` does.

    Examples
    --------
    >>> from voxrt.voxelize import fit_grid, load, voxelize_in_blocks
    >>> scene = load("examples/house.obj")
    >>> blocks = []
    >>> report = voxelize_in_blocks(scene, fit_grid(scene, depth=7), blocks.append, block_side=64)
    >>> len(blocks), sum(one.voxels for one in report.objects)
    (4, 1082472)
    """
    block_side = arguments.whole("block_side", block_side, 64, 1 << 16)
    voxelizer = BlockVoxelizer(
        scene, grid, fill=fill, rule=rule, thin=thin, geometry=geometry, pow2=pow2, threads=threads
    )
    tallies = np.zeros((len(scene.objects), TALLIES), np.int64)
    for block in voxelizer.blocks(block_side):
        voxels, found = voxelizer.voxelize(block)
        take(voxels)
        tallies += found
    return voxelizer.report(tallies)


def _feed(digest: Any, value: object) -> None:  # noqa: ANN401 - hashlib does not name the type
    """Add arrays, numbers and texts, or a sequence of them, to a digest."""
    if isinstance(value, np.ndarray):
        digest.update(f"{value.dtype.str}{value.shape}".encode())
        digest.update(np.ascontiguousarray(value).data)
    elif isinstance(value, list | tuple):
        digest.update(f"[{len(value)}]".encode())
        for one in value:
            _feed(digest, one)
    else:
        digest.update(repr(value).encode())
