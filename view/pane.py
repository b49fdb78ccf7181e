"""What a picture shows: memories side by side, and the path of a ray through one of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from msgspec.structs import replace

from voxrt.octree.budget import coarsen
from voxrt.octree.camera import FACES
from voxrt.octree.leaf_arrays import Leaves, solid_leaves
from voxrt.octree.octant import octant_at
from voxrt.view.cells import octant_cells
from voxrt.view.octant_mesh import octant_mesh
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Callable

    import pyvista
    from numpy.typing import NDArray

    from voxrt.octree.camera import Faces
    from voxrt.octree.owners import Owners
    from voxrt.octree.query import Corner
    from voxrt.octree.rom import Rom
    from voxrt.view.octant_mesh import OctantMesh

Aspect: TypeAlias = Literal["material", "level", "owner"]
Plane: TypeAlias = tuple[tuple[float, float, float], tuple[float, float, float]]
"""A normal and a point; octants on the side of the normal are cut away."""


class Pane(Value, frozen=True, eq=False):
    """One memory in a picture.

    Attributes
    ----------
    rom
        The memory and its materials.
    high
        Show only octants that overlap the voxels below this (x, y, z); None shows all.
    cut
        Cut the octants at `high`; else they are shown whole.
    by
        What the colours show: ``"material"``, ``"level"`` or ``"owner"``, which needs `owners`.
    owners
        The owners of the voxels.
    triangles
        A mesh drawn over the octants: float64, shape (T, 3, 3), voxels, grid frame.
    flat
        Show materials in their own colour, as where their light is baked; else each side has its brightness.

    Examples
    --------
    >>> import voxrt
    >>> pane = Pane(voxrt.build("examples/house.obj", depth=4).rom, high=(8, 16, 16), cut=True)
    >>> int(pane.mesh().points[:, 0].max())
    8
    """

    rom: Rom
    high: Corner | None = None
    cut: bool = False
    by: Aspect = "material"
    owners: Owners | None = None
    triangles: NDArray[np.float64] | None = None
    flat: bool = False

    @property
    def faces(self) -> Faces:
        """The brightness of the sides along -x, +x, -y, +y, -z, +z: 0 ... 255."""
        return (255,) * 6 if self.flat and self.by == "material" else FACES

    def solid(self) -> Leaves:
        """Return the solid octants, hidden ones included."""
        return solid_leaves(self.rom.octree, (0, 0, 0), self.high)

    def coarsened(self, level: int) -> Pane:
        """Return a pane whose octants of 2**level voxels per side are uniform."""
        tree = self.rom.octree
        return replace(self, rom=replace(self.rom, octree=coarsen(tree, min(level, tree.depth)))) if level else self

    def grid(self, solid: Leaves | None = None, plane: Plane | None = None) -> pyvista.UnstructuredGrid:
        """Return the octants that can be seen as cells: those of `solid` whose centre the plane keeps."""
        return octant_cells(self.rom, self._kept(solid, plane), self._box(), owners=self.owners)

    def mesh(self) -> OctantMesh:
        """Return the octants that can be seen as corners and sides."""
        return octant_mesh(self.rom, self.solid(), self._box(), owners=self.owners)

    def _kept(self, solid: Leaves | None, plane: Plane | None) -> Leaves:
        some = self.solid() if solid is None else solid
        if plane is None:
            return some
        normal, point = np.array(plane)
        centres = some.corners + np.exp2(some.levels.astype(np.float64) - 1)[:, None]
        kept = (centres - point) @ normal <= 0
        return Leaves(some.corners[kept], some.levels[kept], some.materials[kept])

    def _box(self) -> tuple[Corner, Corner] | None:
        """Return the corners at which octants are cut; None leaves them whole."""
        return ((0, 0, 0), (self.rom.octree.size,) * 3 if self.high is None else self.high) if self.cut else None

    def describe(self, voxel: Corner) -> str:
        """Return what the memory knows of the octant that holds a voxel, in lines of text."""
        octant = octant_at(self.rom.octree, voxel)
        ranges = ", ".join(
            f"{axis} {first}...{end - 1}" for axis, first, end in zip("xyz", octant.corner, octant.end, strict=True)
        )
        lines = [
            f"address 0x{octant.address:X}",
            f"word 0x{octant.word:08X}",
            f"level {octant.level}: {'x'.join([str(1 << octant.level)] * 3)} voxels",
            f"voxels {ranges}",
            f"material {octant.material}: {self.rom.materials[octant.material].name}",
        ]
        if self.owners is not None:
            lines.append(f"of {self.owners.name_at(voxel)}")
        return "\n".join(lines)


class DrawnRay(Value, frozen=True, eq=False):
    """A ray as a picture shows it, as :func:`voxrt.view.scene_overlay.drawn_ray` makes it.

    Attributes
    ----------
    start, end
        Voxels, grid frame.
    corners, levels, words
        The octants whose words it read, in order: lowest voxels (int64, shape (N, 3)), log2 of the side (int64, shape
        (N,)), words in the report dialect (uint32, shape (N,)).
    points
        The points of the ray at these readings: float64, shape (N, 3), voxels.
    table
        The lines of text beside the picture.
    """

    start: tuple[float, float, float]
    end: tuple[float, float, float]
    corners: NDArray[np.int64]
    levels: NDArray[np.int64]
    words: NDArray[np.uint32]
    points: NDArray[np.float64]
    table: tuple[str, ...]


class Preview(Value, frozen=True, eq=False):
    """A picture in which a pixel can be chosen.

    Attributes
    ----------
    colour
        uint8, shape (H, W, 3), sRGB.
    pixel
        The chosen pixel: column, row.
    follow
        Returns the ray of a pixel.
    """

    colour: NDArray[np.uint8]
    pixel: tuple[int, int]
    follow: Callable[[tuple[int, int]], DrawnRay]
