"""
One memory, many frames
=======================

A ball jumps across a yard. All frames are in one memory, and equal blocks of it are stored once: the walls and the
ground, in which no frame differs, cost their words once. A frame is shown by one write to the register ``root``.
``voxrt build walk.glb --frames 0:2:24`` does the same with the animation of a file.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation

import voxrt
from voxrt.voxelize import Scene, authoring

COUNT = 16


def yard(number: int) -> Scene:
    """Make the scene of a frame."""
    author = authoring.Author("jump")
    author.material("grass", "#5b8c4a")
    author.material("brick", "#a5573f")
    author.material("ball", "#e8c23c")
    author.add("ground", authoring.box((16, 1, 16), centre=(8, 0.5, 8)), material="grass")
    author.add("wall", authoring.box((16, 5, 1), centre=(8, 3.5, 0.5)), material="brick")
    author.add("pillar", authoring.box((1, 7, 1), centre=(0.5, 4.5, 15.5)), material="brick")
    angle = 2 * np.pi * number / COUNT
    place = (8 + 4.5 * np.cos(angle), 2.5 + 4 * abs(np.sin(2 * angle)), 8.5 + 4.5 * np.sin(angle))
    author.add("ball", authoring.sphere(1.5, centre=place), material="ball")
    return author.build()


built = voxrt.build_animation([yard(number) for number in range(COUNT)], depth=6)
animation = built.animation
print(f"{len(animation.frames)} frames, {len(built.octree.words):,} words; alone {animation.words_alone:,}")

# %%
# The words of frame k are those of its own octree. Together the frames take far fewer than their sum.
alone = np.cumsum([frame.words for frame in animation.frames])
shared = [
    len(voxrt.octree.join_frames(built.blob.frame(row).octree for row in range(count))[0].words)
    for count in range(1, COUNT + 1)
]
plt.figure(figsize=(5, 3))
plt.plot(range(1, COUNT + 1), alone / 1000, label="each frame alone")
plt.plot(range(1, COUNT + 1), np.array(shared) / 1000, label="one memory")
plt.xlabel("frames")
plt.ylabel("thousand words")
plt.legend()
plt.tight_layout()

# %%
# One camera for all of them: the ball stays in the picture. The film is also a GIF file.
size = (240, 180)
camera = voxrt.animation_camera(built.blob, size)
pictures = [voxrt.render(built.rom, camera, size=size, root=root).colour for root in animation.roots]
with TemporaryDirectory() as folder:
    file = Path(folder, "jump.gif")
    voxrt.save_animation(pictures, file, period=0.08)
    print(f"{file.name}: {file.stat().st_size / 1000:.0f} kB")

figure = plt.figure(figsize=(4, 3))
shown = plt.imshow(pictures[0])
plt.axis("off")
plt.tight_layout()


def show(number: int) -> None:
    """Show a frame in the figure."""
    shown.set_data(pictures[number])


film = FuncAnimation(figure, show, frames=COUNT, interval=80)
figure.canvas.draw()
picture = np.concatenate([pictures[0], pictures[5], pictures[10]], axis=1)
plt.show()
