"""Words and pixels of the example scenes are those of release 0.1.0, byte for byte; so are default pictures since.

``golden/release-0.1.0.json`` holds SHA-256 sums that the released version computed, ``golden/cameras-0.1.0.json`` the
registers of its default cameras. Its pixels are those of ``--shading report`` and ``flat`` now.
``golden/pictures-0.2.0.json`` has default cameras and pictures since then. A change that alters them on purpose says
so in the changelog and writes the file of the release that it belongs to.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest

import voxrt

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
GOLDEN = Path(__file__).parent / "golden"
RELEASED, CAMERAS, PICTURES = (
    json.loads((GOLDEN / f"{name}.json").read_text(encoding="utf-8"))
    for name in ("release-0.1.0", "cameras-0.1.0", "pictures-0.2.0")
)
SIZE = (160, 120)
LIGHTINGS = {
    "plain": voxrt.Lighting(faces=None),
    "flat": voxrt.Lighting(flat=True),
    "light and mirrors": voxrt.Lighting((16 * 40, 16 * 300, 16 * 200), ambient=40, on=True, bounces=2, faces=None),
}
DEFAULTS = {
    "faces": {},
    "faces, light and mirrors": {"lighting": voxrt.Lighting((16 * 40, 16 * 300, 16 * 200), on=True, bounces=2)},
    "four rays per pixel": {"samples": 2},
    "transparent": {"background": "transparent", "samples": 2},
}


def digest(values):
    return hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()


def built(scene):
    name, _, depth = scene.partition(", depth ")
    return voxrt.build(EXAMPLES / name, depth=int(depth)).rom if depth else voxrt.read_any(EXAMPLES / name)[0].rom


@pytest.mark.parametrize("scene", RELEASED)
def test_words_and_pixels_are_those_of_the_release(scene):
    rom = built(scene)
    camera = voxrt.Camera(*map(tuple, CAMERAS[scene]))
    frames = {
        key: voxrt.render(rom, camera, size=SIZE, engine="model", lighting=lighting)
        for key, lighting in LIGHTINGS.items()
    }
    assert {
        "words": digest(rom.octree.words.astype("<u4")),
        "colours": digest(np.array([material.colour for material in rom.materials], np.uint8)),
        "pixels": {key: digest(frame.colour) for key, frame in frames.items()},
        "hits": digest(np.stack([frames["plain"].material, frames["plain"].face])),
    } == RELEASED[scene]


@pytest.mark.parametrize("scene", PICTURES)
def test_default_pictures_stay(scene):
    rom = built(scene)
    camera = voxrt.aim_camera(rom, SIZE)
    pixels = {
        key: digest(voxrt.render(rom, size=SIZE, engine="model", **options).colour) for key, options in DEFAULTS.items()
    }
    registers = [list(row) for row in (camera.position, camera.look, camera.right, camera.up)]
    assert {"camera": registers, "pixels": pixels} == PICTURES[scene]
