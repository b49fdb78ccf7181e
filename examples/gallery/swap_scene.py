"""
Another scene on a running board
================================

The simulated core is driven in the same way as a board: by its registers, its memory port and its video stream. A
scene is written between two frames and read back for a check. ``voxrt upload`` does the same over a network.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import voxrt
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.core import open_rtl
from voxrt.board.view import View
from voxrt.boards.board_scenes import board_scene
from voxrt.export import Blob

EXAMPLES = Path(sys.argv[0]).resolve().parents[1]
device = open_rtl("tiny")
identity = device.identity
print(f"{identity.name}: {identity.capacity:,} words, {identity.depth} levels")


# %%
# Two scenes, one after the other.
def report(stage: str, done: int, total: int) -> None:
    """Print when a stage is finished."""
    if done == total:
        print(f"  {stage}: {total:,}")


memory, size, frames = SceneMemory(device), (240, 180), []
for name in ("house.obj", "dog.usda"):
    rom = voxrt.build(EXAMPLES / name, depth=6).rom
    memory.load(board_scene(Blob(rom)), report)
    view = View(voxrt.aim_camera(rom, size), size, background=rom.materials[0].colour)
    frames.append(device.frame(view))
    cost = frames[-1].counters
    print(f"{rom.name}: {cost.cycles / cost.rays:.2f} clocks per pixel, {cost.words_read / cost.rays:.2f} words")

# %%
# The registers after the last frame.
for register, value in device.registers().items():
    print(f"{register:14s} {value}")

picture = np.concatenate([frame.colour for frame in frames], axis=1)
plt.figure(figsize=(7.2, 2.7))
plt.imshow(picture)
plt.axis("off")
plt.tight_layout()
plt.show()
