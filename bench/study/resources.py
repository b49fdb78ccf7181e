"""
Resources
=========

Section 6.4 of the report: one of its cores takes 3,473 LUT and 42 DSP slices of an xc7z020. It takes no block RAM,
because the octree is stored in logic. Four cores did not fit beside the video part. Our numbers are estimates of
yosys, before place and route (``python rtl/area.py``). One more lane costs little, because ray generator and shader
serve all lanes.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

ROOT = Path(sys.argv[0]).resolve().parents[2]
lines = (ROOT / "bench" / "results" / "area.md").read_text().splitlines()
heads, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in lines if line.startswith("|"))
area = {row[0]: dict(zip(heads, row, strict=True)) for row in rows}
area = {name: row for name, row in area.items() if " " not in name}
part = {"LUT": 53_200, "DSP48": 220, "BRAM36": 140}
video = {"LUT": 12_446, "DSP48": 18, "BRAM36": 15}  # the report's table 9
theirs = {"LUT": 3_473, "DSP48": 42, "BRAM36": 0}  # table 8, one core

# %%
# In per cent of the FPGA. Grey: the video part of the report, which is needed besides.
figure, places = plt.subplots(1, 3, figsize=(9, 3.4))
names = ["original", *area]
for place, (kind, whole) in zip(places, part.items(), strict=True):
    used = np.array([theirs[kind], *(float(row[kind].replace(",", "")) for row in area.values())])
    place.bar(names, 100 * used / whole, color=["k", *["tab:blue"] * len(area)])
    place.bar(names, 100 * video[kind] / whole, bottom=100 * used / whole, color="lightgray")
    place.axhline(100, color="tab:red", linewidth=0.8)
    place.set_title(kind, fontsize=9)
    place.tick_params(axis="x", rotation=60, labelsize=8)
    print(f"{kind:8s}" + "  ".join(f"{name} {count:,.0f}" for name, count in zip(names, used, strict=True)))
places[0].set_ylabel("% of an xc7z020")
plt.tight_layout()
plt.show()

# %%
# Area against speed on the published house, where a ray reads 12 words: the bound of the cycles.
for name, row in area.items():
    pixels = 1e3 / max(1, 12 / int(row["lanes"]))
    print(f"{name:8s}{float(row['LUT'].replace(',', '')) / pixels:8.1f} LUT per pixel in a thousand cycles")
