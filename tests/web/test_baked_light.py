"""Baked light in the WebAssembly module: the words and materials of ``voxrt build --bake``."""

from __future__ import annotations

import hashlib
from pathlib import Path

import pytest
from assets import asset
from fakes.site import ROOT, node, site

import voxrt

SCRIPT = Path(__file__).with_name("build_and_render.mjs")
DAYLIGHTS = {
    "default": ({}, {"sun": [1, 3, 2], "sky": [0.4, 0.4, 0.4], "samples": 64}),
    "other": (
        {"sun": (-2, 1, 0.5), "sky": 0.2, "bake_samples": 17},
        {"sun": [-2, 1, 0.5], "sky": [0.2] * 3, "samples": 17},
    ),
    "no sun": ({"sun": (0, 0, 0), "sky": 1, "bake_samples": 5}, {"sun": [0, 0, 0], "sky": [1, 1, 1], "samples": 5}),
}


def bake_both(files: list[Path], depth: int, options: dict, daylight: dict) -> tuple[voxrt.BuildResult, dict]:
    job = {"files": [str(one) for one in files], "depth": depth, "fill": "auto", "bake": daylight, "frames": []}
    (found,) = node(SCRIPT, {"site": str(site()), "jobs": [job]})
    return voxrt.build(files[0], depth=depth, bake=True, **options), found


def assert_same(native: voxrt.BuildResult, found: dict) -> None:
    assert "problem" not in found, found
    assert found["materials"] == [
        {"name": one.name, "colour": list(one.colour), "mirror": one.mirror, "authored": one.authored}
        for one in native.rom.materials
    ]
    assert found["words"] == hashlib.sha256(native.octree.words.tobytes()).hexdigest()
    baked = found["baked"]
    assert (baked["voxels"], baked["wordsBefore"]) == (native.bake.voxels, native.bake.words_before)
    assert baked["words"] == native.bake.words == found["count"]


@pytest.mark.parametrize("daylight", DAYLIGHTS)
@pytest.mark.parametrize(
    ("files", "depth"),
    [(["courtyard.glb"], 7), (["planet.glb"], 6), (["house.obj", "house.mtl"], 6)],
    ids=lambda value: value[0] if isinstance(value, list) else str(value),
)
def test_examples_have_the_light_of_the_native_module(files: list[str], depth: int, daylight: str) -> None:
    assert_same(*bake_both([ROOT / "examples" / name for name in files], depth, *DAYLIGHTS[daylight]))


@pytest.mark.parametrize(
    "name",
    [
        *("gltf/trimesh/CesiumMilkTruck.glb", "gltf/bevy/animated/Fox.glb", "gltf/3d-demo-data/scene.glb"),
        *("gltf/glTF-Blender-IO/24_gpu_instancing.gltf", "ply/trimesh/cube_blender_uv.ply"),
    ],
)
def test_shared_assets_have_the_light_of_the_native_module(name: str) -> None:
    path = asset(name)
    beside = [one for one in path.parent.iterdir() if one.is_file() and one != path]
    assert_same(*bake_both([path, *beside], 7, *DAYLIGHTS["default"]))
