"""
Fitting a board
===============

A PYNQ-Z1 holds 32,769 words of octree memory. The scene below needs more. voxrt makes it fit: it simplifies the parts
of the surface that pictures show least. It never opens a hole in a wall.
"""

import sys
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import voxrt
from voxrt import octree

EXAMPLES = Path(sys.argv[0]).resolve().parents[1]
whole = voxrt.build(EXAMPLES / "planet.glb", depth=8)
fitted = voxrt.build(EXAMPLES / "planet.glb", depth=8, budget="pynq-z1")
fit = fitted.budget
print(f"{fit.fit.words_before:,} words before, {len(fitted.rom.octree.words):,} after, {fit.words:,} there")
print(f"{fit.fit.percent_changed:.1f} % of the surface changed; picture: {fit.psnr:.1f} dB, SSIM {fit.ssim:.4f}")

# %%
# A coarser world is the simple way to a smaller memory. With the same number of words, it changes more of the
# surface.
coarse = octree.coarsen(whole.rom.octree, 1)
equal = octree.fit(whole.rom.octree, len(coarse.words))
changed = octree.surface_change(whole.rom.octree, coarse).percent
print(f"{len(coarse.words):,} words: one level less changes {changed:.1f} %, fitting {equal.percent_changed:.1f} %")

# %%
# From left to right: the whole scene, the fitted one, and one level less.
size = (320, 320)
camera = voxrt.aim_camera(whole.rom, size)
plain = octree.Rom("coarser", coarse, whole.rom.materials)
frames = [voxrt.render(rom, camera, size=size) for rom in (whole.rom, fitted.rom, plain)]
picture = np.concatenate([frame.colour for frame in frames], axis=1)
plt.figure(figsize=(9.6, 3.2))
plt.imshow(picture)
plt.axis("off")
plt.tight_layout()
plt.show()
