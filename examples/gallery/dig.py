"""
Dig in it
=========

A mine is dug while the picture turns. Each frame takes a few spheres out of the ground and commits: the patch is what a
device writes before it shows the new octree, a few kilobytes, while it still draws the old one. ``voxrt edit`` does the
same by a script.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.animation import FuncAnimation

import voxrt
from voxrt.octree import from_dense
from voxrt.views.viewpoint import orbit

SIDE, FRAMES, STROKES = 128, 48, 4
NAMES = (("empty", "#10141c"), ("grass", "#5b8c4a"), ("earth", "#7a5c3e"), ("rock", "#8a8d91"), ("gold", "#f2c230"))
materials = tuple(
    voxrt.Material(name, tuple(int(colour[digit : digit + 2], 16) for digit in (1, 3, 5))) for name, colour in NAMES
)

# %%
# A meadow on earth and rock, with veins of gold, which nobody sees yet.
x, y, z = np.indices((SIDE, SIDE, SIDE))
surface = 84 + np.rint(5 * np.sin(x / 15) + 4 * np.cos(z / 11)).astype(int)
ground = np.select([y > surface, y > surface - 3, y > surface - 16], [0, 1, 2], 3)
vein = np.abs(np.sin(x / 9 + y / 13) + np.cos(z / 8 - y / 17)) < 0.12
ground[(ground == 3) & vein] = 4
rom = voxrt.Rom("mine", from_dense(ground.astype(np.uint8)), materials)
world = voxrt.World(rom)
print(world)

# %%
# The mine goes down in a spiral. Whoever digs hits the first voxel below the tool, as in a game: a pick is a ray.
size = (240, 180)
cameras = orbit(rom, size, 2 * FRAMES)
pictures, patches = [], []
for frame in range(FRAMES):
    older = world.live_roots[-1]
    for stroke in range(STROKES):
        part = (frame + stroke / STROKES) / FRAMES
        angle, radius = 10 * np.pi * part, 44 - 36 * part
        place = SIDE / 2 + np.rint(16 * radius * np.array([np.cos(angle), np.sin(angle)])) / 16
        hit = voxrt.pick(world, (place[0], SIDE, place[1]), (0, -1, 0))
        world.fill(voxrt.Sphere(hit.voxel, 7), 0)
    patches.append(world.commit())
    world.release(older)
    pictures.append(voxrt.render(world.rom(), cameras[frame], size=size).colour)

sizes = [4 * patch.words / 1000 for patch in patches]
print(
    f"{FRAMES} patches of {min(sizes):.1f} to {max(sizes):.1f} kB; the memory has {4 * len(world.image) / 1000:.0f} kB"
)

# %%
# The film is a GIF file, too.
with TemporaryDirectory() as folder:
    file = Path(folder, "dig.gif")
    voxrt.save_animation(pictures, file, period=0.08)
    print(f"{file.name}: {file.stat().st_size / 1000:.0f} kB")

figure = plt.figure(figsize=(4, 3))
shown = plt.imshow(pictures[0])
plt.axis("off")
plt.tight_layout()


def show(number: int) -> None:
    """Show a frame in the figure."""
    shown.set_data(pictures[number])


film = FuncAnimation(figure, show, frames=FRAMES, interval=80)
figure.canvas.draw()
picture = np.concatenate([pictures[0], pictures[FRAMES // 2], pictures[-1]], axis=1)
plt.show()
