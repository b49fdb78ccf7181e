"""
Cycles against lanes
====================

Figure 38 of the report shows clock cycles per frame against ray processors, simulated: 1/n plus a constant, because
their pixel buffer asked one processor after another. Our design has a clear bound: each lane reads one octree word
per cycle, and one pixel per cycle leaves the shader.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(Path(sys.argv[0]).resolve().parents[1]))
from rtl_scenes import scenes

from rtl import LANES
from voxrt import export, octree, sim

size = (192, 192)
configurations = ["tiny", "duo", "quad", "octo", "z1"]
lanes = np.array([LANES[name] for name in configurations])
plt.figure(figsize=(7, 4.5))
print(f"{'cycles per pixel':24s}" + "".join(f"{count:>8d}" for count in lanes) + "  lanes")
for scene in scenes(Path(), size):
    rom = octree.Rom(scene.name, octree.Octree(scene.depth, scene.words), export.default_materials(255))
    camera = sim.Camera(*(tuple(map(int, row)) for row in scene.camera))
    costs = [sim.render(rom, camera, size, engine="rtl", config=name).cost for name in configurations]
    cycles = np.array([cost.cycles / cost.rays for cost in costs])
    words = costs[0].words_read / costs[0].rays
    print(f"{scene.name:24s}" + "".join(f"{value:8.2f}" for value in cycles))
    (line,) = plt.loglog(lanes, cycles, "o-", label=f"{scene.name}: {words:.1f} words per ray")
    plt.loglog(lanes, np.maximum(1, words / lanes), ":", color=line.get_color())
plt.xticks(lanes, map(str, lanes))
plt.xlabel("lanes")
plt.ylabel("cycles per pixel; dotted: the bound")
plt.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, fontsize=8, frameon=False)
plt.grid(visible=True, which="major", alpha=0.3)
plt.tight_layout()
plt.show()
