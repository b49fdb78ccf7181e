"""One tool voxelizes cases in a process of its own: ``python run_tool.py TOOL CASES.npz OUT.jsonl FIRST``.

Writes a line per case from FIRST on: its number and the voxels that are filled. Nothing of the test is imported, so
that it runs in an environment which has the tool alone.
"""

from __future__ import annotations

import json
import struct
import subprocess
import sys
import tempfile
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    Array = np.ndarray
    Voxelizer = Callable[[Array, Array, Array, int], Array]
"""Vertices (N, 3) and faces (T, 3), where the grid begins (3,), voxels per side, each 1 wide: filled voxels (V, 3)."""


def centres(low: Array, side: int) -> Array:
    """Return shape (side, side, side, 3)."""
    axis = np.arange(side) + 0.5
    return np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1) + low


def by_points(is_inside: Callable[[Array, Array, Array], Array]) -> Voxelizer:
    """Voxelize by asking for each voxel's centre whether it is inside."""

    def voxelizer(vertices: Array, faces: Array, low: Array, side: int) -> Array:
        inside = is_inside(vertices, faces, centres(low, side).reshape(-1, 3))
        return np.argwhere(np.asarray(inside, bool).reshape(side, side, side))

    return voxelizer


def framed(vertices: Array, low: Array, side: int) -> tuple[Array, Array]:
    """Two tiny triangles at the corners of the grid, for tools whose grid is the box around the mesh."""
    steps = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)]) / 64
    points = np.concatenate([low + steps, low + side - steps])
    return np.concatenate([vertices, points]), len(vertices) + np.arange(6).reshape(2, 3)


def voxrt(rule: str) -> Voxelizer:
    def voxelizer(vertices: Array, faces: Array, low: Array, side: int) -> Array:
        from voxrt import octree  # noqa: PLC0415 - a process imports its own tool alone
        from voxrt.voxelize import EMPTY, Grid, Material, Mesh, Scene, SceneObject, voxelize  # noqa: PLC0415

        mesh = Mesh(vertices, faces.astype(np.int32), np.ones(len(faces), np.uint8))
        scene = Scene("case", (SceneObject("case", mesh),), (EMPTY, Material("stone", (150, 150, 150))))
        grid = Grid(side.bit_length() - 1, tuple(map(float, low)), 1.0)
        options = {} if rule == "touch" else {"rule": rule, "thin": "drop"}
        return np.argwhere(octree.to_dense(octree.build(voxelize(scene, grid, **options).voxels)))

    return voxelizer


def trimesh_voxelized(vertices: Array, faces: Array, low: Array, _side: int) -> Array:
    import trimesh  # noqa: PLC0415

    # Its voxels have whole numbers as centres.
    grid = trimesh.Trimesh(vertices - low - 0.5, faces, process=False).voxelized(1.0, max_iter=None)
    return np.rint(grid.points).astype(int)


def trimesh_contains(vertices: Array, faces: Array, points: Array) -> Array:
    import trimesh  # noqa: PLC0415

    return trimesh.Trimesh(vertices, faces).contains(points)


def open3d_grid(vertices: Array, faces: Array, low: Array, side: int) -> Array:
    import open3d  # noqa: PLC0415

    utility, geometry = open3d.utility, open3d.geometry
    mesh = geometry.TriangleMesh(utility.Vector3dVector(vertices), utility.Vector3iVector(faces))
    grid = geometry.VoxelGrid.create_from_triangle_mesh_within_bounds(mesh, 1.0, low, low + side)
    return np.array([voxel.grid_index for voxel in grid.get_voxels()]).reshape(-1, 3)


def open3d_occupancy(vertices: Array, faces: Array, points: Array) -> Array:
    import open3d  # noqa: PLC0415

    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(vertices.astype(np.float32), faces.astype(np.uint32))
    return scene.compute_occupancy(points.astype(np.float32), nsamples=11).numpy() > 0


