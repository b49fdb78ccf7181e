"""
Hardware against software
=========================

Figures 46 and 47 of the report compare the picture of the board with the picture of its C++ program: they differ in
shade and along edges. Here are the pictures of our simulated hardware, of our exact model, and of the report's
algorithm. That algorithm steps by whole voxels towards the border of an octant, so it leaves the ray by a small
distance. It takes the normal of the first axis on whose border it stands. On a voxel of side one, this is always x
(section 2.4.1 of the report).
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(Path(sys.argv[0]).resolve().parents[1]))
from original import COLOURS, Original, level_camera

import voxrt
from voxrt import octree, sim
from voxrt.voxelize import Material

ROOT = Path(sys.argv[0]).resolve().parents[2]
size = (256, 256)
built = voxrt.build(ROOT / "examples" / "courtyard.glb", depth=7).rom
materials = [
    Material(material.name, tuple(map(int, COLOURS[number]))) for number, material in enumerate(built.materials)
]
rom = octree.Rom(built.name, built.octree, tuple(materials))
camera = level_camera(rom, size[0])
as_in_the_report = sim.Lighting(faces=None)
hardware = sim.render(rom, camera, size, engine="rtl", lighting=as_in_the_report)
model = sim.render(rom, camera, size, engine="model", lighting=as_in_the_report)
with Original(as_published=False) as program:
    _, original = program.render(rom, camera, size)

# %%
# Lower row, white: pixels whose colour differs from the exact model by more than 2 of 255.
pictures = {"our hardware": hardware.colour, "our exact model": model.colour, "the report's algorithm": original}
figure, places = plt.subplots(2, 3, figsize=(9, 6.3))
for column, (name, picture) in enumerate(pictures.items()):
    apart = np.abs(picture.astype(int) - model.colour.astype(int)).max(axis=-1)
    wrong = apart > 2
    missed = np.any(picture != 0, axis=-1) != (model.material != 0)
    print(f"{name:24s}{100 * wrong.mean():6.2f} % of pixels differ, {100 * missed.mean():.2f} % in whether they hit")
    places[0, column].imshow(picture)
    places[0, column].set_title(name, fontsize=9)
    places[1, column].imshow(wrong, cmap="gray", vmin=0, vmax=1)
    for row in (0, 1):
        places[row, column].axis("off")
plt.tight_layout()
plt.show()
