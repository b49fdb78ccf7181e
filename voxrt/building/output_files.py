"""The set of files that a build writes: words, manifest and preview."""

from __future__ import annotations

import os
from pathlib import Path

from msgspec import Struct

from voxrt.export import WORD_SUFFIXES
from voxrt.export.outputs import OutputError, check_file, check_folder, check_output_folder
from voxrt.octree import RomError
from voxrt.voxelize.formats.external_files import as_text


class OutputFiles(Struct, frozen=True):
    """Where a build writes."""

    name: str  # the name of the memory
    source: str  # what the manifest calls the asset
    words: Path | None  # the file of words, its manifest beside it; None to write neither
    preview: Path | None  # the picture; None for none

    @property
    def tiles(self) -> Path | None:
        """The folder for tiles, while the build lasts."""
        return None if self.words is None else self.words.with_name(f"{self.words.stem}.tiles")


def output_files(
    name: str, file_name: str | None, output: str | os.PathLike[str] | None, preview: str | os.PathLike[str] | bool
) -> OutputFiles:
    """Return the files of a build, which can be written. `file_name`: that of the asset; None for one in memory.

    TypeError if `output` is no path.
    OutputError if a folder cannot be written to, or has a memory that was built from another asset of the same stem.
    """
    words, named = None, False
    if output is not None:
        if not isinstance(output, str | os.PathLike):
            raise TypeError(f"output must be the path of a folder or of a file, not {type(output).__name__}")
        path = Path(output)
        named = path.suffix.lower() in WORD_SUFFIXES and not path.is_dir()
        if named:
            name = as_text(path.stem)
            check_folder(path.parent)
        else:
            fix = f"name a file with one of {', '.join(WORD_SUFFIXES)}, or a folder"
            check_output_folder(path, "no format of memories", fix)
        words = path if named else path / f"{name}.mem"
    picture = None
    if preview:
        folder = Path() if words is None else words.parent
        picture = folder / f"{name}.preview.png" if preview is True else Path(preview)
        check_file(picture)
    source = name if file_name is None else file_name
    if words is not None and not named:
        _refuse_other_asset(words, source)
    return OutputFiles(name, source, words, picture)


def _refuse_other_asset(words: Path, source: str) -> None:
    """Refuse to replace a memory whose manifest names another file than `source`."""
    if not words.exists():
        return
    from voxrt.export import read_manifest  # noqa: PLC0415 - most builds replace nothing

    try:
        there = read_manifest(words.with_suffix(".json")).source
    except RomError:  # none, or a damaged one
        return
    if there is not None and there.file != source:
        raise OutputError(
            f"{words}: was built from {there.file}, not from {source}; name another folder or file, such as "
            f"-o {words.with_stem(words.stem + '-2')}"
        )