def pyvista_mask(vertices: Array, faces: Array, low: Array, side: int) -> Array:
    import pyvista  # noqa: PLC0415

    mesh = pyvista.PolyData.from_regular_faces(vertices, faces)
    volume = pyvista.ImageData(dimensions=(side,) * 3, spacing=(1.0,) * 3, origin=low + 0.5)
    mask = mesh.voxelize_binary_mask(reference_volume=volume)["mask"]
    return np.argwhere(np.asarray(mask).reshape((side,) * 3, order="F"))


def meshlib(vertices: Array, faces: Array, low: Array, side: int) -> Array:
    from meshlib import mrmeshnumpy, mrmeshpy  # noqa: PLC0415

    mesh = mrmeshnumpy.meshFromFacesVerts(faces, vertices)
    params = mrmeshpy.MeshToDistanceVolumeParams()
    params.vol.origin = mrmeshpy.Vector3f(*map(float, low))
    params.vol.voxelSize = mrmeshpy.Vector3f(1, 1, 1)
    params.vol.dimensions = mrmeshpy.Vector3i(side, side, side)
    params.dist.signMode = mrmeshpy.SignDetectionMode.HoleWindingRule
    volume = mrmeshpy.meshToDistanceVolume(mrmeshpy.MeshPart(mesh), params)
    return np.argwhere(mrmeshnumpy.getNumpy3Darray(volume) < 0)


def pymeshlab_distance(vertices: Array, faces: Array, points: Array) -> Array:
    import pymeshlab  # noqa: PLC0415

    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(vertices, faces), "mesh")
    meshes.add_mesh(pymeshlab.Mesh(points), "points")
    meshes.compute_scalar_by_distance_from_another_mesh_per_vertex(
        measuremesh=1, refmesh=0, signeddist=True, maxdist=pymeshlab.PureValue(1000.0)
    )
    return meshes.mesh(1).vertex_scalar_array() < 0


def stl_to_voxel(vertices: Array, faces: Array, low: Array, side: int) -> Array:
    from stltovoxel.convert import convert_meshes  # noqa: PLC0415

    points, frame = framed(vertices, low, side)
    solids, _, _ = convert_meshes([points[frame], points[faces]], voxel_size=np.ones(3), parallel=False)
    return np.argwhere(solids.transpose(2, 1, 0) == 2)


def warp_query(sign: str) -> Voxelizer:
    def is_inside(vertices: Array, faces: Array, points: Array) -> Array:
        import warp  # noqa: PLC0415

        sys.path.insert(0, str(Path(__file__).parent))
        import warp_kernels  # noqa: PLC0415

        warp.config.quiet = True
        mesh = warp.Mesh(
            warp.array(vertices, dtype=warp.vec3, device="cpu"),
            warp.array(faces.astype(np.int32).ravel(), dtype=warp.int32, device="cpu"),
            support_winding_number=True,
        )
        signs = warp.zeros(len(points), dtype=float, device="cpu")
        inputs = [mesh.id, warp.array(points, dtype=warp.vec3, device="cpu"), signs]
        warp.launch(getattr(warp_kernels, sign), len(points), inputs, device="cpu")
        return signs.numpy() < 0

    return by_points(is_inside)


def libigl_winding(vertices: Array, faces: Array, points: Array) -> Array:
    import igl  # noqa: PLC0415

    return igl.winding_number(vertices, faces.astype(np.int64), points) > 0.5


def openvdb(vertices: Array, faces: Array, low: Array, side: int) -> Array:
    import pyopenvdb  # noqa: PLC0415

    # Its voxels have whole numbers as centres.
    grid = pyopenvdb.FloatGrid.createLevelSetFromPolygons(vertices - low - 0.5, triangles=faces.astype(np.uint32))
    distances = np.zeros((side,) * 3)
    grid.copyToArray(distances)
    return np.argwhere(distances < 0)


