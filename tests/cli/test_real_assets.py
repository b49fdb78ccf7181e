"""Assets made by other people, from file to picture."""

from __future__ import annotations

import numpy as np
from assets import asset, over_assets
from PIL import Image

import voxrt

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


@over_assets("name", REAL)
def test_builds_and_previews(name, tmp_path):
    result = voxrt.build(
        asset(name), tmp_path, depth=6, preview=True, size=(96, 72), engine="model", allow_outside=True
    )
    assert result.solid_voxels > 100
    assert sorted(result.outputs) == ["manifest", "mem", "preview"]
    rom, warnings = voxrt.read_rom(result.outputs["mem"])
    assert warnings == ()
    assert (rom.octree.words == result.rom.octree.words).all()
    assert rom.materials == result.rom.materials
    with Image.open(result.outputs["preview"]) as picture:
        pixels = np.asarray(picture)
    drawn = (pixels != pixels[0, 0]).any(axis=2)
    assert drawn.mean() > 0.02
    assert drawn.any(axis=0).mean() > 0.5 or drawn.any(axis=1).mean() > 0.5
