"""What boot.hex of the page "Your first frame" draws, by the exact model."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.rtl.configurations import RTL
from voxrt.sim import _model

if TYPE_CHECKING:
    from pathlib import Path

MEMORY = 0x800000
BOOT = RTL / "first_frame" / "boot.hex"
SIZE = (32, 24)
FACES_AFTER_RESET = (189, 189, 140, 255, 219, 219)
"""-x, +x, -y, +y, -z, +z: docs/registers.md."""


def read_writes(file: Path = BOOT) -> list[tuple[int, int]]:
    return [tuple(int(part, 16) for part in line.split("_")) for line in file.read_text().split()]


def expected_frame():
    """uint8, shape (24, 32, 3)."""
    writes = dict(read_writes())
    words = np.array([writes[MEMORY + 4 * word] for word in range(9)], np.uint32)
    colours = np.zeros((256, 3), np.uint8)
    for material in range(4):
        colours[material] = list(writes[MATERIALS + 4 * material].to_bytes(3, "big"))
    camera = np.array(
        [
            [writes[REGISTERS[f"{name}[{axis}]"][0]] << shift for axis in range(3)]
            for name, shift in (("position", 0), ("look", 16), ("right", 16), ("up", 16))
        ],
        np.uint32,
    ).view(np.int32) >> np.array([[0], [16], [16], [16]])
    frame = _model.Memory(words, 1).render(
        colours, camera.astype(np.int32), *SIZE, brightness=np.array(FACES_AFTER_RESET, np.uint8)
    )
    assert set(np.unique(frame.material)) == {0, 1, 2, 3}
    return frame.colour
