"""
Time against pixels
===================

The report's figures 44, 45 and 48: the time of a frame grows in proportion to its pixels. Its slopes were 0.72 µs a
pixel on the board, 84 µs in C++ and 768 µs in Python on a 1.4 GHz laptop, hence "116 times faster" (section 6.1.1). Its
C++ program handles coordinates as heap-allocated vectors; the same algorithm on plain arrays is the fairer opponent,
and our model, which gives every pixel exactly, the strongest.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(Path(sys.argv[0]).resolve().parents[1]))
from original import Original, level_camera

import voxrt
from voxrt import sim

CLOCK = 100e6  # what the report's board runs at; ours has not been placed and routed
ROOT = Path(sys.argv[0]).resolve().parents[2]
rom = voxrt.build(ROOT / "examples" / "courtyard.glb", depth=7).rom
sides = np.array((64, 128, 192, 256, 384))

seconds: dict[str, list[float]] = {}
with Original(as_published=True) as published, Original(as_published=False) as plain:
    for side in map(int, sides):
        camera, size = level_camera(rom, side), (side, side)
        measured = {
            "the report's C++ program": min(published.render(rom, camera, size)[0] for _ in range(3)),
            "its algorithm on plain arrays": min(plain.render(rom, camera, size)[0] for _ in range(3)),
            "our model, one core": min(
                sim.render(rom, camera, size, engine="model", threads=1).cost.seconds for _ in range(5)
            ),
        }
        for config in ("tiny", "quad", "z1"):
            cycles = sim.render(rom, camera, size, engine="rtl", config=config).cost.cycles
            measured[f"our hardware, {config}, clocks at 100 MHz"] = cycles / CLOCK
        for name, value in measured.items():
            seconds.setdefault(name, []).append(value)

# %%
# Each is a straight line: its slope, and how far the points lie from it.
pixels = sides**2
plt.figure(figsize=(7, 4.5))
print(f"{'':42s}{'a pixel':>12s}{'of variance':>14s}")
for name, values in seconds.items():
    slope, offset = np.polyfit(pixels, values, 1)
    explained = np.corrcoef(pixels, values)[0, 1] ** 2
    print(f"{name:42s}{slope * 1e9:9.1f} ns{explained:14.5f}")
    plt.loglog(pixels, values, "o-", label=name)
for name, slope in {
    "the report's board": 7.246e-7,
    "the report's C++": 8.407e-5,
    "the report's Python": 7.684e-4,
}.items():
    print(f"{name:42s}{slope * 1e9:9.1f} ns{'published':>14s}")
    plt.loglog(pixels, slope * pixels, ":", label=f"{name}, published")
plt.xlabel("pixels")
plt.ylabel("seconds per frame")
plt.legend(fontsize=7)
plt.grid(visible=True, which="major", alpha=0.3)
plt.tight_layout()
plt.show()
