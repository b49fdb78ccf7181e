"""
MagicaVoxel art
===============

A ``.vox`` file is already made of voxels. It becomes an octree memory without a change, in the artist's colours. A
NumPy array of material numbers becomes one in the same way.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import voxrt
from voxrt import export, octree

EXAMPLES = Path(sys.argv[0]).resolve().parents[1]
art, warnings = export.read_vox(EXAMPLES / "toadstool.vox")
names = [f"#{red:02x}{green:02x}{blue:02x}" for red, green, blue in (material.colour for material in art.materials[1:])]
solid = octree.census(art.octree).solid_voxels
print(f"{art.octree.size} voxels per side, {solid:,} solid; colours {', '.join(names)}")

# %%
# The memory as an array of numbers, and sixteen copies of it in one world. Equal blocks are stored once.
cube = octree.to_dense(art.octree)
field = np.tile(cube, (4, 1, 4))
world = np.zeros((4 * art.octree.size,) * 3, np.uint8)
world[: field.shape[0], : field.shape[1], : field.shape[2]] = field
copies = octree.Rom("field", octree.from_dense(world), art.materials)
print(f"one takes {len(art.octree.words):,} words, sixteen take {len(copies.octree.words):,}")

# %%
picture = np.concatenate([voxrt.render(rom, size=(360, 360)).colour for rom in (art, copies)], axis=1)
plt.figure(figsize=(7.2, 3.6))
plt.imshow(picture)
plt.axis("off")
plt.tight_layout()
plt.show()
