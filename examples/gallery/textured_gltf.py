"""
A textured glTF
===============

A globe with an image around it, written as glTF by trimesh. Each voxel of the surface takes the colour that the
texture has there. All these colours are then reduced to a palette of at most 32 (``colours=``).
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import trimesh
from PIL import Image

import voxrt

# %%
# The image: land, sea and ice, made from a few waves, by longitude and latitude.
longitude, latitude = np.meshgrid(np.linspace(0, 2 * np.pi, 256), np.linspace(np.pi / 2, -np.pi / 2, 128))
height = np.sin(3 * longitude) * np.cos(2 * latitude) + 0.7 * np.sin(5 * longitude + 2) * np.cos(7 * latitude)
image = np.select(
    [(np.abs(latitude) > 1.25)[..., None], (height > 0.7)[..., None], (height > 0.1)[..., None]],
    [np.array((240, 244, 250)), np.array((176, 140, 92)), np.array((92, 168, 84))],
    np.array((52, 108, 196)),
).astype(np.uint8)

# %%
# A ball of 64 by 32 quads. The first meridian has two sets of vertices, because the image starts and ends there.
u, v = np.meshgrid(np.linspace(0, 1, 65), np.linspace(0, 1, 33))
turn, polar = 2 * np.pi * u.ravel(), np.pi * v.ravel()
points = np.stack([np.sin(polar) * np.cos(turn), np.cos(polar), -np.sin(polar) * np.sin(turn)], axis=1)
corner = (np.arange(32)[:, None] * 65 + np.arange(64)).ravel()
quads = np.stack([corner, corner + 65, corner + 66, corner + 1], axis=1)
texture = trimesh.visual.TextureVisuals(
    uv=np.stack([u.ravel(), 1 - v.ravel()], axis=1),
    material=trimesh.visual.material.PBRMaterial(baseColorTexture=Image.fromarray(image)),
)
globe = trimesh.Trimesh(points, np.concatenate([quads[:, :3], quads[:, [0, 2, 3]]]), visual=texture, process=False)

# %%
with tempfile.TemporaryDirectory() as folder:
    asset = Path(folder) / "globe.glb"
    globe.export(asset)
    built = voxrt.build(asset, depth=7)
print(f"{built.solid_voxels:,} voxels, {len(built.rom.materials) - 1} colours, {len(built.rom.octree.words):,} words")

picture = voxrt.render(built.rom, size=(480, 480)).colour
plt.figure(figsize=(7.2, 3.6))
for place, shown in enumerate((image, picture)):
    plt.subplot(1, 2, 1 + place)
    plt.imshow(shown)
    plt.axis("off")
plt.tight_layout()
plt.show()
