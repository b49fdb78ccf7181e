"""Files of memories by their suffix: which are read, and which are written without loss."""

from __future__ import annotations

import errno
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt.export.atomic import new_folder
from voxrt.export.blob import Blob, read_blob, write_blob
from voxrt.export.listing import read_listing
from voxrt.export.manifest import read_manifest
from voxrt.export.provenance import Provenance
from voxrt.export.rom_files import other_words, read_words, words_crc32, write_words
from voxrt.export.vox import read_vox
from voxrt.export.word_file import WORD_SUFFIXES
from voxrt.octree import RomError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from voxrt.voxelize import SceneWarning

BLOB_SUFFIX = ".blob"
LISTING_SUFFIX = ".txt"
VOX_SUFFIX = ".vox"

READABLE_SUFFIXES = (*WORD_SUFFIXES, BLOB_SUFFIX, LISTING_SUFFIX, VOX_SUFFIX)
"""The files that :func:`read_any` reads."""

WRITABLE_SUFFIXES = (*WORD_SUFFIXES, BLOB_SUFFIX)
"""The files that :func:`convert` writes."""


def read_any(
    path: Path | str,
    *,
    depth: int | None = None,
    dialect: str | None = None,
    colours: Mapping[str, tuple[int, int, int]] | None = None,
) -> tuple[Blob, tuple[SceneWarning, ...]]:
    """Read a memory: a file of words (its manifest beside it or not), a blob, a listing, a MagicaVoxel scene.

    Parameters
    ----------
    path
        The file. Its suffix, one of :data:`READABLE_SUFFIXES`, says what it is.
    depth
        Levels of the octree, if the file does not say: a file of words without a manifest, or a listing.
    dialect
        How the words encode materials, if the file does not say.
    colours
        sRGB colours by material name, for a listing.

    Returns
    -------
    blob
        What the file holds.
    warnings
        What the file does not say and was assumed.

    Raises
    ------
    RomError, AssetError
        The file is malformed, or its suffix is another.

    Examples
    --------
    >>> import voxrt
    >>> files = voxrt.build("examples/house.obj", "out", depth=4).outputs
    >>> blob, warnings = read_any(files["mem"])
    >>> blob.rom, warnings
    (<Rom 'house': depth 4, 721 words, 5 materials>, ())
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
    """Write a memory as a file that is read back without loss: words with a manifest, or a blob.

    The manifest keeps what is known of the build. If the memory does not say, and the words have a manifest there
    already, that one stays as it is. :func:`voxrt.convert` writes the forms of other programs too.

    Parameters
    ----------
    blob
        What :func:`read_any` read.
    target
        The file. Its suffix, one of :data:`WRITABLE_SUFFIXES`, says what it is. A file of words gets a manifest beside
        it.
    dialect
        How a file of words encodes materials. A blob is always ``"report"``, without mean materials.

    Returns
    -------
    tuple[Path, ...]
        The files written, the memory first.

    Raises
    ------
    RomError
        The suffix is another.
    DoesNotFitError
        The dialect cannot name a material in use.
    OSError
        A file cannot be written, or its manifest would replace that of a file with other words.

    Examples
    --------
    >>> import voxrt
    >>> rom = voxrt.build("examples/house.obj", depth=4).rom
    >>> [file.name for file in convert(Blob(rom), "house.mif")]
    ['house.mif', 'house.json']
    """
    target = Path(target)
    suffix = target.suffix.lower()
    if suffix == BLOB_SUFFIX:
        with new_folder(target.parent):
            write_blob(target, blob)
        return (target,)
    if suffix not in WORD_SUFFIXES:
        raise RomError(f"{target}: is not a format to write; name one of {', '.join(WRITABLE_SUFFIXES)}")
    blob = _with_known_provenance(blob, target, dialect)
    named = replace(blob, rom=replace(blob.rom, name=target.stem))
    files = write_words(target.parent, target.stem, target.suffix, named, dialect)
    return files.mem, files.manifest


def _with_known_provenance(blob: Blob, target: Path, dialect: str) -> Blob:
    """Complete what is known of a memory by the manifest that its words have where they go.

    FileExistsError where the manifest there belongs to another file, with other words.
    """
    path = target.with_suffix(".json")
    try:
        there = read_manifest(path)
    except RomError:  # none, or a damaged one
        return blob
    if there.crc32 != words_crc32(blob.rom, dialect, blob.animation):
        if other := other_words(target, there):
            raise FileExistsError(
                errno.EEXIST, f"{path.name} belongs to {other.name}, which has other words", str(target)
            )
        return blob
    if blob.provenance != Provenance():
        return blob
    return replace(
        blob,
        view=blob.view or there.view,
        lighting=blob.lighting or there.lighting,
        provenance=there.provenance,
        animation=blob.animation or there.animation,
    )
