"""Octants by file: PyVista's reader of memories (``pv.read("courtyard.mem")``) and what ParaView opens."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.export.convert import read_any
from voxrt.octree import octants

if TYPE_CHECKING:
    import pyvista


def read_octants(path: str, **_options: object) -> pyvista.UnstructuredGrid:
    """Read a memory, with its manifest or without, as the cells that :func:`voxrt.octree.octants` makes of it.

    PyVista finds this by the entry point ``pyvista.readers``, and hands on options that are meant for other readers.

    Raises
    ------
    RomError, AssetError
        The file is no memory.
    DoesNotFitError
        It holds too many octants to show.
    """
    return octants(read_any(path)[0].rom)


def write_octants(grid: pyvista.UnstructuredGrid, path: Path) -> None:
    """Write octants as a ``.vtu`` file, all of it or nothing.

    Raises
    ------
    OSError
        The file cannot be written.
    """
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.stem}-") as folder:
        whole = Path(folder, "octants.vtu")
        grid.save(whole)
        whole.replace(path)
