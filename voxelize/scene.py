"""The scene: what every loader makes and the voxelizer takes.

Scene frame: right-handed, metres, y up. A material's id is its index in :attr:`Scene.materials`; id 0 is empty space.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.colour.paint import Coat
    from voxrt.voxelize.errors import SceneWarning


@dataclass(frozen=True, slots=True)
class Material:
    """A named uniform material.

    Attributes
    ----------
    name
        The author's name for it, unique in its scene.
    colour
        sRGB, 8 bits a channel.
    mirror
        Reflects instead of showing its own shade, where the hardware has mirrors.
    authored
        False for the default material that stands in where the author gave none.
    """

    name: str
    colour: tuple[int, int, int]
    mirror: bool = False
    authored: bool = True


EMPTY = Material("empty", (24, 28, 36))
"""Entry 0 of every material table: empty space; its colour is the background's, dark for faces to stand out from it,
and not black for shaded edges to stand out too."""

DEFAULT_COLOUR = (200, 200, 200)
"""The sRGB colour of the default material."""

MATERIAL_LIMIT = 255
"""How many materials a memory word can tell apart, empty space not counted."""


@dataclass(frozen=True, eq=False, slots=True)
class Tints:
    """Materials that vary over triangles, made for a grid by :func:`voxrt.voxelize.tint`.

    Each tinted triangle lies in a raster of materials. Place (u, v) of a raster is in column floor(u) and row floor(v);
    a triangle's point is at the place that its corners' places give it.

    Attributes
    ----------
    sizes
        int32, shape (T, 2): columns and rows of each triangle's raster, 1 … 65536; 0 and 0 where it has one material.
    places
        float32, shape (T, 3, 2): the places of its corners.
    materials
        uint8, shape (sum of columns times rows,): material ids, raster by raster, row by row; 0 where the surface is
        cut away.
    """

    sizes: NDArray[np.int32]
    places: NDArray[np.float32]
    materials: NDArray[np.uint8]


@dataclass(frozen=True, eq=False, slots=True)
class Mesh:
    """Triangles in their object's frame. Instances share one mesh.

    Attributes
    ----------
    positions
        float32 or float64, as the file has them, shape (V, 3); finite where a triangle uses them.
    triangles
        int32, shape (T, 3): rows of `positions`, counter-clockwise seen from outside.
    materials
        uint8, shape (T,): material ids, 1 … 255. Painted triangles have that of their paint, and
        once they are tinted that of most of the mesh's paint.
    coat
        The paint on its triangles, to be sampled point by point; None where materials alone give their colour.
    tints
        Materials that vary over its painted triangles, which the voxelizer prefers to `materials`; None before it is
        tinted.
    """

    positions: NDArray[np.floating]
    triangles: NDArray[np.int32]
    materials: NDArray[np.uint8]
    coat: Coat | None = None
    tints: Tints | None = None


@dataclass(frozen=True, eq=False, slots=True)
class BoxCollider:
    """A box in its object's frame, from `minimum` to `maximum` (float64, shape (3,)).

    `pow2` says whether its sides are rounded up to powers of two voxels when the user asks for no rule of their own.
    """

    minimum: NDArray[np.float64]
    maximum: NDArray[np.float64]
    pow2: bool = True


@dataclass(frozen=True, eq=False, slots=True)
class SphereCollider:
    """A ball in its object's frame: `centre` (float64, shape (3,)), `radius`; an ellipsoid where the frame scales."""

    centre: NDArray[np.float64]
    radius: float


@dataclass(frozen=True, eq=False, slots=True)
class HullCollider:
    """The convex hull of `positions` (float64, shape (V, 3)), in its object's frame."""

    positions: NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class MeshCollider:
    """Triangles that stand in for the rendered ones: `positions` and `triangles` as those of a :class:`Mesh`."""

    positions: NDArray[np.floating]
    triangles: NDArray[np.int32]


Collider: TypeAlias = BoxCollider | SphereCollider | HullCollider | MeshCollider


@dataclass(frozen=True, eq=False, slots=True)
class SceneObject:
    """One object of the scene, in authored order.

    Attributes
    ----------
    name
        The author's name, with the path in the file where names repeat.
    mesh
        Its triangles; instances of one mesh hold the same value.
    transform
        float64, shape (4, 4), affine, column vectors: object frame to scene frame. May mirror.
    colliders
        The authored stand-ins, filled with `collider_material`; empty where the author gave none.
    collider_material
        Material id 1 … 255 that colliders take.
    """

    name: str
    mesh: Mesh
    transform: NDArray[np.float64] = field(default_factory=lambda: np.eye(4))
    colliders: tuple[Collider, ...] = ()
    collider_material: int = 1


@dataclass(frozen=True, slots=True)
class Viewpoint:
    """Where an author wants the scene seen from.

    Attributes
    ----------
    eye, target
        Metres, scene frame: where the camera stands and what is in the middle of its picture.
    field_of_view
        Degrees from the picture's top to its bottom; None where the author does not say.
    """

    eye: tuple[float, float, float]
    target: tuple[float, float, float]
    field_of_view: float | None = None


@dataclass(frozen=True, slots=True)
class PointLight:
    """Where an author wants light to come from: `position` in metres, scene frame."""

    position: tuple[float, float, float]


@dataclass(frozen=True, eq=False, slots=True)
class Scene:
    """Everything an asset file said, in the scene frame.

    Attributes
    ----------
    name
        The asset's name without folder and suffix.
    objects
        In authored order: where they compete for a voxel, the first wins.
    materials
        Indexed by material id; entry 0 is :data:`EMPTY`; at most 256 entries.
    warnings
        What was said by the file and not honoured as it stands.
    viewpoint
        The author's camera, for pictures for which no other is asked; None where the author gave none.
    light
        The author's light, likewise.
    """

    name: str
    objects: tuple[SceneObject, ...]
    materials: tuple[Material, ...]
    warnings: tuple[SceneWarning, ...] = ()
    viewpoint: Viewpoint | None = None
    light: PointLight | None = None
