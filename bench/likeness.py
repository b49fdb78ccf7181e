"""Previews beside reference pictures of their sources: brightness, SSIM and CIEDE2000, for two ways of shading.

Usage: ``python bench/likeness.py [--write] [--only WORD] [--pictures FOLDER]``. ``--write`` puts the table into
``bench/results/likeness.md`` and the contact sheet into ``docs/pictures/likeness-sheet.png``. The assets are those that
the project is developed with (``VOXRT_ASSETS``).

Each asset is voxelized at depth 8 and rendered with brightness by face, and with baked light. The reference
(``reference_picture.py``) shows its triangles from the same camera, under the sun and the sky of the baked light. All
pictures have 2 x 2 rays per pixel, averaged in linear light. Figures are of the pixels that show the asset in both
pictures, but for the SSIM, which is that of the whole pictures.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from ciede2000 import ciede2000, lab
from PIL import Image, ImageDraw
from reference_picture import Reference
from report import ASSETS, ROOT, options_of, write_page

import voxrt
from voxrt.octree.camera import Lighting, pixel_directions
from voxrt.sim import structural_similarity
from voxrt.sim.baking.daylight import Daylight
from voxrt.voxelize import AssetError
from voxrt.voxelize.colour.srgb import linear_from_srgb, srgb_from_linear

SHEET = ROOT / "docs" / "pictures" / "likeness-sheet.png"
DEPTH, SIZE, FINER, SKY_RAYS = 8, (240, 180), 2, 48
LEAST, MOST = 0.8, 1.25
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_ON_SHEET = 10
NAMES = """
gltf/trimesh/CesiumMilkTruck.glb
gltf/trimesh/no_indices_3storybuilding.glb
gltf/trimesh/nested.glb
gltf/bevy/AlienCake/alien.glb
gltf/bevy/AlienCake/cakeBirthday.glb
gltf/bevy/animated/Fox.glb
gltf/bevy/CornellBox/CornellBox.glb
gltf/bevy/PalmTree/PalmTree.gltf
gltf/Vulkan-Assets/retroufo.glb
gltf/glTF-Transform/functions/test/in/DenseSphere.glb
gltf/draco/VertexColorTest/glTF/VertexColorTest.gltf
gltf/3d-demo-data/scene.glb
gltf/meshoptimizer/pirate.glb
gltf/gltf-pipeline/meshopt-fallback/meshopt-fallback.gltf
gltf/manifold/mengerSponge3.glb
obj/trimesh/rabbit.obj
obj/trimesh/quadknot.obj
obj/trimesh/chair_model.obj
obj/tinyobjloader/cornell_box.obj
obj/assimp/spider.obj
obj/assimp/regr01.obj
obj/assimp/cube_with_vertexcolors.obj
obj/odedstein-meshes/skull/skull.obj
obj/odedstein-meshes/plane/plane_holes.obj
obj/odedstein-meshes/spot/spot_control_mesh.obj
obj/kaolin/amsterdam.obj
obj/kaolin/pizza.obj
usd/usd-wg-assets/full_assets/Teapot/Teapot.usd
usd/usd-wg-assets/full_assets/Vehicles/USD_Mini_Car_Kit/assets/vehicles/formula/asset/formulaFullAsset.usda
usd/usd-wg-assets/full_assets/Vehicles/USD_Mini_Car_Kit/assets/vehicles/truckFlat/asset/truckFlatFullAsset.usda
usd/usd-wg-assets/test_assets/USDZ/CesiumMan/CesiumMan.usdz
usd/usd-wg-assets/test_assets/USDZ/InterpolationTest/InterpolationTest.usdz
usd/usd-wg-assets/test_assets/schemaTests/usdGeom/primitives/all_primitives.usda
usd/newton/examples/assets/crazyflie.usd
usd/newton/examples/assets/bear.usd
usd/tinyusdz/texture-cat-plane.usdz
stl/trimesh/idler_riser.STL
stl/trimesh/featuretype.STL
stl/USD-Fileformat-plugins/car.stl
stl/USD-Fileformat-plugins/suzanne.stl
"""


@dataclass(frozen=True)
class Figures:
    """How like one picture is to its reference."""

    ratio: float  # of mean luminances, picture to reference
    ssim: float
    difference: float  # mean CIEDE2000


def pictures(path: Path) -> tuple[np.ndarray, dict[str, np.ndarray], np.ndarray, dict[str, np.ndarray]]:
    """Give the reference and the previews of an asset, sRGB, and which pixels of each show the asset."""
    options = voxrt.BuildOptions(depth=DEPTH, geometry="render", allow_outside=True)
    plain = voxrt.build(path, options=options)
    baked = voxrt.build(path, options=options, bake=True)
    fine = (FINER * SIZE[0], FINER * SIZE[1])
    camera = voxrt.aim_camera(plain.rom, fine)
    shown, solid = {}, {}
    for name, rom, lighting in (("faces", plain.rom, Lighting()), ("--bake", baked.rom, Lighting(flat=True))):
        frame = voxrt.render(rom, camera, size=fine, engine="model", lighting=lighting)
        shown[name] = srgb_from_linear(coarser(linear_from_srgb(frame.colour)))
        solid[name] = coarser((frame.material != 0).astype(float)[..., None])[..., 0] > 1 - 1e-9
    assert plain.rom.grid is not None
    reference = Reference(voxrt.load(path, allow_outside=True), plain.rom.grid)
    ways = pixel_directions(camera, fine).reshape(-1, 3).astype(np.float64)
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    origins = np.broadcast_to(np.array(camera.position) / 16, ways.shape)
    background = linear_from_srgb(np.array(plain.rom.materials[0].colour))
    colour, hit = reference.shade(origins, ways, Daylight(), background, SKY_RAYS)
    height, width = fine[1], fine[0]
    picture = srgb_from_linear(coarser(np.clip(colour, 0, 1).reshape(height, width, 3)))
    covered = coarser(hit.astype(float).reshape(height, width, 1))[..., 0] > 1 - 1e-9
    return picture, shown, covered, solid


def coarser(pixels: np.ndarray) -> np.ndarray:
    height, width, channels = pixels.shape
    return pixels.reshape(height // FINER, FINER, width // FINER, FINER, channels).mean(axis=(1, 3))


def figures(picture: np.ndarray, reference: np.ndarray, both: np.ndarray) -> Figures:
    ours, theirs = linear_from_srgb(picture[both]), linear_from_srgb(reference[both])
    ratio = float((ours @ _LUMINANCE).mean() / max((theirs @ _LUMINANCE).mean(), 1e-9))
    difference = float(ciede2000(lab(ours), lab(theirs)).mean())
    return Figures(ratio, structural_similarity(picture, reference), difference)


def sheet(rows: list[tuple[str, list[np.ndarray]]]) -> Image.Image:
    """Lay out pictures: one row per asset, the reference first."""
    width, height = SIZE
    heads, margin = ("source", "faces", "--bake"), 16
    page = Image.new("RGB", (2 * 3 * width, margin + -(-len(rows) // 2) * height), (255, 255, 255))
    draw = ImageDraw.Draw(page)
    for column in range(6):
        draw.text((column * width + 6, 2), heads[column % 3], fill=(0, 0, 0))
    for number, (_, shown) in enumerate(rows):
        for column, pixels in enumerate(shown):
            place = ((3 * (number % 2) + column) * width, margin + number // 2 * height)
            page.paste(Image.fromarray(pixels), place)
    return page


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--only", default="", help="assets whose path holds this")
    parser.add_argument("--pictures", type=Path, help="folder for the pictures of each asset")
    options = parser.parse_args()
    lines, kept, within = [], [], {"faces": 0, "--bake": 0}
    for name in NAMES.split():
        if options.only not in name or not (ASSETS / name).exists():
            continue
        try:
            reference, shown, covered, solid = pictures(ASSETS / name)
        except AssetError as error:
            print(f"{name}: {error}", flush=True)
            continue
        cells = []
        for way, picture in shown.items():
            found = figures(picture, reference, covered & solid[way])
            within[way] += LEAST <= found.ratio <= MOST
            cells += [f"{found.ratio:.2f}", f"{found.ssim:.3f}", f"{found.difference:.1f}"]
        lines.append(f"| `{name}` | {' | '.join(cells)} |")
        print(lines[-1], flush=True)
        kept.append((name, [reference, *shown.values()]))
        if options.pictures:
            options.pictures.mkdir(parents=True, exist_ok=True)
            file = options.pictures / (name.replace("/", "-") + ".png")
            Image.fromarray(np.concatenate([reference, *shown.values()], axis=1)).save(file)
    summary = ", ".join(f"`{way}` on {count} of {len(lines)}" for way, count in within.items())
    print(f"luminance within {LEAST} to {MOST}: {summary}")
    if options.write:
        head = "| asset | faces: luminance | SSIM | CIEDE2000 | `--bake`: luminance | SSIM | CIEDE2000 |"
        text = "\n".join([head, "|---|" + "--:|" * 6, *lines])
        about = (
            f"Previews at depth {DEPTH} against reference pictures of their triangles, by `bench/likeness.py`.\n"
            "Luminance is the mean of the preview's, divided by that of the reference.\n"
            f"It lies within {LEAST} to {MOST}: {summary}.\n"
        )
        write_page("likeness.md", f"# Likeness to the source\n\n{about}\n{text}\n")
        chosen = [kept[i] for i in np.linspace(0, len(kept) - 1, min(_ON_SHEET, len(kept))).round().astype(int)]
        sheet(chosen).quantize(256, dither=Image.Dither.NONE).save(SHEET, optimize=True)


if __name__ == "__main__":
    main()
