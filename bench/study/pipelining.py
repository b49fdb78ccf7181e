"""
What pipelining gains
=====================

The report's section 6.3 expects three stages (generate, step, shade) to take (N + 2) t instead of 3 N t: at most three
times as fast. Our lane is a ring of eight stages with a ray in each: alone, a ray reads one word every eight clocks.
A frame of one pixel shows what a ray takes alone, a whole frame what it takes in company.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(Path(sys.argv[0]).resolve().parents[1]))
from original import level_camera

import voxrt
from voxrt import sim

ROOT = Path(sys.argv[0]).resolve().parents[2]
rom = voxrt.build(ROOT / "examples" / "courtyard.glb", depth=7).rom
size = (128, 128)
camera = level_camera(rom, size[0])
whole = sim.render(rom, camera, size, engine="rtl").cost
look, right, up = (np.array(vector) for vector in (camera.look, camera.right, camera.up))
rng = np.random.default_rng(0)
words, clocks = [], []
for column, row in rng.integers(0, size, (80, 2)):
    direction = tuple(map(int, look + right * (column - size[0] // 2) + up * (size[1] // 2 - row)))
    alone = sim.render(rom, sim.Camera(camera.position, direction, camera.right, camera.up), (1, 1), engine="rtl").cost
    words.append(alone.words_read)
    clocks.append(alone.cycles)
slope, start = np.polyfit(words, clocks, 1)
together = whole.cycles / whole.rays
print(f"a ray alone: {start:.0f} clocks and {slope:.2f} a word, {np.mean(clocks):.1f} on average")
print(f"in company:  {together:.2f} clocks, {whole.cycles / whole.words_read:.4f} a word")
print(f"gain: {np.mean(clocks) / together:.1f} times; the report's three stages: at most 3")

# %%
plt.figure(figsize=(7, 4.5))
plt.plot(words, clocks, ".", label="one ray alone")
reach = np.array((0, max(words)))
plt.plot(reach, start + slope * reach, "-", alpha=0.6, label=f"{start:.0f} + {slope:.2f} words")
plt.plot(reach, reach * whole.cycles / whole.words_read, "k--", label="in a frame, each ray's share")
plt.xlabel("octree words that the ray reads")
plt.ylabel("clocks")
plt.legend()
plt.grid(visible=True, alpha=0.3)
plt.tight_layout()
plt.show()
