"""One tool voxelizes one mesh, in a process of its own: ``python bench/peer.py TOOL MESH.npz DEPTH``, for peers.py.

Each tool gets the same vertices and triangles and 2**DEPTH voxels along the longest side. Prints what it made and the
seconds that it took once the mesh was there, as JSON.
"""

from __future__ import annotations

import json
import sys
import time
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    Step = Callable[[], dict[str, int]]


def ours(vertices: np.ndarray, triangles: np.ndarray, depth: int) -> Step:
    """Solid voxels with materials, to a shared octree's memory words."""
    from voxrt import octree  # noqa: PLC0415 - a process imports its own tool alone
    from voxrt.voxelize import EMPTY, Material, Mesh, Scene, SceneObject, fit_grid, voxelize  # noqa: PLC0415

    mesh = Mesh(vertices, triangles, np.ones(len(triangles), np.uint8))
    scene = Scene("mesh", (SceneObject("mesh", mesh),), (EMPTY, Material("stone", (150, 150, 150))))

    def step() -> dict[str, int]:
        result = voxelize(scene, fit_grid(scene, depth=depth))
        words = len(octree.build(result.voxels).words)
        return {"voxels": sum(report.voxels for report in result.objects), "words": words}

    return step


def trimesh_surface(vertices: np.ndarray, triangles: np.ndarray, depth: int) -> Step:
    """Voxels that hold a vertex, after triangles were cut until they are smaller than one."""
    import trimesh  # noqa: PLC0415

    mesh = trimesh.Trimesh(vertices, triangles, process=False)
    return lambda: {"voxels": int(mesh.voxelized(float(mesh.extents.max()) / 2**depth).filled_count)}


def open3d_surface(vertices: np.ndarray, triangles: np.ndarray, depth: int) -> Step:
    """Voxels that meet a triangle."""
    import open3d  # noqa: PLC0415

    mesh, size = _open3d_mesh(vertices, triangles, depth)
    make = open3d.geometry.VoxelGrid.create_from_triangle_mesh
    return lambda: {"voxels": len(make(mesh, size).get_voxels())}


def open3d_octree(vertices: np.ndarray, triangles: np.ndarray, depth: int) -> Step:
    """Voxels that meet a triangle, in an octree."""
    import open3d  # noqa: PLC0415

    mesh, size = _open3d_mesh(vertices, triangles, depth)

    def step() -> dict[str, int]:
        grid = open3d.geometry.VoxelGrid.create_from_triangle_mesh(mesh, size)
        tree = open3d.geometry.Octree(max_depth=depth)
        tree.create_from_voxel_grid(grid)
        return {"voxels": len(grid.get_voxels())}

    return step


def open3d_columns(vertices: np.ndarray, triangles: np.ndarray, depth: int) -> Step:
    """Solid columns: a ray through the middle of each, and the voxels between where it enters and leaves."""
    import open3d  # noqa: PLC0415

    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(vertices.astype(np.float32), triangles.astype(np.uint32))
    low, side = vertices.min(axis=0), float(np.ptp(vertices, axis=0).max())

    def step() -> dict[str, int]:
        middles = (np.arange(2**depth) + 0.5) * side / 2**depth
        rays = np.zeros((2**depth, 2**depth, 6), np.float32)
        rays[..., 0], rays[..., 1], rays[..., 2] = low[0] + middles[:, None], low[1] + middles, low[2] - side
        rays[..., 5] = side / 2**depth
        found = {name: tensor.numpy() for name, tensor in scene.list_intersections(rays.reshape(-1, 6)).items()}
        order = np.lexsort((found["t_hit"], found["ray_ids"]))
        ray, crossing = found["ray_ids"][order], np.rint(found["t_hit"][order]).astype(np.int64)
        first = np.flatnonzero(np.diff(ray, prepend=-1))
        leaves = (np.arange(len(ray)) - np.repeat(first, np.diff(first, append=len(ray)))) % 2 == 1
        return {"voxels": int((crossing[leaves] - crossing[np.flatnonzero(leaves) - 1]).sum())}

    return step


def pyvista_solid(vertices: np.ndarray, triangles: np.ndarray, depth: int) -> Step:
    """Solid voxels, a byte each."""
    import pyvista  # noqa: PLC0415

    mesh = pyvista.PolyData.from_regular_faces(vertices, triangles)
    size = float(np.ptp(vertices, axis=0).max()) / 2**depth
    return lambda: {"voxels": int(np.count_nonzero(mesh.voxelize_binary_mask(spacing=(size,) * 3)["mask"]))}


TOOLS = {
    "voxrt": ours,
    "trimesh": trimesh_surface,
    "Open3D surface": open3d_surface,
    "Open3D octree": open3d_octree,
    "Open3D columns": open3d_columns,
    "PyVista": pyvista_solid,
}
MAKES = {
    "voxrt": "solid, materials, shared octree",
    "trimesh": "surface, incomplete",
    "Open3D surface": "surface",
    "Open3D octree": "surface, octree",
    "Open3D columns": "solid columns, one label",
    "PyVista": "solid bytes",
}


def _open3d_mesh(vertices: np.ndarray, triangles: np.ndarray, depth: int) -> tuple[object, float]:
    import open3d  # noqa: PLC0415

    mesh = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(vertices), open3d.utility.Vector3iVector(triangles)
    )
    return mesh, float(np.ptp(vertices, axis=0).max()) / 2**depth


def main() -> None:
    tool, file, depth = sys.argv[1:]
    with np.load(file) as arrays:
        step = TOOLS[tool](arrays["vertices"], arrays["triangles"], int(depth))
    start = time.perf_counter()
    made = step()
    print(json.dumps({"seconds": time.perf_counter() - start, **made}))


if __name__ == "__main__":
    main()
