"""The set of files that a build writes: words, manifest and preview."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.export import WORD_SUFFIXES
from voxrt.octree import RomError
from voxrt.outputs import OutputError, check_folder
from voxrt.sources.source import as_text

if TYPE_CHECKING:
    import os


@dataclass(frozen=True, slots=True)
class OutputFiles:
    """Where a build writes.

    Attributes
    ----------
    name
        The name of the memory.
    words
        The file of words, its manifest beside it; None to write neither.
    preview
        The picture; None for none.
    named
        Whether the caller named the file of words, and not only its folder.
    """

    name: str
    words: Path | None
    preview: Path | None
    named: bool = False


def output_files(
    name: str, output: str | os.PathLike[str] | None, preview: str | os.PathLike[str] | bool
) -> OutputFiles:
    """Return the files of a build, whose folders can be written to.

    Parameters
    ----------
    name
        The name of the asset, as text.
    output
        The folder, the file of words, or None.
    preview
        The picture's file, or whether one is wanted.

    Raises
    ------
    OutputError
        A folder cannot be written to, or `output` has the suffix of a file that a build does not write.
    """
    words, named = None, False
    if output is not None:
        path = Path(output)
        named = path.suffix.lower() in WORD_SUFFIXES and not path.is_dir()
        if named:
            name = as_text(path.stem)
        words = path if named else path / f"{name}.mem"
        check_folder(words.parent)
    picture = None
    if preview:
        folder = Path() if words is None else words.parent
        picture = folder / f"{name}.preview.png" if preview is True else Path(preview)
        check_folder(picture.parent)
        if picture.is_dir():
            raise OutputError(f"{picture}: is a folder; name a file")
    return OutputFiles(name, words, picture, named)


def refuse_other_asset(words: Path, source: str) -> None:
    """Refuse to replace a memory that was built from another asset of the same stem.

    Raises
    ------
    OutputError
        The manifest beside `words` names another file than `source`.
    """
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
