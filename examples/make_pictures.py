"""Make the README's pictures: ``python examples/make_pictures.py`` renders the example scenes by the ray tracer.

The picture of octants needs PyVista, those of the comparison need Open3D and matplotlib.
"""

from __future__ import annotations

import runpy
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
from matplotlib import pyplot as plt
from PIL import Image

import voxrt
from voxrt import view
from voxrt.view.scene_overlay import find_owners, preview_of, scene_triangles

EXAMPLES = Path(__file__).resolve().parent
PICTURES = EXAMPLES.parent / "docs" / "pictures"
SCENES = {"courtyard.glb": (800, 600), "dog.usda": (400, 300), "planet.glb": (400, 300), "house.obj": (400, 300)}


def main() -> None:
    """Build each scene and leave its picture in docs/pictures."""
    mpl.use("Agg")
    for name, size in SCENES.items():
        picture = PICTURES / Path(name).with_suffix(".png")
        voxrt.build(EXAMPLES / name, preview=picture, size=size, samples=2, background="transparent")
        print(picture)
    show_octants()
    compare()
    draw_gallery("physics_colliders", "rounding")
    draw_gallery("textured_gltf", "painted")
    film_the_mine()


def show_octants() -> None:
    """Leave the viewer's pictures in docs/pictures."""
    courtyard = voxrt.build(EXAMPLES / "courtyard.glb")
    rom, scene, grid = courtyard.rom, courtyard.scene, courtyard.rom.grid
    assert grid is not None
    pruned = replace(voxrt.build(EXAMPLES / "courtyard.glb", budget=6000).rom, name="courtyard in 6,000 words")
    house = voxrt.build(EXAMPLES / "house.obj", depth=6)
    assert house.rom.grid is not None
    preview = preview_of(rom, voxrt.aim_camera(rom, (640, 480)), (640, 480), (320, 240))
    for name, panes, size, beside in (
        ("octants", [view.Pane(rom)], (800, 600), None),
        ("octants-ray", [view.Pane(rom)], (1024, 640), preview),
        ("octants-slice", [view.Pane(rom, high=(60, 128, 100), cut=True, by="level")], (640, 480), None),
        ("octants-owners", [view.Pane(rom, by="owner", owners=find_owners(scene, grid))], (640, 480), None),
        (
            "octants-mesh",
            [view.Pane(house.rom, triangles=scene_triangles(house.scene, house.rom.grid))],
            (640, 480),
            None,
        ),
        ("octants-pair", [view.Pane(rom), view.Pane(pruned)], (1024, 400), None),
    ):
        picture = Image.fromarray(view.picture(panes, size, preview=beside))
        file = PICTURES / f"{name}.png"
        picture.quantize(200, dither=Image.Dither.NONE).save(file, optimize=True)
        print(file)


def compare() -> None:
    """Hold the courtyard against its meshes."""
    built = voxrt.build(EXAMPLES / "courtyard.glb", depth=8)
    scene, size = voxrt.load(EXAMPLES / "courtyard.glb"), (320, 240)
    camera = voxrt.aim_camera(built.rom, size)
    found = voxrt.compare(scene, built.rom, camera, size)
    hardware = voxrt.render(built.rom, camera, size=size, lighting=voxrt.Lighting(faces=None)).colour  # as compare()
    voxrt.save_picture(voxrt.comparison_sheet(found, hardware), PICTURES / "comparison.png")
    curve = voxrt.likeness_curve(scene, range(3, 10), (640, 480))
    voxrt.save_picture(voxrt.draw_likeness_curve(curve), PICTURES / "likeness.png")


def draw_gallery(example: str, picture: str) -> None:
    """Draw the last figure of an example of the gallery."""
    runpy.run_path(str(EXAMPLES / "gallery" / f"{example}.py"), run_name="__main__")
    plt.savefig(PICTURES / f"{picture}.png", dpi=100)


def film_the_mine() -> None:
    """Leave the film of the gallery's mine that is dug."""
    known = runpy.run_path(str(EXAMPLES / "gallery" / "dig.py"), run_name="__main__")
    voxrt.save_animation(known["pictures"], PICTURES / "dig.gif", period=0.08)


if __name__ == "__main__":
    main()
