"""Make the example scenes: ``python examples/make_scenes.py [FOLDER]`` writes them to FOLDER, or beside itself.

courtyard.glb
    The demo: a house with a garden, 16 m a side, in metres and y up; edges lie on eighths of a metre, which are voxels
    at depth 7.
house.obj
    A small house, several materials a file.
dog.usda
    A dog of boxes with physics colliders, centimetres and z up: voxrt rounds them to powers of two voxels.
planet.glb
    Curved solids: a banded ball, a tilted ring, moons.
toadstool.vox
    Voxel art in MagicaVoxel's format, 16 voxels per side.
"""

from __future__ import annotations

import sys
from pathlib import Path

from courtyard import COURTYARD, COURTYARD_PALETTE
from solids import Part, Solid, ball, box, prism, ring, spin
from writers import write_glb, write_obj, write_usda, write_vox

HOUSE_PALETTE = {
    "plaster": (250, 236, 200),
    "tiles": (214, 84, 56),
    "timber": (132, 84, 52),
    "glass": (132, 200, 245),
    "brick": (176, 96, 84),
}
HOUSE = [
    Part("door", "timber", (box((3.25, 4.5), (0, 2.25), (5.75, 6.125)),)),
    Part("windows", "glass", (box((1, 2.25), (1, 2.25), (5.75, 6.125)), box((5.5, 6.75), (1, 2.25), (5.75, 6.125)))),
    Part("chimney", "brick", (box((5.25, 6.25), (4, 7.5), (3.5, 4.5)),)),
    Part("walls", "plaster", (prism("x", [(0, 0), (3.5, 0), (6.5, 3), (3.5, 6), (0, 6)], (0.5, 7.25)),)),
    Part(
        "roof",
        "tiles",
        (
            prism("x", [(2.75, 6.75), (6.5, 3), (7, 3), (3.25, 6.75)], (0, 7.75)),
            prism("x", [(2.75, -0.75), (3.25, -0.75), (7, 3), (6.5, 3)], (0, 7.75)),
        ),
    ),
]
DOG_PALETTE = {
    "fur": (236, 170, 92),
    "ears": (150, 92, 56),
    "nose": (48, 42, 48),
    "paws": (255, 244, 226),
    "collar": (240, 60, 70),
}
# Name, material, lowest and highest corner: x to the right, y away, z up; the dog looks at the viewer (-y). Most
# sides are a little short of powers of two.
DOG = [
    ("nose", "nose", (-2, -32, 28), (1.5, -30.25, 31.5)),
    ("left_eye", "nose", (-6, -24, 33), (-4.25, -22.25, 34.75)),
    ("right_eye", "nose", (4, -24, 33), (5.75, -22.25, 34.75)),
    ("collar", "collar", (-8, -10, 24), (7.5, -8.25, 31.5)),
    ("snout", "paws", (-4, -32, 24), (3.5, -24.5, 31.5)),
    ("head", "fur", (-8, -24, 24), (7.5, -8.5, 39.5)),
    ("left_ear", "ears", (-8, -16, 40), (-4.5, -12.5, 47.5)),
    ("right_ear", "ears", (4, -16, 40), (7.5, -12.5, 47.5)),
    ("body", "fur", (-8, -8, 16), (7.5, 23.5, 31.5)),
    *(
        part
        for side, x in (("left", -8), ("right", 4))
        for end, y in (("fore", -8), ("hind", 20))
        for part in (
            (f"{side}_{end}_paw", "paws", (x, y, 0), (x + 3.5, y + 3.5, 3.5)),
            (f"{side}_{end}_leg", "fur", (x, y, 0), (x + 3.5, y + 3.5, 15.5)),
        )
    ),
    ("tail", "fur", (-2, 24, 28), (1.5, 27.5, 31.5)),
    ("tail_tip", "ears", (-2, 28, 28), (1.5, 32, 43.5)),
]
PLANET_PALETTE = {
    "cream": (250, 224, 176),
    "ochre": (226, 164, 92),
    "rust": (196, 104, 70),
    "ice": (176, 216, 240),
    "dust": (222, 206, 236),
    "moon": (200, 204, 214),
}


def planet() -> list[Part]:
    """Make a banded ball about the origin with rings and moons."""
    bands = ("rust", "cream", "ochre", "cream", "rust", "cream", "ochre", "cream", "rust")
    whole = ball(3.5, rows=36, sides=48)
    slices: dict[str, list[Solid]] = {}
    for number, name in enumerate(bands):
        loops = range(4 * number, 4 * number + 5)
        profile = [(whole.points[48 * loop][2], whole.points[48 * loop][1]) for loop in loops]
        slices.setdefault(name, []).append(spin(profile, 48).rolled(20))
    parts = [Part(f"{name}_bands", name, tuple(solids)) for name, solids in slices.items()]
    parts += [
        Part("inner_ring", "ice", (ring(4.25, 5.5, (-0.125, 0.125), 64).rolled(20),)),
        Part("outer_ring", "dust", (ring(5.75, 6.75, (-0.125, 0.125), 64).rolled(20),)),
        Part("moons", "moon", (ball(0.75).moved(5.5, 4.25, 1), ball(0.5).moved(-6, 0.5, 3.5))),
    ]
    return parts


TOADSTOOL_PALETTE = [(206, 44, 52), (250, 244, 236), (236, 214, 178), (96, 168, 72), (64, 124, 56)]


def toadstool() -> dict[tuple[int, int, int], int]:
    """Make a toadstool of voxels on grass: palette entries by x, y, z, z up."""
    voxels = {(x, y, 0): 4 + (7 * x + 5 * y) % 3 // 2 for x in range(16) for y in range(16)}
    for x in range(16):
        for y in range(16):
            away = (2 * x - 15) ** 2 + (2 * y - 15) ** 2
            voxels |= {(x, y, z): 3 for z in range(1, 8) if away < 36 - 2 * z}
            # The cap is half an ellipsoid with white dots.
            voxels |= {
                (x, y, z): 2 if (x // 2 + 2 * (y // 2) + 3 * (z // 2)) % 7 == 0 else 1
                for z in range(8, 16)
                if away + 4 * (z - 8) ** 2 < 210
            }
    return voxels


def make_scenes(folder: Path) -> None:
    """Write every example scene to `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    write_glb(folder / "courtyard.glb", COURTYARD, COURTYARD_PALETTE)
    write_obj(folder / "house.obj", HOUSE, HOUSE_PALETTE)
    write_usda(folder / "dog.usda", DOG, DOG_PALETTE)
    write_glb(folder / "planet.glb", planet(), PLANET_PALETTE)
    write_vox(folder / "toadstool.vox", toadstool(), TOADSTOOL_PALETTE)


if __name__ == "__main__":
    make_scenes(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
