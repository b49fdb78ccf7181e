"""Octants by file: PyVista's reader of memories (``pv.read("courtyard.mem")``), and files for other programs."""

from __future__ import annotations

import tempfile
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.export.atomic import write_atomically
from voxrt.export.conversion import read_any
from voxrt.view.cells import octants, open_sides

if TYPE_CHECKING:
    import pyvista

    from voxrt.octree import Rom


def read_octants(path: str, **_options: object) -> pyvista.UnstructuredGrid:
    """Read a memory, with its manifest or without, as the cells that :func:`voxrt.view.octants` makes of it.

    PyVista finds this by the entry point ``pyvista.readers``, and hands on options that are meant for other readers.

    Raises
    ------
    RomError, AssetError
        The file is no memory.
    DoesNotFitError
        It holds too many octants to show.
    """
    return octants(read_any(path)[0].rom)


def write_octants(path: Path, grid: pyvista.UnstructuredGrid) -> None:
    """Write octants as a ``.vtu`` file for ParaView, all of it or nothing.

    Raises
    ------
    OSError
        The file cannot be written.
    """
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.stem}-") as folder:
        whole = Path(folder, "octants.vtu")
        grid.save(whole)
        whole.replace(path)


def write_glb(path: Path, rom: Rom, grid: pyvista.UnstructuredGrid) -> None:
    """Write octants as a binary glTF file: a mesh a material, of the sides that can be seen.

    Parameters
    ----------
    path
        The file.
    rom
        The memory. Where it says how it stands in the scene the file is in the scene's metres, else in voxels.
    grid
        Some of its octants, by :func:`voxrt.view.octants`.

    Raises
    ------
    OSError
        The file cannot be written.
    """
    trimesh: Any = import_module("trimesh")  # slow to import

    scene = trimesh.Scene()
    origin, size = ((0.0, 0.0, 0.0), 1.0) if rom.grid is None else (rom.grid.origin, rom.grid.voxel_size)
    points = np.asarray(grid.points, np.float64).reshape(-1, 3) * size + origin
    quads, cells = open_sides(grid)
    materials = np.asarray(grid.cell_data["material"])[cells]
    for number in np.unique(materials):
        used, corners = np.unique(quads[materials == number], return_inverse=True)
        corners = corners.reshape(-1, 4)
        triangles = np.concatenate([corners[:, (0, 1, 2)], corners[:, (0, 2, 3)]])
        material = rom.materials[number]
        look = trimesh.visual.material.PBRMaterial(
            name=material.name,
            metallicFactor=1.0 if material.mirror else 0.0,
            roughnessFactor=0.0 if material.mirror else 1.0,
        )
        mesh = trimesh.Trimesh(
            points[used], triangles, process=False, visual=trimesh.visual.TextureVisuals(material=look)
        )
        scene.add_geometry(mesh, node_name=material.name, geom_name=material.name)

    colours = {material.name: [*_linear(material.colour), 1.0] for material in rom.materials}

    def paint(tree: dict[str, Any]) -> None:
        for entry in tree.get("materials", ()):  # trimesh keeps 8 bits a channel, too few for dark linear colours
            entry["pbrMetallicRoughness"]["baseColorFactor"] = colours[entry["name"]]

    write_atomically(path, scene.export(file_type="glb", tree_postprocessor=paint))


def _linear(colour: tuple[int, int, int]) -> list[float]:
    """Give an sRGB colour as glTF wants it, linear (IEC 61966-2-1)."""
    share = np.array(colour) / 255
    linear: list[float] = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4).tolist()
    return linear
