"""
What pipelining gains
=====================

The report expects three stages (generate, step, shade) to take (N + 2) t instead of 3 N t, so at most three times the
speed (section 6.3). Our lane is a ring of pipeline stages, with one ray in each. A ray that is alone reads one word
per turn of the ring. A frame of one pixel shows the cost of a ray alone. A whole frame shows the cost of a ray among
others.
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
print(f"a ray alone: {start:.0f} cycles and {slope:.2f} per word, {np.mean(clocks):.1f} on average")
print(f"in a frame:  {together:.2f} cycles, {whole.cycles / whole.words_read:.4f} per word")
print(f"gain: {np.mean(clocks) / together:.1f} times; the report's three stages: at most 3")

# %%
plt.figure(figsize=(7, 4.5))
plt.plot(words, clocks, ".", label="one ray alone")
reach = np.array((0, max(words)))
plt.plot(reach, start + slope * reach, "-", alpha=0.6, label=f"{start:.0f} + {slope:.2f} words")
plt.plot(reach, reach * whole.cycles / whole.words_read, "k--", label="in a frame, per ray")
plt.xlabel("octree words that the ray reads")
plt.ylabel("clock cycles")
plt.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, fontsize=8, frameon=False)
plt.grid(visible=True, alpha=0.3)
plt.tight_layout()
plt.show()
