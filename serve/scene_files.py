"""Readers of uploaded files; this one reads octree memories."""

from __future__ import annotations

from pathlib import PurePosixPath
from typing import TYPE_CHECKING, Protocol

from ..board.errors import Refused
from .blob import MAGIC as BLOB_MAGIC
from .blob import read_blob
from .mem_files import read_mem_files

if TYPE_CHECKING:
    from collections.abc import Mapping

    from ..board.scene import Scene
    from ..board.scene_memory import Progress


class SceneReader(Protocol):
    """Makes scenes from uploaded files. It is called in a thread of its own and may take long."""

    @property
    def suffixes(self) -> tuple[str, ...]:
        """Suffixes of the files that hold a scene, such as ``.mem``."""

    def __call__(self, files: Mapping[str, bytes], progress: Progress) -> Scene:
        """Make a scene from files, given by name.

        Raises
        ------
        Refused
            The files are no scene.
        """


class MemoryReader:
    """Reads a blob, or a ``.mem`` with its ``.json``: all that a board can read without the rest of voxrt."""

    suffixes: tuple[str, ...] = (".blob", ".mem")

    def __call__(self, files: Mapping[str, bytes], progress: Progress) -> Scene:
        """Make a scene from files, given by name.

        Raises
        ------
        Refused
            The files are no scene.
        """
        progress("read", 0, 1)
        if len(files) == 1 and (blob := next(iter(files.values()))).startswith(BLOB_MAGIC):
            return read_blob(blob)
        suffixes = {PurePosixPath(name).suffix.lower(): name for name in files}
        if suffixes.keys() == {".mem", ".json"} and len(files) == 2:
            mem = suffixes[".mem"]
            return read_mem_files(PurePosixPath(mem).stem, files[mem], files[suffixes[".json"]])
        raise Refused(f"{', '.join(files)}: neither a blob nor a .mem with its .json; upload one of them")
