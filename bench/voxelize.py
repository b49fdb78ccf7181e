"""Benchmark of the voxelizer: solid fill with materials, from scene arrays to sparse voxels and on to the octree.

Usage: ``python bench/voxelize.py [--threads N] [--write]``. Each row runs in a process of its own, so that the peak
memory is its own; times are the least of several runs, file loading apart. ``--write`` puts the table into
``bench/results/voxelize.md`` as well.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from report import ASSETS, machine, options_of, publish, table

from voxrt import octree
from voxrt.voxelize import EMPTY, Material, Mesh, Scene, SceneObject, fit_grid, load, voxelize

SKULL = ASSETS / "obj" / "odedstein-meshes" / "skull" / "skull.obj"
INSTANCES = ASSETS / "gltf" / "glTF-Blender-IO" / "24_gpu_instancing.gltf"
SPHERES = {"sphere-70k": 133, "sphere-810k": 451}
ROWS = [
    ("sphere-70k", 9),
    ("sphere-70k", 10),
    ("sphere-70k", 11),
    ("sphere-70k", 12),
    ("sphere-810k", 10),
    ("skull", 10),
    ("instances", 10),
]


def displaced_sphere(rings: int) -> Scene:
    """Give a closed sphere of 4 * rings * (rings - 1) triangles with bumps of several sizes."""
    segments = 2 * rings
    polar = np.linspace(0, np.pi, rings + 1)[1:-1]
    around = np.arange(segments) * 2 * np.pi / segments
    across = np.sin(polar)[:, None]
    body = np.stack(
        [across * np.cos(around), across * np.sin(around), np.repeat(np.cos(polar)[:, None], segments, axis=1)], axis=-1
    )
    directions = np.concatenate([[[0, 0, 1.0]], body.reshape(-1, 3), [[0, 0, -1.0]]])
    radius = np.ones(len(directions))
    random = np.random.default_rng(0)
    for frequency, height in ((3, 0.12), (9, 0.04), (27, 0.012), (80, 0.004)):
        for _ in range(3):
            axis = random.normal(size=3)
            wave = frequency * (directions @ axis) / np.linalg.norm(axis)
            radius += height * np.sin(wave + random.uniform(0, 6)) / 3
    left = np.arange(segments, dtype=np.int32)
    right = (left + 1) % segments
    row = 1 + segments * np.arange(rings - 2, dtype=np.int32)[:, None]
    a, b = (row + left).ravel(), (row + right).ravel()
    c, d = a + segments, b + segments
    last = 1 + (rings - 2) * segments
    north, south = np.zeros_like(left), np.full_like(left, len(directions) - 1)
    triangles = np.concatenate(
        [
            np.stack([north, 1 + left, 1 + right], axis=1),
            np.stack([a, c, b], axis=1),
            np.stack([b, c, d], axis=1),
            np.stack([south, last + right, last + left], axis=1),
        ]
    ).astype(np.int32, copy=False)
    mesh = Mesh(directions * radius[:, None], triangles, np.ones(len(triangles), np.uint8))
    return Scene("sphere", (SceneObject("sphere", mesh),), (EMPTY, Material("stone", (150, 150, 150))))


def scene_of(name: str) -> Scene:
    """Give a benchmark scene by its name in the table; spheres are made by a process of their own."""
    if name not in SPHERES:
        return load(SKULL if name == "skull" else INSTANCES)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "mesh.npz"
        subprocess.run([sys.executable, __file__, "--mesh", name, file], check=True)
        with np.load(file) as arrays:
            mesh = Mesh(arrays["positions"], arrays["triangles"], arrays["materials"])
    return Scene("sphere", (SceneObject("sphere", mesh),), (EMPTY, Material("stone", (150, 150, 150))))


def measure(name: str, depth: int, threads: int) -> dict[str, object]:
    scene = scene_of(name)
    grid = fit_grid(scene, depth=depth)
    seconds = {"voxels": float("inf"), "processor": float("inf"), "octree": float("inf")}
    result, tree = None, None
    for _ in range(5 if depth < 12 else 2):
        del result, tree
        start, processor = time.perf_counter(), time.process_time()
        result = voxelize(scene, grid, threads=threads)
        middle, processor = time.perf_counter(), time.process_time() - processor
        tree = octree.build(result.voxels, threads=threads)
        end = time.perf_counter()
        seconds["voxels"] = min(seconds["voxels"], middle - start)
        seconds["processor"] = min(seconds["processor"], processor)
        seconds["octree"] = min(seconds["octree"], end - middle)
    return {
        "scene": name,
        "side": 2**depth,
        "triangles": sum(len(item.mesh.triangles) for item in scene.objects),
        "solid": sum(report.voxels for report in result.objects),
        "words": len(tree.words),
        "peak": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024,
        **seconds,
    }


def main() -> None:
    """Run every row in its own process and print the table."""
    parser = options_of(__doc__)
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--row", nargs=2, metavar=("SCENE", "DEPTH"), help="measure one row and print it as JSON")
    parser.add_argument("--mesh", nargs=2, metavar=("SPHERE", "FILE"), help="write a sphere's arrays")
    arguments = parser.parse_args()
    if arguments.mesh:
        mesh = displaced_sphere(SPHERES[arguments.mesh[0]]).objects[0].mesh
        np.savez(arguments.mesh[1], positions=mesh.positions, triangles=mesh.triangles, materials=mesh.materials)
        return
    if arguments.row:
        print(json.dumps(measure(arguments.row[0], int(arguments.row[1]), arguments.threads)))
        return
    head = ("scene", "triangles", "grid", "solid voxels", "to voxels", "of all cores", "to octree", "words")
    rows = []
    for name, depth in ROWS:
        if (name == "skull" and not SKULL.exists()) or (name == "instances" and not INSTANCES.exists()):
            print(f"{name}: not below {ASSETS}", file=sys.stderr)
            continue
        command = [sys.executable, __file__, "--row", name, str(depth), "--threads", str(arguments.threads)]
        row = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        seconds = [f"{row[stage] * 1e3:.0f} ms" for stage in ("voxels", "processor", "octree")]
        cells = [row["scene"], f"{row['triangles']:,}", f"{row['side']}³", f"{row['solid']:,}", *seconds]
        rows.append((*cells, f"{row['words']:,}", f"{row['peak']} MB"))
    about = f"# Voxelizer\n\n{machine()}; threads: {arguments.threads or 'all'}\n\n"
    publish("voxelize.md", about + table((*head, "peak memory"), rows), write=arguments.write)


if __name__ == "__main__":
    main()
