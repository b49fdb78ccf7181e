"""The files that a memory is written to: one table for ``voxrt convert``, ``voxrt view -o`` and the Python API."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from voxrt import export
from voxrt.export import Blob, write_npz, write_vox
from voxrt.octree import Rom, RomError
from voxrt.outputs import check_folder, writing
from voxrt.view import Pane
from voxrt.view.octant_files import write_glb, write_octants, write_ply
from voxrt.view.octant_page import write_page
from voxrt.voxelize.arguments import instance

if TYPE_CHECKING:
    import os
    from collections.abc import Callable

    WritePane: TypeAlias = Callable[[Path, Pane], None]


@dataclass(frozen=True, slots=True)
class Writer:
    """How the files of one suffix are written.

    `form` is what the file is, for people. `write_pane` writes the octants that a pane shows: all of a memory, or those
    that a cut leaves. It is None for files that hold a memory with its words.
    """

    form: str
    write_pane: WritePane | None = None


WRITERS: dict[str, Writer] = {
    ".mem": Writer("words for $readmemh, with a manifest"),
    ".coe": Writer("words for AMD (Xilinx) tools, with a manifest"),
    ".mif": Writer("words for Intel (Altera) tools, with a manifest"),
    ".bin": Writer("words of 32 bits, least significant byte first, with a manifest"),
    ".blob": Writer("a whole scene in one file, for boards"),
    ".vox": Writer("a MagicaVoxel scene", lambda path, pane: write_vox(path, pane.rom, pane.high)),
    ".npz": Writer("NumPy arrays of the solid voxels", lambda path, pane: write_npz(path, pane.rom, pane.high)),
    ".ply": Writer("a PLY mesh of the visible sides", lambda path, pane: write_ply(path, pane.rom, pane.mesh())),
    ".glb": Writer("a glTF scene of the visible sides", lambda path, pane: write_glb(path, pane.rom, pane.mesh())),
    ".vtu": Writer("octants for ParaView and PyVista", lambda path, pane: write_octants(path, pane.grid())),
    ".html": Writer(
        "a page that shows the octants", lambda path, pane: write_page(path, pane.rom, pane.mesh(), pane.faces)
    ),
}
"""How files are written, by their suffix."""

WRITABLE_SUFFIXES = tuple(WRITERS)
"""The suffixes that :func:`convert` writes."""

PANE_WRITERS: dict[str, WritePane] = {
    suffix: writer.write_pane for suffix, writer in WRITERS.items() if writer.write_pane is not None
}
"""The writers of files that can hold a part of a memory."""

WORD_WRITERS = frozenset(WRITERS) - set(PANE_WRITERS)
"""The suffixes of files that hold a memory with its words, and all frames of an animation."""


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
    if suffix not in WRITERS:
        raise RomError(f"{path}: is not a format to write; name one of {', '.join(WRITABLE_SUFFIXES)}")
    check_folder(path.parent)
    with writing(path):
        if suffix in WORD_WRITERS:
            return export.convert(blob, path, dialect=dialect)
        PANE_WRITERS[suffix](path, Pane(blob.rom))
    return (path,)
