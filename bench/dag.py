"""Shared octrees beside the literature: ``python bench/dag.py [--depths 10,11,12,13] [--write]``.

Surfaces of meshes, counted as papers on sparse voxel DAGs count: geometry alone, child masks with pointers of 32 bits,
cubes of 4 voxels per side as 64 bits. So materials are left out, and nodes are shared again. Beside the graph: the
memory as the hardware reads it; a plain octree in the same form and as ooc_svo_builder stores it (24 bytes per node,
down to single voxels); and what would remain if nodes that are equal up to mirroring were stored once (SSVDAG), an
analysis: neither files nor hardware have mirrors. One mesh is made here; meshes that are not there are left out.
"""

from __future__ import annotations

import argparse
import os
import platform
import time
from pathlib import Path

import numpy as np

import voxrt
from voxrt import octree

ROOT = Path(__file__).resolve().parents[1]
ASSETS = Path(os.environ.get("VOXRT_ASSETS", ROOT.parent / "shared" / "assets"))
RESULTS = ROOT / "bench" / "results" / "dag.md"
MESHES = (
    "ply/bunny.ply",
    "ply/dragon.ply",
    "obj/odedstein-meshes/skull/skull.obj",
    "ply/USD-Fileformat-plugins/gargo.ply",
    "stl/USD-Fileformat-plugins/car.stl",
)
OOC_NODE = 24
"""Bytes of a node of ooc_svo_builder: the address of its data, that of its first child, eight offsets."""

COLUMNS = (
    "mesh",
    "side",
    "voxels",
    "memory, words",
    "mirrored",
    "graph, nodes",
    "words",
    "MB",
    "bits per voxel",
    "mirrored nodes",
    "words",
    "plain octree, MB",
    "ooc_svo, MB",
    "s",
)


def wavy_sphere(rings: int) -> tuple[np.ndarray, np.ndarray]:
    """Give a closed surface of 4 * rings**2 triangles without symmetry: a sphere with waves of many lengths."""
    polar, around = np.meshgrid(np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False))
    points = np.stack([np.sin(polar) * np.cos(around), np.cos(polar), np.sin(polar) * np.sin(around)], axis=-1)
    random = np.random.default_rng(0)
    radius = np.ones(points.shape[:2])
    for octave in range(1, 7):
        for _ in range(4):
            wave = random.normal(size=3) * 2**octave
            radius += 0.12 / 2**octave * np.sin(points @ wave + random.uniform(0, 2 * np.pi))
    columns, rows = polar.shape
    a = (np.arange(columns)[:, None] * rows + np.arange(rows - 1)).ravel()
    b = ((np.arange(columns)[:, None] + 1) % columns * rows + np.arange(rows - 1)).ravel()
    faces = np.concatenate([np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)])
    return (points * radius[..., None]).reshape(-1, 3), faces


def row(name: str, scene: voxrt.Scene, depth: int) -> list[str]:
    """Build a surface and count its nodes."""
    begun = time.process_time()
    tree = voxrt.build(scene, depth=depth, fill="surface").rom.octree
    counts = octree.dag_census(tree)
    mirrored = octree.mirrored_blocks(tree)
    voxels = int(counts.tree_nodes[0])
    words = int(counts.words.sum())
    return [
        name,
        f"{tree.size:,}",
        f"{voxels:,}",
        f"{len(tree.words):,}",
        f"{1 + 8 * mirrored:,}",
        f"{counts.nodes.sum():,}",
        f"{words:,}",
        f"{words * 4e-6:,.2f}",
        f"{32 * words / voxels:.2f}",
        f"{counts.mirrored_nodes.sum():,}",
        f"{counts.mirrored_words.sum():,}",
        f"{counts.tree_words.sum() * 4e-6:,.1f}",
        f"{counts.tree_nodes.sum() * OOC_NODE * 1e-6:,.1f}",
        f"{time.process_time() - begun:.1f}",
    ]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--depths", default="10,11,12,13", help="levels, with commas between")
    parser.add_argument("--meshes", nargs="*", type=Path, help="other meshes than those of the shared folder")
    parser.add_argument("--write", action="store_true", help=f"write {RESULTS.name} too")
    options = parser.parse_args()
    scenes = {"wavy sphere": voxrt.mesh_scene(*wavy_sphere(200))}
    for path in options.meshes or [ASSETS / mesh for mesh in MESHES]:
        if path.is_file():
            scenes[path.stem] = voxrt.load(path)
        else:
            print(f"{path}: is not there and left out")
    lines = [f"| {' | '.join(COLUMNS)} |", "|---|" + "--:|" * (len(COLUMNS) - 1)]
    print("\n".join(lines) + "\n")
    for name, scene in scenes.items():
        for depth in map(int, options.depths.split(",")):
            lines.append(f"| {' | '.join(row(name, scene, depth))} |")
            print(lines[-1], flush=True)
    if options.write:
        RESULTS.write_text(
            ABOUT.format(machine=platform.machine(), python=platform.python_version()) + "\n".join(lines) + "\n"
        )


ABOUT = """# Shared octrees beside the literature

Surfaces (`--fill surface`), by `bench/dag.py`; {machine}, Python {python}; seconds are processor time of building and
counting. *memory*: words of 32 bits as the hardware reads them, with materials; *mirrored*: if blocks that are equal up
to mirroring along axes were stored once. *graph*: geometry alone, as the papers count: materials are left out and nodes
shared again; a node is a word with the child mask and a pointer of 32 bits per child, a cube of 4 voxels per side 64
bits. *mirrored nodes*: those that symmetry would leave, an analysis; their words have the same form, with the mirror in
three bits of a pointer. *plain octree*: the form of the graph without sharing. *ooc_svo*: 24 bytes per node down to
single voxels. MB are 10⁶ bytes.

For comparison, of other scenes: Kämpe, Sintorn, Assarsson (2013), EpicCitadel, 131,072 per side, 19 billion voxels:
945 MB, 0.4 bits per voxel. Jaspe-Villanueva, Marton, Gobbetti (2016), PowerPlant, 65,536 per side: 167 MB as a graph,
86 MB with symmetry, of which a part is shorter pointers: their nodes have pointers of 16 or 32 bits, ours 32.

"""


if __name__ == "__main__":
    main()
