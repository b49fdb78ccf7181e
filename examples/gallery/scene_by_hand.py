"""
A scene written by hand
=======================

Boxes of several materials, a house and a dog, without a 3D program. ``examples/playground.toml`` describes the scene,
and ``examples/playground.py`` makes the same scene in Python.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import voxrt
from voxrt import sim

EXAMPLES = Path(sys.argv[0]).resolve().parents[1]
built = voxrt.build(EXAMPLES / "playground.toml", depth=7)
print(f"{len(built.objects)} objects, {built.solid_voxels:,} voxels, {len(built.rom.octree.words):,} words")

# %%
# Rendered by the simulated hardware. Each side of a block has its own brightness. Every clock cycle is counted.
size = (480, 360)
camera = sim.look_at((130, 80, 160), (58, 20, 64), size=size)
plain = sim.render(built.rom, camera, size, engine="rtl")
cost = plain.cost
print(f"{cost.cycles / cost.rays:.2f} cycles per pixel, {cost.words_read / cost.rays:.2f} words per pixel")

# %%
# With a light that casts shadows. The ball is a mirror. ``docs/shading.md`` defines every colour exactly.
lighting = sim.Lighting((16 * 96, 16 * 150, 16 * 190), on=True, bounces=4)
lit = sim.render(built.rom, camera, size, engine="model", lighting=lighting)

picture = np.concatenate([plain.colour, lit.colour], axis=1)
plt.figure(figsize=(9.6, 3.6))
plt.imshow(picture)
plt.axis("off")
plt.tight_layout()
plt.show()
