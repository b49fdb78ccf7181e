"""
Cycles against depth
====================

The report expects a ray to cost O(log m + p), where m is the side of the world and p the number of steps (section
6.1.3). The ray tracer keeps a stack of the blocks on the way down. So a step starts at the smallest block that
contains both neighbours, and not at the root.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import voxrt

ROOT = Path(sys.argv[0]).resolve().parents[2]
depths = range(4, 11)
size = (128, 128)
plt.figure(figsize=(7, 4.5))
for name in ("courtyard.glb", "planet.glb"):
    cycles, words = [], []
    for depth in depths:
        rom = voxrt.build(ROOT / "examples" / name, depth=depth).rom
        cost = voxrt.render(rom, size=size, engine="rtl").cost
        cycles.append(cost.cycles / cost.rays)
        words.append(len(rom.octree.words))
    slope = np.polyfit(depths, cycles, 1)[0]
    print(f"{name:14s} " + " ".join(f"{value:6.2f}" for value in cycles) + f"   {slope:.2f} cycles per pixel and level")
    print(f"{'words':14s} " + " ".join(f"{count:6d}" for count in words))
    plt.plot(depths, cycles, "o-", label=name)
plt.xlabel("depth of the octree")
plt.ylabel("cycles per pixel, one lane")
plt.ylim(bottom=0)
plt.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, fontsize=8, frameon=False)
plt.grid(visible=True, alpha=0.3)
plt.tight_layout()
plt.show()
