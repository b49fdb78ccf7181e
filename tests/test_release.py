"""Words and pixels of the example scenes are those of release 0.1.0, byte for byte.

``golden/release-0.1.0.json`` holds SHA-256 sums that the released version computed. A change that alters them on
purpose says so in the changelog and writes the file of the release that it belongs to.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest

import voxrt

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
RELEASED = json.loads((Path(__file__).parent / "golden" / "release-0.1.0.json").read_text(encoding="utf-8"))
LIGHTINGS = {
    "plain": voxrt.Lighting(faces=None),
    "flat": voxrt.Lighting(flat=True),
    "light and mirrors": voxrt.Lighting((16 * 40, 16 * 300, 16 * 200), ambient=40, on=True, bounces=2, faces=None),
}


def digest(values):
    return hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()


@pytest.mark.parametrize("scene", RELEASED)
def test_words_and_pixels_are_those_of_the_release(scene):
    name, _, depth = scene.partition(", depth ")
    rom = voxrt.build(EXAMPLES / name, depth=int(depth)).rom if depth else voxrt.read_any(EXAMPLES / name)[0].rom
    frames = {key: voxrt.render(rom, size=(160, 120), engine="model", lighting=LIGHTINGS[key]) for key in LIGHTINGS}
    assert {
        "words": digest(rom.octree.words.astype("<u4")),
        "colours": digest(np.array([material.colour for material in rom.materials], np.uint8)),
        "pixels": {key: digest(frame.colour) for key, frame in frames.items()},
        "hits": digest(np.stack([frames["plain"].material, frames["plain"].face])),
    } == RELEASED[scene]
