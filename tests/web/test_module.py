"""The WebAssembly module against the native one: the same words, pixels and errors for the same files."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest
from fakes.site import node, site

import voxrt
from voxrt.octree.camera import FACES, Camera, Lighting
from voxrt.octree.camera import frame_points as camera_for
from voxrt.sim import outline, render
from voxrt.voxelize import DEFAULT_COLOUR, EMPTY

ROOT = Path(__file__).resolve().parents[2]
SCRIPT = Path(__file__).with_name("build_and_render.mjs")
SIZE = (201, 151)

LOOKS = {
    "faces": Lighting(),
    "report": Lighting(faces=None),
    "flat": Lighting(flat=True),
    "lit": Lighting((4000, 6000, 3000), on=True, ambient=60),
    "mirrors": Lighting((4000, 6000, 3000), on=True, bounces=3),
}


def sha(array: np.ndarray) -> str:
    return hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()


def in_node(jobs: list[dict]) -> list[dict]:
    return node(SCRIPT, {"site": str(site()), "jobs": jobs})


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
        {
            "camera": {name: getattr(camera, name) for name in ("position", "look", "right", "up")},
            "size": SIZE,
            "shading": shading_of(look),
        }
        for camera in cameras(rom)
        for look in looks
    ]
    return {"files": [str(path) for path in files], "depth": depth, "fill": "auto", "frames": frames}


EXAMPLES = {"courtyard": ["courtyard.glb"], "planet": ["planet.glb"], "house": ["house.obj", "house.mtl"]}


@pytest.mark.parametrize("depth", [5, 7, 9])
@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_are_built_and_rendered_as_natively(name: str, depth: int) -> None:
    files = [ROOT / "examples" / file for file in EXAMPLES[name]]
    native = voxrt.build(files[0], depth=depth)
    looks = list(LOOKS.values()) if depth == 7 else [Lighting()]
    (found,) = in_node([job(files, native.rom, looks, depth)])
    assert "problem" not in found, found
    assert found["count"] == len(native.octree.words)
    assert found["words"] == sha(native.octree.words)
    assert found["grid"] == {"origin": list(native.rom.grid.origin), "voxelSize": native.rom.grid.voxel_size}
    assert found["materials"] == [
        {"name": one.name, "colour": list(one.colour), "mirror": one.mirror, "authored": one.authored}
        for one in native.rom.materials
    ]
    assert found["objects"] == [
        {"name": one.name, "mode": str(one.mode), "voxels": one.voxels} for one in native.objects
    ]
    assert [(one["kind"], one["message"], one["count"]) for one in found["warnings"]] == [
        (one.kind, one.message, one.count) for one in native.warnings
    ]
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
    (found, bare) = in_node(
        [job(files, native.rom, list(LOOKS.values()), 6), job(files[:1], native.rom, [Lighting()], 6)]
    )
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
    found = in_node([{"files": [str(tmp_path / name)], "depth": 5, "fill": "auto", "frames": []} for name in texts])
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
