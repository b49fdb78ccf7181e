"""
Time against pixels
===================

Figures 44, 45 and 48 of the report: the time of a frame grows in proportion to its pixels. The report measured 0.72
µs per pixel on the board, 84 µs in C++ and 768 µs in Python on a 1.4 GHz laptop, and concludes that the board is 116
times as fast as the C++ program (section 6.1.1). That program keeps coordinates in vectors on the heap. The same
algorithm on plain arrays is a fairer opponent. Our exact model, which gives every pixel exactly, is the strongest
one.

The simulation counts clock cycles of our hardware. It does not know how long a cycle lasts on an FPGA, so cycles have
a plot of their own.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(Path(sys.argv[0]).resolve().parents[1]))
from original import Original, level_camera

import voxrt
from voxrt import sim

ROOT = Path(sys.argv[0]).resolve().parents[2]
rom = voxrt.build(ROOT / "examples" / "courtyard.glb", depth=7).rom
sides = np.array((64, 128, 192, 256, 384))

seconds: dict[str, list[float]] = {}
cycles: dict[str, list[int]] = {}
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
        for name, value in measured.items():
            seconds.setdefault(name, []).append(value)
        for config in ("tiny", "quad", "z1"):
            cost = sim.render(rom, camera, size, engine="rtl", config=config).cost
            cycles.setdefault(f"our hardware, {config}", []).append(cost.cycles)

# %%
# Each is a straight line. The table has its slope, and how much of the variance the line explains.
pixels = sides**2
figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 5.2))
print(f"{'':34s}{'per pixel':>16s}{'explained':>12s}")
for place, unit, table in ((left, "ns", seconds), (right, "cycles", cycles)):
    for name, values in table.items():
        slope, offset = np.polyfit(pixels, values, 1)
        explained = np.corrcoef(pixels, values)[0, 1] ** 2
        print(f"{name:34s}{slope * (1e9 if unit == 'ns' else 1):9.2f} {unit:6s}{explained:12.5f}")
        place.loglog(pixels, values, "o-", label=name)
for name, slope in {
    "the report's board": 7.246e-7,
    "the report's C++": 8.407e-5,
    "the report's Python": 7.684e-4,
}.items():
    print(f"{name:34s}{slope * 1e9:9.1f} {'ns':6s}{'published':>12s}")
    left.loglog(pixels, slope * pixels, ":", label=f"{name}, published")
left.set(xlabel="pixels", ylabel="seconds per frame")
right.set(xlabel="pixels", ylabel="clock cycles per frame")
for place in (left, right):
    place.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), fontsize=8, frameon=False)
    place.grid(visible=True, which="major", alpha=0.3)
plt.tight_layout()
plt.show()
