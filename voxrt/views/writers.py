"""The files that a memory is written to: one table for ``voxrt convert``, ``voxrt view -o`` and the Python API."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from voxrt import export
from voxrt.export import Blob, write_npz, write_vox
from voxrt.export.outputs import check_folder, writing
from voxrt.octree import Rom, RomError
from voxrt.view import Pane
from voxrt.view.octant_files import write_glb, write_octants, write_ply
from voxrt.view.octant_page import write_page
from voxrt.voxelize.arguments import instance

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    WritePane: TypeAlias = Callable[[Path, Pane], None]


PANE_WRITERS: dict[str, WritePane] = {
    ".vox": lambda path, pane: write_vox(path, pane.rom, pane.high),
    ".npz": lambda path, pane: write_npz(path, pane.rom, pane.high),
    ".ply": lambda path, pane: write_ply(path, pane.rom, pane.mesh()),
    ".glb": lambda path, pane: write_glb(path, pane.rom, pane.mesh()),
    ".vtu": lambda path, pane: write_octants(path, pane.grid()),
    ".html": lambda path, pane: write_page(path, pane.rom, pane.mesh(), pane.faces),
}
"""How the octants that a pane shows are written, all of a memory or those that a cut leaves, by the file's suffix."""

WRITABLE_SUFFIXES = (*export.WRITABLE_SUFFIXES, *PANE_WRITERS)
"""The suffixes that :func:`convert` writes. Files of the first ones hold a memory with its words and all its frames."""


def convert(memory: Blob | Rom, target: str | os.PathLike[str], *, dialect: str = "report") -> tuple[Path, ...]:
    """Write a memory in the form that the name of a file asks for.

    ``.mem``, ``.coe``, ``.mif``, ``.bin`` and ``.blob`` hold all of the memory. ``.vox``, ``.npz``, ``.ply``,
    ``.glb``, ``.vtu`` and ``.html`` hold its voxels or octants, for other programs.

    Parameters
    ----------
    memory
        What :func:`read_any` read, or a memory with its materials.
    target
        The file. Its suffix, one of :data:`WRITABLE_SUFFIXES`, says what it becomes. Its folder is made if it is
        missing.
    dialect
        How a file of words encodes materials.

    Returns
    -------
    tuple[Path, ...]
        The files written, the memory first: files of words get a manifest beside them.

    Raises
    ------
    TypeError, ValueError
        `memory` is no memory, or there is no such dialect.
    RomError
        The suffix is another.
    DoesNotFitError
        The form cannot hold the memory.
    OutputError
        A file cannot be written.
    ViewerError
        ``.vtu`` needs PyVista, which is not installed.

    Examples
    --------
    >>> import voxrt
    >>> rom = voxrt.build("examples/house.obj", depth=4).rom
    >>> [file.name for file in voxrt.convert(rom, "house.glb")]
    ['house.glb']
    >>> [file.name for file in voxrt.convert(rom, "house.coe")]
    ['house.coe', 'house.json']
    """
    blob = memory if isinstance(memory, Blob) else Blob(instance("memory", memory, Rom))
    path = Path(target)
    suffix = path.suffix.lower()
    if suffix not in WRITABLE_SUFFIXES:
        raise RomError(f"{path}: is not a format to write; name one of {', '.join(WRITABLE_SUFFIXES)}")
    check_folder(path.parent)
    with writing(path):
        if suffix not in PANE_WRITERS:
            return export.convert(blob, path, dialect=dialect)
        PANE_WRITERS[suffix](path, Pane(blob.rom))
    return (path,)
