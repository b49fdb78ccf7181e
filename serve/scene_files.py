"""Scenes from uploaded files: what a board reads by itself."""

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
    """What turns uploaded files into a scene; called in a thread of its own, may take long."""

    @property
    def suffixes(self) -> tuple[str, ...]:
        """Suffixes of the files that it begins with, such as ``.mem``."""

    def __call__(self, files: Mapping[str, bytes], progress: Progress) -> Scene:
        """Make the scene, or raise :class:`~.errors.Refused`."""


class BoardReader:
    """Reads what needs no building: a blob, or a ``.mem`` with its ``.json``."""

    suffixes: tuple[str, ...] = (".blob", ".mem")

    def __call__(self, files: Mapping[str, bytes], progress: Progress) -> Scene:
        """Make the scene, or raise :class:`~.errors.Refused`."""
        progress("read", 0, 1)
        if len(files) == 1 and (blob := next(iter(files.values()))).startswith(BLOB_MAGIC):
            return read_blob(blob)
        suffixes = {PurePosixPath(name).suffix.lower(): name for name in files}
        if suffixes.keys() == {".mem", ".json"} and len(files) == 2:
            mem = suffixes[".mem"]
            return read_mem_files(PurePosixPath(mem).stem, files[mem], files[suffixes[".json"]])
        raise Refused(f"{', '.join(files)}: no blob, and not a .mem with the .json beside it; give both together")
