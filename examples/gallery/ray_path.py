"""
A ray's way
===========

What the hardware reads for one pixel, word by word: pointers on the way down, an empty leaf, the plane by which the ray
leaves it, and down again from the deepest block that both sides of that plane share.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import voxrt
from voxrt import sim

EXAMPLES = Path(sys.argv[0]).resolve().parents[1]
rom = voxrt.build(EXAMPLES / "courtyard.glb", depth=5).rom
size, pixel = (320, 240), (118, 88)
camera = voxrt.aim_camera(rom, size)
path = sim.follow_pixel(rom.octree, camera, size, pixel)
for number, reading in enumerate(path.readings, 1):
    is_what = f"material {reading.word & 255}" if reading.is_leaf else f"pointer to {reading.word:#x}"
    print(
        f"{number:3d}  word {reading.address:#5x}  {1 << reading.level:3d} voxels at {reading.corner!s:14s} {is_what}"
    )
print(f"hits {rom.materials[path.material].name} at voxel {path.cell}")

# %%
# Seen from the side: the octants of the leaves that it goes through, and the ray.
figure, places = plt.subplots(1, 2, figsize=(8, 3.4))
leaves = [reading for reading in path.readings if reading.is_leaf]
for reading in leaves:
    solid = reading.word & 255
    colour = "#d05030" if solid else "#a8c8e8"
    side = 1 << reading.level
    places[0].add_patch(
        plt.Rectangle(reading.corner[2:0:-1], side, side, facecolor=colour, edgecolor="k", linewidth=0.6, alpha=0.5)
    )
points = np.array([path.point(reading.time) for reading in leaves])
places[0].plot(points[:, 2], points[:, 1], "k.-", linewidth=1)
places[0].set(xlabel="z", ylabel="y", aspect="equal", xlim=(8, 33), ylim=(-1, 18))

# %%
# The pixel, in the picture.
picture = voxrt.render(rom, camera, size=size).colour
column, row = pixel
picture = picture.copy()
picture[row - 6 : row + 7, [column - 6, column + 6]] = 255
picture[[row - 6, row + 6], column - 6 : column + 7] = 255
places[1].imshow(picture)
places[1].axis("off")
plt.tight_layout()
plt.show()
