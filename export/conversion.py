"""Any file that holds a ROM to any other."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.export.blob import Blob, read_blob, write_blob
from voxrt.export.listing import read_listing
from voxrt.export.rom_files import WORD_SUFFIXES, read_words, write_rom
from voxrt.export.vox import read_vox
from voxrt.octree import RomError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from voxrt.voxelize import SceneWarning

BLOB_SUFFIX = ".blob"
LISTING_SUFFIX = ".txt"
VOX_SUFFIX = ".vox"

READABLE_SUFFIXES = (*WORD_SUFFIXES, BLOB_SUFFIX, LISTING_SUFFIX, VOX_SUFFIX)
WRITABLE_SUFFIXES = (*WORD_SUFFIXES, BLOB_SUFFIX)


def read_any(
    path: Path | str,
    *,
    depth: int | None = None,
    dialect: str | None = None,
    colours: Mapping[str, tuple[int, int, int]] | None = None,
) -> tuple[Blob, tuple[SceneWarning, ...]]:
    """Read a ROM from a file of words (with its manifest or without), a blob, a node listing or a MagicaVoxel scene.

    Parameters
    ----------
    path
        Its suffix, one of :data:`READABLE_SUFFIXES`, says what it is.
    depth, dialect
        What a file of words without manifest, or a listing, does not say.
    colours
        sRGB by material name, for a listing.

    Returns
    -------
    tuple[Blob, tuple[SceneWarning, ...]]
        What the file holds, and what was assumed of it.

    Raises
    ------
    RomError, AssetError
        Where the file is malformed, or of no kind that is read.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix == BLOB_SUFFIX:
        return read_blob(path), ()
    if suffix == LISTING_SUFFIX:
        return Blob(read_listing(path, colours or {}, depth)), ()
    if suffix == VOX_SUFFIX:
        rom, warnings = read_vox(path)
        return Blob(rom), warnings
    if suffix in WORD_SUFFIXES:
        return read_words(path, depth, dialect)
    raise RomError(f"{path}: is no file that holds an octree memory; name one of {', '.join(READABLE_SUFFIXES)}")


def convert(blob: Blob, target: Path | str, *, dialect: str = "report") -> tuple[Path, ...]:
    """Write `blob` under the name and in the format of `target`, and return the files written.

    Parameters
    ----------
    blob
        What :func:`read_any` read.
    target
        The file; its suffix is one of :data:`WRITABLE_SUFFIXES`. A file of words gets a manifest beside it.
    dialect
        How a file of words marks its leaves; a blob is always ``report``.
    """
    target = Path(target)
    suffix = target.suffix.lower()
    if suffix == BLOB_SUFFIX:
        write_blob(target, blob)
        return (target,)
    if suffix not in WORD_SUFFIXES:
        raise RomError(f"{target}: is no format to write; name one of {', '.join(WRITABLE_SUFFIXES)}")
    rom = replace(blob.rom, name=target.stem)
    files = write_rom(target.parent, rom, suffix=target.suffix, dialect=dialect, view=blob.view, lighting=blob.lighting)
    return files.mem, files.manifest
