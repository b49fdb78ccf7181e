"""Octants by file: PyVista's reader of memories (``pv.read("courtyard.mem")``), and files for other programs."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.export.atomic import write_atomically
from voxrt.export.conversion import read_any
from voxrt.view.cells import octants

if TYPE_CHECKING:
    from pathlib import Path

    import pyvista
    from numpy.typing import NDArray

    from voxrt.octree import Rom
    from voxrt.view.octant_mesh import OctantMesh
    from voxrt.voxelize import Grid

_PLY_FACE = np.dtype([("count", "u1"), ("corners", "<i4", 3), ("colour", "u1", 3)])
_PLY_HEADER = """ply
format binary_little_endian 1.0
element vertex {points}
property double x
property double y
property double z
element face {faces}
property list uchar int vertex_indices
property uchar red
property uchar green
property uchar blue
end_header
"""


def read_octants(path: str, **_options: object) -> pyvista.UnstructuredGrid:
    """Read a memory, with its manifest or without, as the cells that :func:`voxrt.view.octants` makes of it.

    PyVista finds this by the entry point ``pyvista.readers``, and hands on options that are meant for other readers.
    RomError or AssetError where the file is no memory; DoesNotFitError where it holds too many octants to show.
    """
    return octants(read_any(path)[0].rom)


def write_octants(path: Path, grid: pyvista.UnstructuredGrid) -> None:
    """Write octants as a ``.vtu`` file for ParaView, all of it or nothing."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter  # noqa: PLC0415 - optional

    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    writer.WriteToOutputStringOn()
    writer.Write()
    write_atomically(path, writer.GetOutputString().encode())


def write_image(path: Path, fractions: NDArray[np.float64], grid: Grid) -> None:
    """Write a number per voxel ([x, y, z]) as a ``.vti`` file for ParaView, in metres, all of it or nothing."""
    pv: Any = import_module("pyvista")  # optional
    from vtkmodules.vtkIOXML import vtkXMLImageDataWriter  # noqa: PLC0415 - optional

    image = pv.ImageData(dimensions=np.array(fractions.shape) + 1, spacing=(grid.voxel_size,) * 3, origin=grid.origin)
    image.cell_data["fraction"] = fractions.ravel(order="F")
    writer = vtkXMLImageDataWriter()
    writer.SetInputData(image)
    writer.SetDataModeToBinary()
    writer.WriteToOutputStringOn()
    writer.Write()
    write_atomically(path, writer.GetOutputString().encode())


def write_glb(path: Path, rom: Rom, mesh: OctantMesh) -> None:
    """Write octants as a binary glTF file: one mesh per material, of the sides that can be seen.

    The file is in the scene's metres if the memory knows its place in the scene, else in voxels.
    """
    trimesh: Any = import_module("trimesh")  # slow to import

    scene = trimesh.Scene()
    points = _placed(rom, mesh)
    quads, cells = mesh.sides()
    materials = mesh.materials[cells]
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
        part = trimesh.Trimesh(
            points[used], triangles, process=False, visual=trimesh.visual.TextureVisuals(material=look)
        )
        scene.add_geometry(part, node_name=material.name, geom_name=material.name)

    colours = {material.name: [*_linear(material.colour), 1.0] for material in rom.materials}

    def paint(tree: dict[str, Any]) -> None:
        for entry in tree.get("materials", ()):  # trimesh keeps 8 bits per channel, too few for dark linear colours
            entry["pbrMetallicRoughness"]["baseColorFactor"] = colours[entry["name"]]

    write_atomically(path, scene.export(file_type="glb", tree_postprocessor=paint))


def write_ply(path: Path, rom: Rom, mesh: OctantMesh) -> None:
    """Write octants as a binary PLY file: the visible sides, each with the colour of its material.

    A side is two triangles: some readers split quads and keep the colours of the first halves alone. The file has the
    units of :func:`write_glb`.
    """
    quads, cells = mesh.sides()
    faces = np.zeros(2 * len(quads), _PLY_FACE)
    faces["count"], faces["corners"] = 3, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    colours = np.array([material.colour for material in rom.materials], np.uint8)[mesh.materials[cells]]
    faces["colour"] = colours.repeat(2, axis=0)
    points = _placed(rom, mesh).astype("<f8")
    write_atomically(
        path, _PLY_HEADER.format(points=len(points), faces=len(faces)).encode() + points.tobytes() + faces.tobytes()
    )


def _placed(rom: Rom, mesh: OctantMesh) -> NDArray[np.float64]:
    """Return the corners of octants in the scene's metres, or in voxels if the memory has no place in a scene."""
    origin, size = ((0.0, 0.0, 0.0), 1.0) if rom.grid is None else (rom.grid.origin, rom.grid.voxel_size)
    placed: NDArray[np.float64] = mesh.points.astype(np.float64) * size + origin
    return placed


def _linear(colour: tuple[int, int, int]) -> list[float]:
    """Return an sRGB colour as glTF stores it, linear (IEC 61966-2-1)."""
    share = np.array(colour) / 255
    linear: list[float] = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4).tolist()
    return linear
