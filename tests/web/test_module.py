"""The WebAssembly module against the native one: the same words, pixels and errors for the same files."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from fakes.site import ROOT, assert_same_memory, node, objects_of, page_builds, registers_of, sha, warnings_of

import voxrt
from voxrt.octree.camera import FACES, Camera, Lighting
from voxrt.octree.camera import frame_points as camera_for
from voxrt.sim import outline, render
from voxrt.voxelize import DEFAULT_COLOUR, EMPTY

if TYPE_CHECKING:
    from pathlib import Path

SIZE = (201, 151)

LOOKS = {
    "faces": Lighting(),
    "report": Lighting(faces=None),
    "flat": Lighting(flat=True),
    "lit": Lighting((4000, 6000, 3000), on=True, ambient=60),
    "mirrors": Lighting((4000, 6000, 3000), on=True, bounces=3),
}


def cameras(rom: voxrt.Rom) -> list[Camera]:
    """All of the scene, from the corner; the same from so far away that tiles do not fit doubles."""
    near = camera_for(outline(rom.octree), SIZE)
    far = Camera(tuple(coordinate * 2000 for coordinate in near.position), near.look, near.right, near.up)
    return [near, far]


def shading_of(lighting: Lighting) -> dict:
    light = {"position": lighting.position, "ambient": lighting.ambient} if lighting.on else None
    return {"flat": lighting.flat, "faces": lighting.faces, "light": light, "bounces": lighting.bounces}


def job(files: list[Path], rom: voxrt.Rom, looks: list[Lighting], depth: int) -> dict:
    frames = [
        {"camera": registers_of(camera), "size": SIZE, "shading": shading_of(look)}
        for camera in cameras(rom)
        for look in looks
    ]
    return {"files": [str(path) for path in files], "depth": depth, "frames": frames}


EXAMPLES = {"courtyard": ["courtyard.glb"], "planet": ["planet.glb"], "house": ["house.obj", "house.mtl"]}


@pytest.mark.parametrize("depth", [5, 7, 9])
@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_are_built_and_rendered_as_natively(name: str, depth: int) -> None:
    files = [ROOT / "examples" / file for file in EXAMPLES[name]]
    native = voxrt.build(files[0], depth=depth)
    looks = list(LOOKS.values()) if depth == 7 else [Lighting()]
    (found,) = node("build_and_render.mjs", [job(files, native.rom, looks, depth)])
    assert_same_memory(found, native.rom)
    assert found["grid"] == {"origin": list(native.rom.grid.origin), "voxelSize": native.rom.grid.voxel_size}
    assert found["objects"] == objects_of(native)
    assert found["warnings"] == warnings_of(native.warnings)
    pairs = [(camera, look) for camera in cameras(native.rom) for look in looks]
    for (camera, look), picture in zip(pairs, found["pictures"], strict=True):
        frame = render(native.rom, camera, SIZE, engine="model", lighting=look)
        assert picture["banded"]
        assert picture["colour"] == sha(frame.colour), look
        assert picture["material"] == sha(frame.material)
        assert picture["face"] == sha(frame.face)


def test_a_memory_is_shown_as_it_was_written(tmp_path: Path) -> None:
    native = voxrt.build(ROOT / "examples" / "dog.usda", tmp_path, depth=6)
    files = [native.outputs["mem"], native.outputs["manifest"]]
    looks = list(LOOKS.values())
    jobs = [job(files, native.rom, looks, 6), job(files[:1], native.rom, [Lighting()], 6)]
    found, bare = node("build_and_render.mjs", jobs)
    assert found["words"] == bare["words"] == sha(native.octree.words)
    assert found["depth"] == 6
    assert bare["depth"] == voxrt.octree.decode(native.octree.words, "report", None).depth
    frame = render(native.rom, cameras(native.rom)[0], SIZE, engine="model")
    assert found["pictures"][0]["colour"] == sha(frame.colour)


def test_errors_are_one_line_and_those_of_the_native_module(tmp_path: Path) -> None:
    texts = {
        "range.mem": "00000009\n" + "FFFFFF01\n" * 8,
        "tag.mem": "80000001\n",
        "odd.mem": "00000001\n" + "FFFFFF01\n" * 3,
        "letters.mem": "0000000G\n",
        "empty.stl": "solid a\nendsolid a\n",
        "broken.glb": "glTF",
        "broken.gltf": "{",
        "broken.ply": "ply\nformat ascii 1.0\nelement vertex",
        "nothing.obj": "v 0 0 0\n",
    }
    for name, content in texts.items():
        (tmp_path / name).write_text(content)
    found = page_builds(*([tmp_path / name] for name in texts), depth=5)
    for one in found:
        assert one["problem"]
        assert "\n" not in one["problem"]
    problems = dict(zip(texts, (one["problem"] for one in found), strict=True))
    assert "word 0 (00000009) of the octree memory points outside the memory" in problems["range.mem"]
    assert "word 0 (80000001) of the octree memory is neither a pointer nor a material tag" in problems["tag.mem"]
    assert "1 + 8k words, not 4" in problems["odd.mem"]


def test_values_that_stand_in_both_languages_are_equal() -> None:
    package = (ROOT / "web" / "package" / "voxrt.js").read_text()
    scene = (ROOT / "web" / "package" / "scene.js").read_text()
    assert f"FACES = {list(FACES)};" in package
    assert f"BACKGROUND = {list(EMPTY.colour)};" in package
    assert f"colour: {list(DEFAULT_COLOUR)}" in scene
