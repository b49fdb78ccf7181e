"""Assets made by other people, from file to picture."""

from __future__ import annotations

import json

import numpy as np
import pytest
from assets import asset
from PIL import Image

REAL = [
    "gltf/bevy/CornellBox/CornellBox.glb",
    "gltf/bevy/AlienCake/alien.glb",
    "gltf/bevy/AlienCake/cakeBirthday.glb",
    "gltf/bevy/animated/Fox.glb",
    "gltf/trimesh/CesiumMilkTruck.glb",
    "gltf/trimesh/no_indices_3storybuilding.glb",
    "gltf/manifold/mengerSponge3.glb",
    "obj/tinyobjloader/cornell_box.obj",
    "obj/assimp/spider.obj",
    "obj/kaolin/amsterdam.obj",
    "obj/odedstein-meshes/spot/spot_control_mesh.obj",
    "obj/trimesh/quadknot.obj",
    "obj/trimesh/rabbit.obj",
    "usd/OpenUSD/usd/usdPhysics/examples/usdPhysicsSpheresWithMaterial.usda",
    "usd/PhysX/boxes_falling_on_groundplane.usda",
    "usd/kaolin/tests/samples/io/pizza.usdz",
    "usd/newton/examples/assets/bear.usd",
    "usd/tinyusdz/texturedcube.usdc",
    "usd/usd-wg-assets/full_assets/Teapot/Teapot.usd",
    "usd/usd-wg-assets/full_assets/Vehicles/USD_Mini_Car_Kit/assets/vehicles/vehicleVariants.usda",
]


@pytest.mark.parametrize("name", REAL)
def test_builds_and_previews(voxrt, folder, name):
    arguments = ("build", asset(name), "-o", "out", "--depth", "6", "--preview", "out/picture.png", "--size", "96x72")
    finished = voxrt(*arguments, "--engine", "model", "--json")
    assert finished.code == 0, finished.err
    result = json.loads(finished.out)
    assert result["voxels"] > 100
    assert result["words"] == 1 + 8 * result["blocks"] > 9
    with Image.open(folder / "out/picture.png") as picture:
        pixels = np.asarray(picture)
    drawn = (pixels != pixels[0, 0]).any(axis=2)
    assert drawn.mean() > 0.02
    assert drawn.any(axis=0).mean() > 0.7 or drawn.any(axis=1).mean() > 0.7
