"""``python -m voxrt.boards.scene_builder DEPTH MEMORY_DEPTH FILE ...`` builds the scenes of a frame server.

:func:`voxrt.boards.board_scenes.asset_reader` starts it. An empty argument stands for None.
It gives up the right to open other files than these and those of its own, where the kernel can take it (Linux).
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.boards.board_scenes import read_files
from voxrt.serve.scene_child import run_child
from voxrt.voxelize.file_sandbox import confine

if TYPE_CHECKING:
    from collections.abc import Sequence

    from voxrt.board.scene import Scene
    from voxrt.board.scene_memory import Progress


def _read(files: Sequence[Path], progress: Progress) -> Scene:
    confine({file.parent for file in files}, (Path(tempfile.gettempdir()),))
    depth, memory_depth = (int(number) if number else None for number in sys.argv[1:3])
    return read_files(files, progress, depth=depth, memory_depth=memory_depth)


if __name__ == "__main__":
    run_child(_read, sys.argv[3:])
