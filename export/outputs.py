"""Where files may be written."""

from __future__ import annotations

import os
import re
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


_FILE = re.compile(r"\.\d?[A-Za-z]\w{0,4}")
"""Suffixes by which a name means a file: .obj and .3mf, and not those of versions, as in v0.2."""


class OutputError(Exception):
    """A file that cannot be written where the user wants it, in one line."""


def check_folder(folder: Path) -> None:
    """Refuse a folder that cannot be written to, before any work is done for it, with an OutputError."""
    nearest = folder
    while not nearest.exists() and nearest != nearest.parent:
        nearest = nearest.parent
    if not nearest.is_dir():
        raise OutputError(f"{folder}: {nearest} is a file, not a folder; name another folder")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise OutputError(f"{folder}: no permission to write in {nearest}; name another folder")


def check_output_folder(folder: Path, problem: str, fix: str) -> None:
    """Do the same for the folder that an output is, and refuse to make one with the name of a file.

    `problem` says what the suffix of such a name is, `fix` what to name in its place.
    """
    if _FILE.fullmatch(folder.suffix) and not folder.exists():
        raise OutputError(
            f"{folder}: {folder.suffix} is {problem}; {fix}; a folder with such a name must be there already"
        )
    check_folder(folder)


def check_file(path: Path) -> None:
    """Refuse a file that cannot be written, before any work is done for it, with an OutputError."""
    check_folder(path.parent)
    if path.is_dir():
        raise OutputError(f"{path}: is a folder; name a file")


@contextmanager
def writing(target: Path) -> Iterator[None]:
    """Make the folder of an output, and raise an OutputError that names the output instead of an OSError of the block.

    A folder that was made goes again if the block fails.
    """
    from voxrt.export.atomic import new_folder  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

    try:
        with new_folder(target.parent):
            yield
    except OSError as error:
        raise OutputError(f"{target}: cannot be written: {error.strerror or error}; name another place") from error
