"""Make the README's pictures: ``python examples/make_pictures.py`` renders the example scenes by the ray tracer.

The picture of octants needs ``voxrt[view]``, those of the comparison ``voxrt[compare]``.
"""

from __future__ import annotations

import runpy
from pathlib import Path

import matplotlib as mpl
from matplotlib import pyplot as plt

import voxrt
from voxrt import octree

EXAMPLES = Path(__file__).resolve().parent
PICTURES = EXAMPLES.parent / "docs" / "pictures"
SCENES = {"courtyard.glb": (800, 600), "dog.usda": (400, 300), "planet.glb": (400, 300), "house.obj": (400, 300)}


def main() -> None:
    """Build each scene and leave its picture in docs/pictures."""
    mpl.use("Agg")
    for name, size in SCENES.items():
        picture = PICTURES / Path(name).with_suffix(".png")
        voxrt.build(EXAMPLES / name, preview=picture, size=size)
        print(picture)
    octants = PICTURES / "octants.png"
    octree.plot(voxrt.build(EXAMPLES / "courtyard.glb").rom, size=(800, 600), screenshot=octants)
    print(octants)
    compare()
    draw_gallery("physics_colliders", "rounding")
    draw_gallery("textured_gltf", "painted")


def compare() -> None:
    """Hold the courtyard against its meshes."""
    built = voxrt.build(EXAMPLES / "courtyard.glb", depth=8)
    scene, size = voxrt.load(EXAMPLES / "courtyard.glb"), (320, 240)
    camera = voxrt.aim_camera(built.rom, size)
    found = voxrt.compare(scene, built.rom, camera, size)
    hardware = voxrt.render(built.rom, camera, size=size).colour
    voxrt.save_picture(voxrt.comparison_sheet(found, hardware), PICTURES / "comparison.png")
    curve = voxrt.likeness_curve(scene, range(3, 10), (640, 480))
    voxrt.save_picture(voxrt.draw_likeness_curve(curve), PICTURES / "likeness.png")


def draw_gallery(example: str, picture: str) -> None:
    """Draw the last figure of an example of the gallery."""
    runpy.run_path(str(EXAMPLES / "gallery" / f"{example}.py"), run_name="__main__")
    plt.savefig(PICTURES / f"{picture}.png", dpi=100)


if __name__ == "__main__":
    main()
