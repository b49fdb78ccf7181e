"""A scene from the files of an octree memory. Run as a module, it is the child of a server: see scene_child.py."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from ..board.errors import Refused
from .blob import MAGIC as BLOB_MAGIC
from .blob import read_blob
from .mem_files import read_mem_files

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from ..board.scene import Scene
    from ..board.scene_memory import Progress

MEMORY_SUFFIXES = (".blob", ".mem")


def read_memory(paths: Sequence[Path], progress: Progress) -> Scene:
    """Read a blob, or a ``.mem`` with its ``.json``: all that a board can read without the rest of voxrt.

    Raises
    ------
    Refused
        The files are no scene.
    """
    progress("read", 0, 1)
    if len(paths) == 1:
        data = paths[0].read_bytes()
        if data.startswith(BLOB_MAGIC):
            return read_blob(data)
    suffixes = {path.suffix.lower(): path for path in paths}
    if suffixes.keys() == {".mem", ".json"} and len(paths) == 2:
        mem = suffixes[".mem"]
        return read_mem_files(mem.stem, mem.read_bytes(), suffixes[".json"].read_bytes())
    names = ", ".join(path.name for path in paths)
    raise Refused(f"{names}: neither a blob nor a .mem with its .json; upload one of them")


if __name__ == "__main__":
    from .scene_child import run_child

    run_child(read_memory, sys.argv[1:])
