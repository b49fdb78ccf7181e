"""The verilated hardware in WebAssembly: the pixels, clocks and words of the native simulation."""

from __future__ import annotations

import pytest
from fakes.site import ROOT, node, registers_of, sha

import voxrt
from voxrt import octree
from voxrt.octree.camera import FACES, Camera, Lighting
from voxrt.octree.camera import frame_points as camera_for
from voxrt.sim import outline, render
from voxrt.sim.engine_arguments import palette_of

SIZE = (80, 60)
LOOKS = {
    "faces": (Lighting(), {"faces": list(FACES)}),
    "report": (Lighting(faces=None), {"faces": None}),
    "flat": (Lighting(flat=True), {"flat": True}),
}


def job(rom: voxrt.Rom, camera: Camera, look: dict, **other: object) -> dict:
    return {
        "words": rom.octree.words.tolist(),
        "depth": rom.octree.depth,
        "camera": registers_of(camera),
        "size": SIZE,
        "look": {"materials": palette_of(rom.materials)[: len(rom.materials)].tolist(), **look},
        "limit": len(rom.octree.words),
        **other,
    }


def run(*jobs: dict) -> list[dict]:
    return node("run_hardware.mjs", jobs)


@pytest.mark.parametrize(("name", "depth"), [("courtyard.glb", 7), ("planet.glb", 9), ("house.obj", 4)])
def test_a_frame_has_the_pixels_clocks_and_words_of_the_native_hardware(name: str, depth: int) -> None:
    pytest.importorskip("voxrt.sim._rtl")
    rom = voxrt.build(ROOT / "examples" / name, depth=depth).rom
    camera = camera_for(outline(rom.octree), SIZE)
    limit = len(octree.coarsen(rom.octree, 2).words)
    found = run(*(job(rom, camera, look, limit=limit) for _, look in LOOKS.values()))
    for (lighting, _), one in zip(LOOKS.values(), found, strict=True):
        native = render(rom, camera, SIZE, engine="rtl", config="tiny", lighting=lighting)
        assert "problem" not in one, one
        assert (one["clocks"], one["wordsRead"]) == (native.cost.cycles, native.cost.words_read)
        assert one["colour"] == sha(native.colour)
        assert one["material"] == sha(native.material)
        assert one["face"] == sha(native.face)
        assert one["pixels"] == sorted(one["pixels"])
        assert one["level"] == 2


def test_what_the_hardware_cannot_do_it_says_in_one_line() -> None:
    rom = voxrt.build(ROOT / "examples" / "house.obj", depth=4).rom
    camera = camera_for(outline(rom.octree), SIZE)
    far = Camera((1 << 21, 0, 0), camera.look, camera.right, camera.up)
    wide = Camera(camera.position, camera.look, (1 << 15, 0, 0), camera.up)
    found = run(
        job(rom, camera, {}, zeros=1 + (8 << 21) + 8),
        job(rom, far, {}),
        job(rom, wide, {}),
        job(rom, camera, {}, size=[4096, 1]),
        job(rom, camera, {}, depth=17),
        job(rom, camera, {}),
    )
    *problems, good = found
    assert all("\n" not in one["problem"] for one in problems)
    assert problems[0]["limit"] == 1 + (8 << 21)
    for one, part in zip(problems, ("words, not", "position", "direction", "1 … 4095", "depth"), strict=True):
        assert part in one["problem"]
    assert "problem" not in good
