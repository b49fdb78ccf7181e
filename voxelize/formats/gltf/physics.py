"""Colliders of KHR_physics_rigid_bodies, with the shapes of KHR_implicit_shapes.

Cylinders and capsules become convex hulls of points on their surface. Motions, joints and physics materials are
ignored; triggers are not solid.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from msgspec import Struct

from voxrt.voxelize.collider_shapes import BoxCollider, HullCollider, MeshCollider, SphereCollider
from voxrt.voxelize.formats.gltf.extensions import PHYSICS, SHAPES
from voxrt.voxelize.formats.gltf.schema import Index, Vec3  # noqa: TC001 -- msgspec reads the annotations
from voxrt.voxelize.formats.round_shapes import capsule_points, cylinder_points

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.voxelize.collider_shapes import Collider
    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.meshes import Surface

_LARGEST = 1e150  # squares of larger sizes overflow


class Box(Struct, frozen=True):
    """Centred in its node's frame."""

    size: Vec3 = (1.0, 1.0, 1.0)


class Sphere(Struct, frozen=True):
    """Centred in its node's frame."""

    radius: float = 0.5


class Round(Struct, frozen=True, rename="camel"):
    """A cylinder, a cone or a capsule, along y."""

    height: float = 0.5
    radius_top: float = 0.25
    radius_bottom: float = 0.25


class Plane(Struct, frozen=True, rename="camel"):
    """Its normal is along y; it is infinite where it has no size."""

    size_x: float | None = None
    size_z: float | None = None


Kind: TypeAlias = Literal["box", "sphere", "cylinder", "capsule", "plane"]


class Shape(Struct, frozen=True):
    """One of the file's shapes."""

    type: Kind
    box: Box = Box()
    sphere: Sphere = Sphere()
    cylinder: Round = Round()
    capsule: Round = Round()
    plane: Plane = Plane()


class FileShapes(Struct, frozen=True):
    """KHR_implicit_shapes on the file."""

    shapes: list[Shape] = []


class Geometry(Struct, frozen=True, rename="camel"):
    """A shape, or the mesh of a node."""

    shape: Index | None = None
    mesh: Index | None = None
    node: Index | None = None
    convex_hull: bool = False


class AuthoredCollider(Struct, frozen=True):
    """The collider of a node."""

    geometry: Geometry = Geometry()


class Body(Struct, frozen=True):
    """KHR_physics_rigid_bodies on a node."""

    collider: AuthoredCollider | None = None


def read_shapes(document: Document) -> list[Shape]:
    """Return the file's shapes."""
    return (document.extension(document.gltf, SHAPES, FileShapes, "") or FileShapes()).shapes


def physics_collider(
    document: Document, index: int, shapes: list[Shape], read_mesh: Callable[[int, str], Surface]
) -> Collider | None:
    """Return the collider of node `index`, in its frame; None for none.

    `read_mesh` returns a mesh by its index, to which a JSON path refers.
    """
    place = f"nodes[{index}]"
    body = document.extension(document.gltf.nodes[index], PHYSICS, Body, place)
    if body is None or body.collider is None:
        return None
    here = f"{place}.extensions.{PHYSICS}.collider.geometry"
    geometry = body.collider.geometry
    mesh, where = geometry.mesh, f"{here}.mesh"
    if geometry.node is not None:
        where = f"{here}.node"
        mesh = document.item(document.gltf.nodes, geometry.node, where, "node").mesh
    if mesh is not None:
        surface = read_mesh(mesh, where)
        if not len(surface.triangles):
            raise document.error(where, "a collider without triangles")
        if geometry.convex_hull:
            return HullCollider(surface.positions[np.unique(surface.triangles)].astype(np.float64))
        return MeshCollider(surface.positions, surface.triangles)
    if geometry.shape is None:
        raise document.error(here, "names neither a shape nor a mesh")
    return _shaped(document, document.item(shapes, geometry.shape, f"{here}.shape", "shape"), geometry.shape)


def _shaped(document: Document, shape: Shape, index: int) -> Collider | None:
    place = f"extensions.{SHAPES}.shapes[{index}].{shape.type}"
    if shape.type == "box":
        _check_sizes(document, place, *shape.box.size)
        half = np.array(shape.box.size) / 2
        return BoxCollider(-half, half)
    if shape.type == "sphere":
        _check_sizes(document, place, shape.sphere.radius)
        return SphereCollider(np.zeros(3), shape.sphere.radius)
    if shape.type == "plane":
        return _plane(document, shape.plane, place)
    solid = shape.cylinder if shape.type == "cylinder" else shape.capsule
    _check_sizes(document, place, solid.height, solid.radius_top + solid.radius_bottom)
    if min(solid.radius_top, solid.radius_bottom) < 0:
        raise document.error(place, "a radius is negative")
    if shape.type == "cylinder":
        return HullCollider(cylinder_points(solid.radius_top, solid.radius_bottom, solid.height))
    return HullCollider(capsule_points(solid.radius_top, solid.radius_bottom, solid.height))


def _check_sizes(document: Document, place: str, *sizes: float) -> None:
    if not (min(sizes) > 0 and max(sizes) < _LARGEST):
        raise document.error(place, "a size is not positive, or too large")


def _plane(document: Document, plane: Plane, place: str) -> Collider | None:
    if plane.size_x is None or plane.size_z is None:
        document.log.add("endless-plane", "infinite collision planes were left out")
        return None
    _check_sizes(document, place, plane.size_x, plane.size_z)
    x, z = plane.size_x / 2, plane.size_z / 2
    corners = np.array([[-x, 0.0, -z], [-x, 0.0, z], [x, 0.0, z], [x, 0.0, -z]])
    return MeshCollider(corners, np.array([[0, 1, 2], [0, 2, 3]], np.int32))
