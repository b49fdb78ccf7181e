"""
Which voxels are filled
=======================

A solid meets more voxels than it fills. ``--rule`` says which of them are filled: ``touch``, the default, takes all.
``centre`` takes those whose centre lies in the solid, so that volumes are right on average. ``--thin`` says what
becomes of parts that are too thin for that.
"""

# %%
# A ball and three bars in one layer of a coarse grid. Lines show the solids. ``centre`` alone loses the thin bars, or
# breaks them. With ``--thin keep`` every voxel that a solid touches is filled or has a filled neighbour.
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import voxrt
from voxrt import octree
from voxrt.voxelize import Grid, authoring, voxelize

EXAMPLES = Path(sys.argv[0]).resolve().parents[1]
CHOICES = {"touch": {}, "centre, thin parts dropped": {"rule": "centre", "thin": "drop"}, "centre": {"rule": "centre"}}
BARS = {"thin": (16.0, 20.7, 0.15), "narrow": (16.0, 24.2, 0.7), "wide": (16.0, 28.0, 1.6)}  # x, y, width

yard = authoring.Author("yard")
yard.material("stone", "#d98b3a")
yard.add("ball", authoring.sphere(7.2, centre=(16.3, 9.1, 4.5)), material="stone")
for name, (x, y, width) in BARS.items():
    bar = authoring.box((28, width, 9), centre=(0, 0, 4.5))
    yard.add(name, bar, translate=(x, y, 0), rotate=(0, 0, 12), material="stone")
scene = yard.build()

figure, places = plt.subplots(1, 3, figsize=(9.6, 3.6))
turn = np.linspace(0, 2 * np.pi, 100)
for place, (title, choice) in zip(places, CHOICES.items(), strict=True):
    voxels = voxelize(scene, Grid(5, (0, 0, 0), 1.0), **choice).voxels
    layer = octree.to_dense(octree.build(voxels), (0, 0, 4), (32, 32, 5))[:, :, 0] != 0
    place.imshow(np.where(layer.T, 0.25, 0), origin="lower", extent=(0, 32, 0, 32), cmap="Oranges", vmin=0, vmax=1)
    place.plot(16.3 + 7.2 * np.cos(turn), 9.1 + 7.2 * np.sin(turn), "k", linewidth=0.8)
    for x, y, width in BARS.values():
        corners = np.array([(-14, -width / 2), (14, -width / 2), (14, width / 2), (-14, width / 2), (-14, -width / 2)])
        along = np.array([np.cos(np.radians(12)), np.sin(np.radians(12))])
        place.plot(*((x, y) + corners @ [along, (-along[1], along[0])]).T, "k", linewidth=0.8)
    place.set(
        title=title, xlim=(0, 32), ylim=(0, 32), xticks=range(33), yticks=range(33), xticklabels=[], yticklabels=[]
    )
    place.grid(linewidth=0.3)
    place.tick_params(length=0)
plt.tight_layout()
plt.show()

# %%
# The courtyard with 64 voxels per side: by ``touch`` on the left, by ``centre`` on the right.
built = [voxrt.build(EXAMPLES / "courtyard.glb", depth=6, rule=rule) for rule in ("touch", "centre")]
camera = voxrt.aim_camera(built[0].rom, (480, 400))
pictures = [voxrt.render(one.rom, camera, size=(480, 400), samples=2, background="#eef1f5").colour for one in built]
picture = np.concatenate(pictures, axis=1)
plt.figure(figsize=(9.6, 4))
plt.imshow(picture)
plt.axis("off")
plt.tight_layout()
plt.show()

# %%
# Volumes: a ball of radius 7.2 voxels has 1,563.5 voxels of volume.
for title, choice in CHOICES.items():
    ball = authoring.Author("ball")
    ball.material("stone", "#d98b3a")
    ball.add("ball", authoring.sphere(7.2, centre=(16.3, 9.1, 16.4)), material="stone")
    made = voxelize(ball.build(), Grid(5, (0, 0, 0), 1.0), **choice)
    print(f"{title:28s}{made.objects[0].voxels:6,d} voxels")
