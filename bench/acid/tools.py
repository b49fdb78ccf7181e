"""The tools of the acid test: which voxels each promises, in the words of its documentation.

A case that has a trait which a tool's documentation excludes is not judged. The voxels that a rule demands and those
that it allows differ where the documentation does not decide: on the surface itself.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from acid.checker import UNIT, Mesh, edges, is_closed, normal_of, oriented, volume6

if TYPE_CHECKING:
    from collections.abc import Callable

    from acid.cases import Case
    from acid.checker import Voxel

SAMPLED = Fraction(29, 100)
"""Voxels. Each point of a triangle whose edges are at most half a voxel long is nearer than this to a corner of it."""

RULES: dict[str, Callable[[Mesh], tuple[set[Voxel], set[Voxel]]]] = {
    "touch": lambda mesh: (mesh.touch(), mesh.touch()),
    "centre": lambda mesh: (mesh.centre(contact=False), mesh.centre(contact=True)),
    "exact centre": lambda mesh: (mesh.centre(contact=True),) * 2,
    "half": lambda mesh: (mesh.half(windings=True),) * 2,
    "surface": lambda mesh: (mesh.surface(contact=False), mesh.surface(contact=True)),
    "thin surface": lambda mesh: (mesh.surface_within(Fraction(1, 2), across=True), mesh.surface(contact=True)),
    "samples of the surface": lambda mesh: (mesh.surface_within(SAMPLED), mesh.surface(contact=True)),
}
"""By rule, the voxels that must be filled and those that may be."""

EXPLAINED = {
    "touch": "the solid meets the voxel's interior",
    "centre": "the voxel's centre is inside",
    "exact centre": "the voxel's centre is inside or on the surface",
    "half": "at least half of the voxel is inside, where what is enclosed twice counts twice",
    "surface": "a triangle meets the voxel",
    "thin surface": "a triangle meets the voxel's middle line along the axis that it faces most; no voxel elsewhere",
    "samples of the surface": "a corner lies in the voxel once the edges are half a voxel long; no voxel elsewhere",
}
"""Rules in words."""


@dataclass(frozen=True)
class Tool:
    """One way to voxelize by one tool."""

    name: str
    package: str
    """Its name in the registry."""
    rule: str
    exclusions: frozenset[str]
    """Traits of cases for which its documentation promises nothing."""
    documentation: str
    """What it says, and where."""
    bounded: bool = False
    """Whether its documentation bounds the grid, so that voxels outside of it are wrong."""


def traits_of(case: Case) -> set[str]:
    """Return what documentations exclude: "sheet", "holes", "turned", "crossing", "float32"."""
    mesh = Mesh(case.surface, 2**case.depth)
    encloses = all(is_closed(piece) and volume6(piece) for piece in oriented(case.surface))
    found = set() if encloses else {"sheet"}
    faces = [t for t in case.triangles if any(normal_of(t))]
    if any(count % 2 for count in Counter(frozenset(edge) for t in faces for edge in edges(t)).values()):
        found.add("holes")
    outwards = {cycle for a, b, c in mesh.triangles for cycle in ((a, b, c), (b, c, a), (c, a, b))}
    corners = {frozenset(t) for t in outwards}
    if any(t not in outwards and frozenset(t) in corners for t in faces):
        found.add("turned")
    repeated = len({frozenset(t) for t in faces}) < len(faces)
    if repeated or sum(mesh.fractions().values()) * UNIT**3 != Fraction(volume6(mesh.closing), 6):
        found.add("crossing")
    points = positions(case)
    if (points.astype(np.float32) != points).any():
        found.add("float32")
    return found


def positions(case: Case) -> np.ndarray:
    """Return the corners of the triangles in voxels: float64, shape (T, 3, 3)."""
    return np.array(case.triangles, float) / UNIT + np.array(case.origin, float)


SOLID = {"sheet"}
WHOLE = SOLID | {"holes"}


def tool(name: str, package: str, rule: str, exclusions: set[str], *documentation: str, bounded: bool = False) -> Tool:
    return Tool(name, package, rule, frozenset(exclusions), " ".join(documentation), bounded=bounded)


TOOLS = [
    tool("voxrt touch", "voxrt-build", "touch", set(), "*A voxel belongs to an object if the closed solid meets the",
         "interior of the voxel at all* (manual, Voxels)"),
    tool("voxrt centre", "voxrt-build", "exact centre", SOLID, "*Filled if its centre lies in the closed solid of an",
         "object. On the surface counts* (manual, Voxels; `--thin drop`)"),
    tool("voxrt half", "voxrt-build", "half", SOLID, "*Filled if the volumes of the objects in it add up to at",
         "least half of it* (manual, Voxels; `--thin drop`)"),
    tool("trimesh voxelized", "trimesh", "samples of the surface", set(), "*Subdividing a mesh until every edge is",
         "shorter than: (pitch / edge_factor)* (`voxelize_subdivide`)"),
    tool("trimesh contains", "trimesh", "centre", WHOLE, "*Whether or not they are inside the mesh. This raises an",
         "error if called on a non-watertight mesh* (`Trimesh.contains`; its rays are random, so counts vary)"),
    tool("Open3D VoxelGrid", "open3d", "surface", set(), "*All voxels that are intersected by a triangle are set to 1,",
         "all others are set to 0* (tutorial, Voxelization); *bounds are defined by the given parameters*",
         bounded=True),
    tool("Open3D occupancy", "open3d", "centre", WHOLE | {"crossing", "float32"}, "*Whether the query points are",
         "inside or outside*; *watertight*, *no intersections between meshes*, *Float32* (`compute_occupancy`,",
         "11 samples)"),
    tool("PyVista", "pyvista", "centre", WHOLE | {"crossing"}, "*Points inside and outside of the input surface are",
         "labelled*; *a closed surface*; *the intersection will be considered as background* (`voxelize_binary_mask`)"),
    tool("MeshLib", "meshlib", "centre", WHOLE | {"turned", "float32"}, "*Robust winding number generalization with",
         "support of holes and self-intersections* (`SignDetectionMode.HoleWindingRule`; `Vector3f`)"),
    tool("PyMeshLab", "pymeshlab", "centre", WHOLE | {"turned", "crossing"}, "Signed distance",
         "(`compute_scalar_by_distance_from_another_mesh_per_vertex`)"),
    tool("stl-to-voxel", "stl-to-voxel", "centre", SOLID, "*The voxel value represents whether the center of the voxel",
         "is inside the mesh* (pull request 62); *winding number based algorithm for polygon repair* (README)"),
    tool("Warp winding number", "warp-lang", "centre", WHOLE | {"turned", "float32"}, "*Robust for poorly conditioned",
         "meshes* (`mesh_query_point_sign_winding_number`; `vec3f`)"),
    tool("Warp parity", "warp-lang", "centre", WHOLE | {"crossing", "float32"}, "*Inside when at least half of the",
         "rays cross an odd number of faces* (`mesh_query_point_sign_parity`, 11 samples; `vec3f`)"),
    tool("libigl", "libigl", "centre", WHOLE | {"turned"}, "*The generalized winding number at each query point with",
         "respect to the mesh* (`winding_number`)"),
    tool("OpenVDB", "python3-openvdb", "centre", WHOLE, "*A narrow-band level set volume*; *the mesh must form a",
         "closed surface, but the surface need not be manifold and may have self intersections and degenerate faces*",
         "(`createLevelSetFromPolygons`)"),
    tool("point-cloud-utils", "point-cloud-utils", "surface", set(), "*ijk coordinates of voxels which intersect the",
         "given mesh* (`voxelize_triangle_mesh`)"),
    tool("voxquant", "voxquant", "thin surface", {"float32"}, "*Surface (triangle) only voxelization* (README);",
         "points of *the plane on which the triangle will take up the most area* (source of `voxelize_triangle`)"),
]  # fmt: skip
