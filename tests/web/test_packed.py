"""Memories that links carry: what is packed comes out of the text again, word for word, and damage is noticed."""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING

import pytest
from fakes.site import ROOT, node

import voxrt
from voxrt.export import write_rom
from voxrt.export.vox import read_vox

if TYPE_CHECKING:
    from pathlib import Path

EXAMPLES = ROOT / "examples"
DAYLIGHT = {"sun": [1, 3, 2], "sky": [0.4, 0.4, 0.4], "samples": 16}


@pytest.mark.parametrize(
    ("files", "depth", "options"),
    [
        (("courtyard.glb",), 7, {}),
        (("house.obj", "house.mtl"), 6, {"bake": DAYLIGHT}),
        (("planet.glb",), 1, {}),
        (("toadstool.vox",), 0, {}),
    ],
    ids=lambda part: part[0] if isinstance(part, tuple) else "",
)
def test_a_packed_memory_is_the_memory(tmp_path: Path, files: tuple[str, ...], depth: int, options: dict) -> None:
    paths = [str(EXAMPLES / name) for name in files]
    (found,) = node("pack_memories.mjs", [{"files": paths, "depth": depth, **options}])
    if depth == 0:
        rom, _ = read_vox(paths[0])
    else:
        baked = {"bake": True, "bake_samples": 16} if options else {}
        rom = voxrt.build(paths[0], depth=depth, **baked).rom
    mem = write_rom(tmp_path, rom).mem.read_bytes()
    assert found["mem"] == hashlib.sha256(mem).hexdigest()
    assert (found["name"], found["depth"]) == (rom.name, rom.octree.depth)
    assert [(one["name"], tuple(one["colour"])) for one in found["materials"]] == [
        (one.name, one.colour) for one in rom.materials
    ]
    assert (found["lighting"] or {}).get("flat", False) == bool(options)
    assert all("damaged or cut off" in one for one in found["damaged"]), json.dumps(found["damaged"])
    assert "more than 1 MiB" in found["refused"]


def test_a_link_takes_few_bits_per_word() -> None:
    """The courtyard's 11,945 words fit a link three times over."""
    (found,) = node("pack_memories.mjs", [{"files": [str(EXAMPLES / "courtyard.glb")], "depth": 7}])
    assert found["length"] < 9_000
