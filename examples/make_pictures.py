"""Make the README's pictures: ``python examples/make_pictures.py`` renders the example scenes by the ray tracer.

The picture of octants needs ``voxrt[view]``.
"""

from __future__ import annotations

from pathlib import Path

import voxrt
from voxrt import octree

EXAMPLES = Path(__file__).resolve().parent
PICTURES = EXAMPLES.parent / "docs" / "pictures"
SCENES = {"courtyard.glb": (800, 600), "dog.usda": (400, 300), "planet.glb": (400, 300), "house.obj": (400, 300)}


def main() -> None:
    """Build each scene and leave its picture in docs/pictures."""
    for name, size in SCENES.items():
        picture = PICTURES / Path(name).with_suffix(".png")
        voxrt.build(EXAMPLES / name, preview=picture, size=size)
        print(picture)
    octants = PICTURES / "octants.png"
    octree.plot(voxrt.build(EXAMPLES / "courtyard.glb").rom, size=(800, 600), screenshot=octants)
    print(octants)


if __name__ == "__main__":
    main()
