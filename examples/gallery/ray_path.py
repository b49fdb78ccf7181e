"""
The path of a ray
=================

The words that the hardware reads for one pixel, in order. Pointers lead down to a leaf. The ray leaves an empty leaf
by the plane that it crosses first, and goes down again from the smallest block that contains both sides of that
plane. :doc:`/how-a-ray-walks` explains each step.
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
    is_what = f"material {reading.material}" if reading.is_leaf else f"pointer to {reading.word:#x}"
    print(
        f"{number:3d}  word {reading.address:#5x}  {1 << reading.level:3d} voxels at {reading.corner!s:14s} {is_what}"
    )
print(f"hits {rom.materials[path.material].name} at voxel {path.cell}")

# %%
# The pixel in the picture, and its ray seen from the side: empty leaves are blue, the leaf that it hits is red.
picture = voxrt.render(rom, camera, size=size).colour.copy()
column, row = pixel
picture[row - 6 : row + 7, [column - 6, column + 6]] = 255
picture[[row - 6, row + 6], column - 6 : column + 7] = 255

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6))
left.imshow(picture)
left.axis("off")
leaves = [reading for reading in path.readings if reading.is_leaf]
for reading in leaves:
    colour = "#d05030" if reading.material else "#a8c8e8"
    side = 1 << reading.level
    right.add_patch(
        plt.Rectangle(reading.corner[2:0:-1], side, side, facecolor=colour, edgecolor="k", linewidth=0.6, alpha=0.5)
    )
points = np.array([path.point(reading.time) for reading in leaves])
right.plot(points[:, 2], points[:, 1], "k.-", linewidth=1)
right.set(xlabel="z, voxels", ylabel="y, voxels", aspect="equal", xlim=(8, 33), ylim=(-1, 18))
plt.tight_layout()
plt.show()
