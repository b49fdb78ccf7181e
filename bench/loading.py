"""Benchmark of loading: seconds for large files beside trimesh's own load of the same file.

Usage: ``python bench/loading.py [--assets FOLDER] [--write]``. Each time is the median of five to fifty. Files are
some of the folder of assets, and balls that are written for the purpose; ``--write`` puts the table into
``bench/results/loading.md`` as well.
"""

from __future__ import annotations

import platform
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import TYPE_CHECKING

import DracoPy
import numpy as np
import trimesh
from report import ASSETS as FOLDER
from report import ROOT, options_of, publish, table

from voxrt.voxelize.assets import load

sys.path.append(str(ROOT / "tests"))
from oracles.gltf_writer import GltfWriter

if TYPE_CHECKING:
    from collections.abc import Callable

REPEATS, MOST_REPEATS = 5, 50
ASSETS = (
    "obj/odedstein-meshes/skull/skull.obj",
    "ply/USD-Fileformat-plugins/gargo.ply",
    "ply/trimesh/cycloidal.ply",
    "gltf/glTF-Transform/functions/test/in/DenseSphere.glb",
)


def write_spheres(folder: Path) -> list[Path]:
    """Write one ball of 327,680 triangles in every format that trimesh writes."""
    ball = trimesh.creation.icosphere(subdivisions=7)
    paths = [folder / f"ball.{suffix}" for suffix in ("obj", "stl", "ply", "glb")]
    for path in paths:
        ball.export(path)
    ascii_stl, ascii_ply = folder / "ball_ascii.stl", folder / "ball_ascii.ply"
    ball.export(ascii_stl, file_type="stl_ascii")
    ball.export(ascii_ply, encoding="ascii")
    for name, data in trimesh.Scene(ball).export(file_type="gltf").items():
        (folder / name).write_bytes(data)
    paths += [ascii_stl, ascii_ply, folder / "model.gltf", _write_draco(folder / "ball_draco.glb", ball)]
    textured = folder / "ball_with_normals_and_coordinates.obj"
    uv = np.column_stack([np.arctan2(ball.vertices[:, 0], ball.vertices[:, 2]), ball.vertices[:, 1]])
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in ball.vertices]
    lines += [f"vt {u:.6f} {v:.6f}" for u, v in uv]
    lines += [f"vn {x:.6f} {y:.6f} {z:.6f}" for x, y, z in ball.vertices]
    lines += ["f " + " ".join(f"{i}/{i}/{i}" for i in face) for face in (ball.faces + 1).tolist()]
    textured.write_text("\n".join(lines) + "\n")
    return [*paths, textured]


def _write_draco(path: Path, ball: trimesh.Trimesh) -> Path:
    """Write a GLB whose only primitive is compressed with Draco."""
    data = DracoPy.encode(ball.vertices.astype(np.float32), ball.faces.astype(np.uint32))
    glb = GltfWriter()
    extension = {"KHR_draco_mesh_compression": {"bufferView": glb.view(data), "attributes": {"POSITION": 0}}}
    glb.json |= {"extensionsUsed": list(extension), "extensionsRequired": list(extension)}
    count = len(ball.vertices)
    glb.add("accessors", {"componentType": 5126, "type": "VEC3", "count": count, "min": [-1] * 3, "max": [1] * 3})
    glb.add("accessors", {"componentType": 5125, "type": "SCALAR", "count": ball.faces.size})
    glb.add("meshes", {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "extensions": extension}]})
    glb.show(mesh=0)
    return glb.save(path)


LOADERS: dict[str, Callable[[Path], object]] = {
    "voxrt": load,
    "trimesh": trimesh.load,
    "trimesh, `process=False`": lambda path: trimesh.load(path, process=False),
}


def repeat(loader: str, path: Path) -> float:
    times: list[float] = []
    while len(times) < REPEATS or (len(times) < MOST_REPEATS and sum(times) < 1):
        start = time.perf_counter()
        loaded = LOADERS[loader](path)
        times.append(time.perf_counter() - start)
        del loaded
    return median(times)


def measure(path: Path) -> tuple[str, ...]:
    """Give a row of the table; each loader has a process of its own, so that none finds the other's memory."""
    triangles = sum(len(one.mesh.triangles) for one in load(path).objects)
    command = [sys.executable, __file__, "--row", str(path)]
    runs = (subprocess.run([*command, name], check=True, capture_output=True, text=True) for name in LOADERS)
    return path.name, f"{triangles:,}", *(f"{float(run.stdout) * 1e3:.2f}" for run in runs)


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--assets", type=Path, default=FOLDER)
    parser.add_argument("--row", nargs=2, metavar=("FILE", "LOADER"), help="measure one loader and print its seconds")
    arguments = parser.parse_args()
    if arguments.row:
        print(repeat(arguments.row[1], Path(arguments.row[0])))
        return
    about = f"{platform.machine()}, Python {platform.python_version()}, trimesh {trimesh.__version__}"
    with tempfile.TemporaryDirectory() as folder:
        paths = write_spheres(Path(folder)) + [arguments.assets / name for name in ASSETS]
        rows = table(("file", "triangles", *LOADERS), [measure(path) for path in paths if path.exists()])
    publish("loading.md", f"# Loading\n\nMilliseconds; {about}.\n\n{rows}", write=arguments.write)


if __name__ == "__main__":
    main()
