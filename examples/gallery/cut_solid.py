"""
A solid cut by booleans
=======================

Union, difference, intersection and hull of closed solids, in Python. ``scene.toml`` has the same operations. A ball
is hollow, and a wedge is cut out of it. The voxels show the hollow inside.
"""

import matplotlib.pyplot as plt

import voxrt
from voxrt import octree, voxelize
from voxrt.voxelize import authoring

ball = authoring.sphere(1.0)
shell = ball - authoring.sphere(0.86)
wedge = authoring.box_between((0, -1, 0), (1, 1, 1))
core = authoring.sphere(0.35) & authoring.box((0.6, 0.6, 0.6))
pins = authoring.cylinder(0.08, 2.4) | authoring.cylinder(0.08, 2.4).placed(rotate=(90, 0, 0))

made = authoring.Author("cut", background="#20242c")
for name, colour in {"crust": "#d9744c", "core": "#f5d76e", "steel": "#a8b4c4"}.items():
    made.material(name, colour)
made.add("core", core, material="core")
made.add("pins", pins - authoring.sphere(0.9), material="steel")
made.add("crust", shell - wedge - pins, material="crust")
scene = made.build()
print(f"crust: {(shell - wedge - pins).volume:.4f} cubic metres")

# %%
grid = voxelize.fit_grid(scene, depth=7)
voxels = voxelize.voxelize(scene, grid).voxels
rom = octree.Rom(scene.name, octree.build(voxels), scene.materials, grid)
solid = octree.census(rom.octree).voxels
print(f"crust: {solid[1] * grid.voxel_size**3:.4f} cubic metres of voxels, the partly covered ones included")

# %%
picture = voxrt.render(rom, size=(480, 480)).colour
plt.figure(figsize=(4.8, 4.8))
plt.imshow(picture)
plt.axis("off")
plt.tight_layout()
plt.show()
