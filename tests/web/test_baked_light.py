"""Baked light in the WebAssembly module: the words and materials of ``voxrt build --bake``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from assets import asset, over_assets
from fakes.site import ROOT, assert_same_memory, page_builds

import voxrt

if TYPE_CHECKING:
    from pathlib import Path

DAYLIGHTS = {
    "default": ({}, {"sun": [1, 3, 2], "sky": [0.4, 0.4, 0.4], "samples": 64}),
    "other": (
        {"sun": (-2, 1, 0.5), "sky": 0.2, "bake_samples": 17},
        {"sun": [-2, 1, 0.5], "sky": [0.2] * 3, "samples": 17},
    ),
    "no sun": ({"sun": (0, 0, 0), "sky": 1, "bake_samples": 5}, {"sun": [0, 0, 0], "sky": [1, 1, 1], "samples": 5}),
}


def assert_same_light(files: list[Path], depth: int, options: dict, daylight: dict) -> None:
    native = voxrt.build(files[0], depth=depth, bake=True, **options)
    (found,) = page_builds(files, depth=depth, bake=daylight)
    assert_same_memory(found, native.rom)
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
    assert_same_light([ROOT / "examples" / name for name in files], depth, *DAYLIGHTS[daylight])


@over_assets(
    "name",
    [
        *("gltf/trimesh/CesiumMilkTruck.glb", "gltf/bevy/animated/Fox.glb", "gltf/3d-demo-data/scene.glb"),
        *("gltf/glTF-Blender-IO/24_gpu_instancing.gltf", "ply/trimesh/cube_blender_uv.ply"),
    ],
)
def test_shared_assets_have_the_light_of_the_native_module(name: str) -> None:
    path = asset(name)
    beside = [one for one in path.parent.iterdir() if one.is_file() and one != path]
    assert_same_light([path, *beside], 7, *DAYLIGHTS["default"])
