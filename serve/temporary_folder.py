"""Folders for the files of clients, which are removed again."""

from __future__ import annotations

import tempfile
from contextlib import contextmanager
from typing import TYPE_CHECKING

from voxrt.board.errors import Refused

if TYPE_CHECKING:
    from collections.abc import Iterator


@contextmanager
def storing() -> Iterator[None]:
    """Raise an OSError as Refused: the folder of temporary files is full, or cannot be written."""
    try:
        yield
    except OSError as error:
        raise Refused(
            f"the server cannot store the files in {tempfile.gettempdir()}: {error.strerror or error}; make room there"
        ) from error


def temporary_folder() -> tempfile.TemporaryDirectory[str]:
    """Make a folder; Refused where that cannot be done. ``cleanup()`` removes it, and may be called again."""
    with storing():
        return tempfile.TemporaryDirectory(prefix="voxrt-files-", ignore_cleanup_errors=True)
