"""An octree that is edited: voxels, shapes and copies, undo and redo, and patches for memories that show it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.octree import _native
from voxrt.octree.lod import with_means
from voxrt.octree.octree import Octree
from voxrt.octree.patch import Patch
from voxrt.octree.piece import Piece
from voxrt.octree.query import as_box, as_corner, as_points
from voxrt.octree.rom import Rom
from voxrt.octree.shapes import Shape, change_shape
from voxrt.octree.words import EMPTY
from voxrt.octree.world_figures import WorldFigures
from voxrt.octree.world_materials import add_missing
from voxrt.voxelize import DoesNotFitError, Material
from voxrt.voxelize.arguments import instance, whole, whole_array

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

_MOST_WORDS = 1 + 8 * ((1 << 28) - 1)
_MOST_SIDE = 1 << 16
_MOST_AUTHOR = _MOST_STROKE = 2**32 - 1


class World:
    """A memory whose voxels change.

    An edit makes at most one new block per level for a voxel, and never changes a block that is in use: see
    :meth:`commit`. Equal blocks are stored once at any time. Several threads may use one world; they take turns.

    Parameters
    ----------
    rom
        The memory to begin with. Mean materials for level of detail are made anew by :meth:`rom`. Of an animation, the
        first frame is edited; the others stay as they are in :attr:`image`.
    words
        The most words that the memory may have: its octree, and whatever is kept for undo and for live roots. None:
        as many as addresses reach.
    undo_steps
        The edits of all authors that can be undone, 0 … 1,000,000. They are forgotten early where an edit needs their
        words.
    root
        Another word that is the root, as word 0 is: it is the live root then, and blocks that it does not reach are
        free. None: word 0, and all blocks are in use. Where the memory stores equal blocks more than once, word 0 is
        the live root of a memory that does not.

    Raises
    ------
    TypeError, ValueError
        A value of another type, or out of range, or `root` is no such word.
    DoesNotFitError
        The memory has more than `words`.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import Box, Rom, Sphere, World, from_dense
    >>> from voxrt.voxelize import EMPTY, Material
    >>> stone, gold = Material("stone", (120, 120, 120)), Material("gold", (250, 200, 60))
    >>> world = World(Rom("rock", from_dense(np.ones((32, 32, 32), np.uint8)), (EMPTY, stone)))
    >>> world.fill(Sphere((16, 16, 16), 10), 0)
    >>> world.set([[16, 16, 16]], world.add_material(gold))
    >>> world.paint(Box((5, 16, 16), (17, 17, 17)), 2)
    >>> world.paste(world.copy((5, 16, 16), (7, 17, 17)), (20, 16, 16))
    >>> world.material_at([[16, 16, 16], [5, 16, 16], [6, 16, 16], [20, 16, 16]])
    array([2, 2, 0, 2], dtype=uint8)
    >>> world.undo(), world.undo(), world.redo(), world.steps
    (True, True, True, (3, 1))
    >>> patch = world.commit()
    >>> len(patch.blocks) <= world.figures().blocks, world.live_roots == (0, patch.root)
    (True, True)
    >>> world.release(0)
    """

    def __init__(self, rom: Rom, *, words: int | None = None, undo_steps: int = 100, root: int | None = None) -> None:
        instance("rom", rom, Rom)
        self._limit = _MOST_WORDS if words is None else whole("words", words, 1, _MOST_WORDS)
        steps = whole("undo_steps", undo_steps, 0, 1_000_000)
        present = rom.octree.words
        if root is not None and present[whole("root", root, 0, len(present) - 1)] != present[0]:
            raise ValueError(f"word {root} is not that of the root, as word 0 is")
        self._materials = rom.materials
        if len(rom.octree.words) > self._limit:
            raise DoesNotFitError(
                f"{rom.name}: its {len(rom.octree.words):,} words do not fit the {self._limit:,} of the world's memory"
            )
        self._author = self._stroke = 0
        self._native = _native.World(rom.octree.words, rom.octree.depth, self._limit, steps, root)
        self._depth, self._has_means = rom.octree.depth, rom.octree.means is not None
        self._rom = replace(rom, octree=Octree(self._depth, np.array([EMPTY], np.uint32)))  # all but the voxels

    def __repr__(self) -> str:
        return f"<World {self._rom.name!r}: depth {self.depth}, {8 * self.figures().blocks + 1:,} words>"

    @property
    def native(self) -> _native.World:
        """The C++ world, which rays are traced through."""
        return self._native

    @property
    def depth(self) -> int:
        """Levels below the root: the world has 2**depth voxels per side."""
        return self._depth

    @property
    def size(self) -> int:
        """Voxels per side."""
        return 1 << self.depth

    @property
    def materials(self) -> tuple[Material, ...]:
        """The materials by id; entry 0 is empty space."""
        return self._materials

    def add_material(self, material: Material) -> int:
        """Add a material, and return its id. One that is there already keeps its id. Undo does not remove it.

        Raises
        ------
        TypeError
            It is no material.
        DoesNotFitError
            There are 255 already.
        """
        self._materials = add_missing(self._materials, [instance("material", material, Material)])
        return self._materials.index(material, 1)

    def set(self, points: ArrayLike, materials: ArrayLike) -> None:
        """Give voxels their materials; 0 empties them.

        Parameters
        ----------
        points
            Integers, shape (N, 3): voxel coordinates (x, y, z), 0 … 2**depth - 1. Where one repeats, the last counts.
        materials
            Integers, shape (N,), or one for all: ids of :attr:`materials`.

        Raises
        ------
        TypeError, ValueError
            A shape, a coordinate or a material is none of these.
        DoesNotFitError
            The memory has no room for the result. Nothing has changed.
        """
        places = whole_array("points", points, ("N", 3), np.int64, low=0, high=self.size - 1)
        ids = np.asarray(materials)
        if ids.ndim == 0:
            ids = np.full(len(places), self._material(materials), np.uint8)
        else:
            ids = whole_array("materials", ids, ("N",), np.uint8, low=0, high=len(self._materials) - 1)
        if len(ids) != len(places):
            raise ValueError(f"points and materials must be (N, 3) and (N,), not {places.shape} and {ids.shape}")
        self._check_fit(self._native.set(np.ascontiguousarray(places), np.ascontiguousarray(ids)))

    def fill(self, shape: Shape, material: int) -> None:
        """Give the voxels of a shape a material; 0 digs it out.

        The cost grows with the surface of the shape and not with its volume.

        Parameters
        ----------
        shape
            A :class:`Box`, :class:`Sphere` or :class:`Capsule`. What lies outside of the world is left out.
        material
            An id of :attr:`materials`.

        Raises
        ------
        TypeError, ValueError
            The shape or the material is none of these.
        DoesNotFitError
            The memory has no room for the result. Nothing has changed.
        """
        self._change(shape, material, solid_only=False)

    def paint(self, shape: Shape, material: int) -> None:
        """Give the solid voxels of a shape a material; as :meth:`fill` else."""
        self._change(shape, whole("material", material, 1, len(self._materials) - 1), solid_only=True)

    def copy(self, low: ArrayLike, high: ArrayLike) -> Piece:
        """Copy the voxels of a box.

        Parameters
        ----------
        low, high
            Integers (x, y, z): the lowest voxel, and one behind the highest; at most 65,536 per side. What lies outside
            of the world is empty.

        Raises
        ------
        TypeError, ValueError
            A corner is not three integers, or the box is empty or too large.
        """
        start, end = as_box(low, high)
        x, y, z = (above - below for below, above in zip(start, end, strict=True))
        if not 1 <= min(x, y, z) <= max(x, y, z) <= _MOST_SIDE:
            raise ValueError(f"a box of {x} x {y} x {z} voxels cannot be copied; each side must be 1 … {_MOST_SIDE}")
        words, depth = self._native.copy(start, end)
        return Piece(Octree(depth, words), (x, y, z), self.materials)

    def paste(self, other: Piece | Rom, at: ArrayLike, *, turned: int = 0) -> None:
        """Put the solid voxels of a piece, or of a memory, here. Empty ones leave what is there.

        Parameters
        ----------
        other
            What :meth:`copy` returned, of any world; or a memory, all of it. Materials that this world has not are
            added.
        at
            Integers (x, y, z): the voxel where the lowest corner of its box comes. What lies outside of the world is
            left out.
        turned
            Quarters of a turn around the y axis, 0 … 3. One takes the z axis to the x axis.

        Raises
        ------
        TypeError, ValueError
            A value of another type, or out of range.
        DoesNotFitError
            The memory has no room for the result, or there are more than 255 materials. Nothing has changed.
        """
        if isinstance(other, Rom):
            other = Piece(other.octree, (other.octree.size,) * 3, other.materials)
        if not isinstance(other, Piece):
            raise TypeError(f"other must be a Piece or a Rom, not {type(other).__name__}")
        corner, quarters = as_corner("at", at), whole("turned", turned, 0, 3)
        solid = np.flatnonzero(_native.leaf_counts(other.octree.words, other.octree.depth)[:, 1:].any(0)) + 1
        materials = add_missing(self._materials, [other.materials[id_] for id_ in solid])
        ids = [0] * 256
        for id_ in solid:
            ids[id_] = materials.index(other.materials[id_], 1)
        self._check_fit(self._native.paste(other.octree.words, other.octree.depth, other.size, corner, quarters, ids))
        self._materials = materials

    @property
    def author(self) -> int:
        """Who edits, undoes and does again from now on: an integer, 0 … 2**32 - 1; 0 at the beginning.

        Examples
        --------
        >>> from voxrt.octree import Rom, World, from_points
        >>> from voxrt.voxelize import EMPTY, Material
        >>> oak = Material("oak", (160, 110, 60))
        >>> world = World(Rom("dot", from_points([[1, 2, 3]], [1], depth=2), (EMPTY, oak)))
        >>> world.set([[0, 0, 0]], 1)
        >>> world.author = 1
        >>> world.set([[0, 0, 0], [1, 2, 3]], 0)
        >>> world.author = 0
        >>> world.undo()  # voxel 0, 0, 0 stays as author 1 has left it
        True
        >>> world.material_at([[0, 0, 0], [1, 2, 3]])
        array([0, 0], dtype=uint8)
        """
        return self._author

    @author.setter
    def author(self, author: int) -> None:
        self._author = whole("author", author, 0, _MOST_AUTHOR)
        self._native.set_author(self._author)

    @property
    def stroke(self) -> int:
        """The stroke of the edits from now on: an integer, 0 … 2**32 - 1; 0 at the beginning.

        Edits in a row by one author and of one stroke are undone together; those of stroke 0 are not.

        Examples
        --------
        >>> from voxrt.octree import Rom, World, from_points
        >>> from voxrt.voxelize import EMPTY, Material
        >>> world = World(Rom("dot", from_points([[1, 2, 3]], [1], depth=2), (EMPTY, Material("oak", (160, 110, 60)))))
        >>> world.stroke = 1
        >>> for x in range(3):
        ...     world.set([[x, 0, 0]], 1)
        >>> world.steps, world.undo(), world.material_at([[0, 0, 0], [2, 0, 0]])
        ((1, 0), True, array([0, 0], dtype=uint8))
        """
        return self._stroke

    @stroke.setter
    def stroke(self, stroke: int) -> None:
        self._stroke = whole("stroke", stroke, 0, _MOST_STROKE)
        self._native.set_stroke(self._stroke)

    def undo(self) -> bool:
        """Take back the last edit of :attr:`author` that is not undone. False if there is none.

        An edit is the voxels that it changed. Each of them has then what the last edit that changed it, and is not
        undone, made of it. So edits of other authors stay.

        Raises
        ------
        DoesNotFitError
            Others have edited since, and the memory has no room for the result. Nothing has changed.
        """
        return self._turned(self._native.undo())

    def redo(self) -> bool:
        """Do again what :attr:`author` has undone last. False if there is nothing, as after another edit.

        Voxels that others have changed after the edit stay as they are.

        Raises
        ------
        DoesNotFitError
            As :meth:`undo`.
        """
        return self._turned(self._native.redo())

    @property
    def steps(self) -> tuple[int, int]:
        """Edits of :attr:`author` that can be undone, and those that can be done again."""
        return self.steps_of(self._author)

    def steps_of(self, author: int) -> tuple[int, int]:
        """Count the edits of an author that can be undone, and those that can be done again."""
        return self._native.steps(whole("author", author, 0, _MOST_AUTHOR))

    def material_at(self, points: ArrayLike) -> NDArray[np.uint8]:
        """Look up the material of voxels: as :func:`voxrt.octree.material_at`.

        Parameters
        ----------
        points
            Integers, shape (..., 3): voxel coordinates (x, y, z). Outside of the world is empty.
        """
        rows, shape = as_points(points)
        return self._native.materials_at(rows).reshape(shape)

    def rom(self) -> Rom:
        """Return the memory of the voxels as they are: the same words as of a build of these voxels.

        Blocks have mean materials if those of the memory to begin with had some.
        """
        rom = replace(self._rom, octree=Octree(self.depth, self._native.words()), materials=self.materials)
        return with_means(rom) if self._has_means else rom

    def commit(self) -> Patch:
        """Make the octree as it is a live root, and return what memories that show this world must write.

        A memory that has :attr:`image` as it was at the beginning, and then every patch in order, has the octree at
        each live root. Blocks of live roots are not used again: :meth:`release` roots that nothing reads any more.

        Raises
        ------
        ValueError
            The memory has mean materials. They depend on neighbours: build it without level of detail.
        """
        if self._has_means:
            raise ValueError(
                f"{self._rom.name} has mean materials, which depend on neighbours: patches cannot have them; build it "
                "without level of detail"
            )
        return Patch(*self._native.commit())

    @property
    def live_roots(self) -> tuple[int, ...]:
        """The addresses of the live roots, in the order of their commits; word 0 is the first."""
        return self._native.live_roots()

    def release(self, root: int) -> None:
        """End a live root: no frame and no thread reads it any more.

        Raises
        ------
        TypeError, ValueError
            The root is not live, or it is the newest.
        """
        self._native.release(whole("root", root, 0, _MOST_WORDS))

    def octree_at(self, root: int) -> Octree:
        """Return the octree of a live root. Other threads may edit meanwhile.

        Raises
        ------
        TypeError, ValueError
            The root is not live.
        """
        return Octree(self.depth, self._native.words_at(whole("root", root, 0, _MOST_WORDS)))

    @property
    def image(self) -> NDArray[np.uint32]:
        """All words of the memory, free blocks included: uint32, shape (1 + 8 * blocks,), read-only.

        Before the first edit they are the words of the memory to begin with, if that stored equal blocks once.
        """
        return self._native.image()

    @property
    def written(self) -> NDArray[np.uint32]:
        """The addresses of the blocks in use that commits have written: uint32, shape (N,), ascending.

        A memory that got every patch has these blocks as :attr:`image` has them. It may differ in all others.
        """
        return self._native.written()

    def figures(self) -> WorldFigures:
        """Count the blocks by their use. Linear in the blocks."""
        return WorldFigures(*self._native.figures())

    def _change(self, shape: Shape, material: int, *, solid_only: bool) -> None:
        self._check_fit(change_shape(self._native, shape, self._material(material), solid_only=solid_only))

    def _material(self, material: object) -> int:
        return whole("material", material, 0, len(self._materials) - 1)

    def _turned(self, found: bool | None) -> bool:
        self._check_fit(found is not None)
        return bool(found)

    def _check_fit(self, fits: bool) -> None:
        if not fits:
            raise DoesNotFitError(
                f"the result of the edit does not fit the {self._limit:,} words of the world's memory; release older "
                "roots, or make the world with more words"
            )
