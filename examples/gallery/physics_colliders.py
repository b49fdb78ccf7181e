"""
Colliders of a USD scene
========================

A box that does not lie on the grid of the octree becomes many small octants. Each box of ``examples/dog.usda`` has a
physics collider. voxrt rounds the sides of these boxes up to powers of two voxels, and moves their corners onto
coarser grid lines. Then a box is a few large octants. The report of each object says how far it grew and moved.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import voxrt
from voxrt import octree

EXAMPLES = Path(sys.argv[0]).resolve().parents[1]
rounded = voxrt.build(EXAMPLES / "dog.usda", depth=7)
exact = voxrt.build(EXAMPLES / "dog.usda", depth=7, pow2="none")
for name, built in (("rounded", rounded), ("exact", exact)):
    count = octree.census(built.rom.octree).leaves[:, 1:].sum()
    print(f"{name}: {built.solid_voxels:,} voxels in {count:,} leaves, {len(built.rom.octree.words):,} words")
for report in rounded.objects[:4]:
    print(report.name, "grew by", [float(f"{side:.2f}") for side in report.grown], "voxels")

# %%
# Rounded on the left, exact on the right, seen by the same camera.
size = (360, 360)
camera = voxrt.aim_camera(rounded.rom, size)
picture = np.concatenate([voxrt.render(built.rom, camera, size=size).colour for built in (rounded, exact)], axis=1)
plt.figure(figsize=(7.2, 3.6))
plt.imshow(picture)
plt.axis("off")
plt.tight_layout()
plt.show()

# %%
# A cut through the middle of the body shows the octants: few large ones with rounding, many small ones without.
figure, places = plt.subplots(1, 2, figsize=(7.2, 3.6))
for place, built in zip(places, (rounded, exact), strict=True):
    low, high = octree.solid_bounds(built.rom.octree)
    cut = (low[0] + high[0]) // 2
    for found in octree.leaves(built.rom.octree, (cut, 0, 0), (cut + 1, 128, 128), solid_only=True):
        for (_, y, z), level in zip(found.corners, found.levels, strict=True):
            side = 1 << level
            place.add_patch(plt.Rectangle((z, y), side, side, facecolor="#ecaa5c", edgecolor="k", linewidth=0.4))
    place.set(xlim=(0, 128), ylim=(0, 96), aspect="equal")
    place.axis("off")
plt.tight_layout()
plt.show()
