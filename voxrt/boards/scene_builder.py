"""``python -m voxrt.boards.scene_builder DEPTH MEMORY_DEPTH FILE ...`` builds the scenes of a frame server.

:func:`voxrt.boards.board_scenes.asset_reader` starts it. An empty argument stands for None.
"""

from __future__ import annotations

import sys
from functools import partial

from voxrt.boards.board_scenes import read_files
from voxrt.serve.scene_child import run_child

if __name__ == "__main__":
    depth, memory_depth, *files = sys.argv[1:]
    levels = (int(depth) if depth else None, int(memory_depth) if memory_depth else None)
    run_child(partial(read_files, depth=levels[0], memory_depth=levels[1]), files)