def point_cloud_utils(vertices: Array, faces: Array, low: Array, _side: int) -> Array:
    import point_cloud_utils as pcu  # noqa: PLC0415

    return pcu.voxelize_triangle_mesh(vertices, faces.astype(np.int32), 1.0, low)


def voxquant(vertices: Array, faces: Array, low: Array, side: int) -> Array:
    import trimesh  # noqa: PLC0415 - it writes the file

    points, frame = framed(vertices - low, np.zeros(3), side)
    with tempfile.TemporaryDirectory() as folder:
        source, made = Path(folder) / "case.glb", Path(folder) / "case.vox"
        trimesh.Trimesh(points, np.concatenate([faces, frame]), process=False).export(source)
        program = Path(sys.prefix) / "bin" / "voxquant"
        subprocess.run([program, "-i", source, "-o", made, "--res", str(side)], check=True, capture_output=True)
        data = made.read_bytes()
    found, start = [], data.find(b"XYZI")
    while start >= 0:  # one for each part of the model, of 256 voxels per axis; those before the first are at 255
        (count,) = struct.unpack_from("<i", data, start + 12)
        found.append(np.frombuffer(data, np.uint8, 4 * count, start + 16).reshape(-1, 4)[:, :3].astype(int))
        start = data.find(b"XYZI", start + 16 + 4 * count)
    x, y, z = np.concatenate([np.zeros((0, 3), int), *found]).T
    voxels = np.stack([x, z, side - 1 - y], axis=1)  # its z is up
    at_corner = ((voxels == 0).all(axis=1)) | ((voxels == side - 1).all(axis=1))
    return np.unique(voxels[~at_corner], axis=0)


TOOLS: dict[str, Voxelizer] = {
    "voxrt touch": voxrt("touch"),
    "voxrt centre": voxrt("centre"),
    "voxrt half": voxrt("half"),
    "trimesh voxelized": trimesh_voxelized,
    "trimesh contains": by_points(trimesh_contains),
    "Open3D VoxelGrid": open3d_grid,
    "Open3D occupancy": by_points(open3d_occupancy),
    "PyVista": pyvista_mask,
    "MeshLib": meshlib,
    "PyMeshLab": by_points(pymeshlab_distance),
    "stl-to-voxel": stl_to_voxel,
    "Warp winding number": warp_query("winding_number"),
    "Warp parity": warp_query("parity"),
    "libigl": by_points(libigl_winding),
    "OpenVDB": openvdb,
    "point-cloud-utils": point_cloud_utils,
    "voxquant": voxquant,
}


def version_of(package: str) -> str:
    if package == "voxquant":
        program = Path(sys.prefix) / "bin" / "voxquant"
        return subprocess.run([program, "-V"], check=True, capture_output=True, text=True).stdout.split()[-1]
    if package == "python3-openvdb":
        import pyopenvdb  # noqa: PLC0415

        return ".".join(map(str, pyopenvdb.LIBRARY_VERSION))
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def main() -> None:
    tool, package, cases, out, first = sys.argv[1:]
    with np.load(cases) as arrays, Path(out).open("a", encoding="utf-8") as lines:
        print(json.dumps({"version": version_of(package)}), file=lines, flush=True)
        for index in range(int(first), int(arrays["count"])):
            vertices, faces, low = (arrays[f"{name}{index}"] for name in ("vertices", "faces", "low"))
            print(json.dumps({"case": index}), file=lines, flush=True)
            try:
                voxels = TOOLS[tool](vertices, faces, low, int(arrays[f"side{index}"]))
                line = {"case": index, "voxels": np.asarray(voxels).astype(int).tolist()}
            except Exception as error:  # noqa: BLE001 - whatever a tool raises is its answer
                line = {"case": index, "error": (str(error).splitlines() or [type(error).__name__])[0][:90]}
            print(json.dumps(line), file=lines, flush=True)


if __name__ == "__main__":
    main()
