"""The octree memories of the boards that we have designs for."""

from __future__ import annotations

import json
from pathlib import Path

# Data of a room above this one, whose code is not imported.
_DESIGNS = Path(__file__).resolve().parents[1] / "board" / "designs"


def _words_of(description: Path) -> int:
    return 1 + 8 * int(json.loads(description.read_bytes())["octree_blocks"])


# The design of pynq-z1 is made by Vivado: rtl/vivado.
_WORDS = {"pynq-z1": 1 + 8 * 4096} | {path.parent.name: _words_of(path) for path in _DESIGNS.glob("*/board.json")}
BOARDS = dict(sorted(_WORDS.items()))
"""Words of the octree memory of each board's design: blocks of 8, and the root."""
