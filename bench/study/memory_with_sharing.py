"""
Memory with and without sharing
===============================

The report stores its octree in a ROM, with one block for each inner node (section 6.5). voxrt stores equal blocks
once. The hardware needs no change for that, because it follows pointers wherever they lead.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt

import voxrt
from voxrt.octree import BOARDS, census

ROOT = Path(sys.argv[0]).resolve().parents[2]
depths = range(4, 11)
plt.figure(figsize=(7, 4.5))
print(f"{'words':16s}" + "".join(f"{depth:>10d}" for depth in depths) + "  depth")
for name in ("courtyard.glb", "planet.glb", "dog.usda"):
    shared, plain = [], []
    for depth in depths:
        tree = voxrt.build(ROOT / "examples" / name, depth=depth).rom.octree
        shared.append(len(tree.words))
        plain.append(1 + 8 * (int(census(tree).leaves.sum()) - 1) // 7)
    print(f"{name:16s}" + "".join(f"{count:10,}" for count in shared))
    print(f"{'  unshared':16s}" + "".join(f"{count:10,}" for count in plain))
    print(f"{'  times':16s}" + "".join(f"{before / after:10.1f}" for before, after in zip(plain, shared, strict=True)))
    (line,) = plt.semilogy(depths, shared, "o-", label=name)
    plt.semilogy(depths, plain, "o:", color=line.get_color(), label=f"{name}, not shared")
plt.axhline(BOARDS["pynq-z1"], color="k", linewidth=0.8)
plt.text(4, BOARDS["pynq-z1"] * 1.15, "PYNQ-Z1", fontsize=8)
plt.xlabel("depth of the octree")
plt.ylabel("words of 32 bits")
plt.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, fontsize=8, frameon=False)
plt.grid(visible=True, alpha=0.3)
plt.tight_layout()
plt.show()
