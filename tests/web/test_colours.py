"""Textures and vertex colours in the WebAssembly module: the same words, materials and warnings as the native ones."""

from __future__ import annotations

import json
import math
import struct
import zlib
from typing import TYPE_CHECKING

import numpy as np
import pytest
from assets import asset, over_assets
from fakes.site import ROOT, assert_same_memory, node, objects_of, page_builds, sha, warnings_of
from oracles.gltf_writer import GltfWriter
from oracles.meshes import box_mesh
from PIL import Image

import voxrt
from voxrt.voxelize.formats.image_file import decode_image
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from pathlib import Path


def build_both(files: list[list[Path]], depth: int) -> list[tuple[voxrt.BuildResult, dict]]:
    """Build each first file natively and in Node, the others beside it: the memories are the same."""
    natives = [voxrt.build(group[0], depth=depth) for group in files]
    pairs = list(zip(natives, page_builds(*files, depth=depth), strict=True))
    for native, found in pairs:
        assert_same_memory(found, native.rom)
    return pairs


def noise(shape: tuple[int, ...]) -> np.ndarray:
    return np.random.default_rng(sum(shape)).integers(0, 256, shape, np.uint8)


def textured_gltf(folder: Path, **how: object) -> list[Path]:
    """A box with a texture, a second one with vertex colours, and a third that shows the first again, smaller."""
    folder.mkdir()
    image = how.get("image", noise((48, 32, 4)))
    Image.fromarray(image).save(folder / "map.png")
    box = box_mesh([0, 0, 0], [1, 1, 1])
    corners = box.positions[box.triangles].reshape(-1, 3)
    uv = np.stack([corners[:, 0] + 0.5 * corners[:, 2], 1.7 * corners[:, 1] - 0.3], axis=1)
    writer = GltfWriter()
    writer.add("images", {"uri": "map.png"})
    writer.add("samplers", how.get("sampler", {}))
    writer.add("textures", {"source": 0, "sampler": 0})
    look = {"baseColorTexture": {"index": 0, **how.get("texture", {})}, "baseColorFactor": [0.9, 1, 0.5, 1]}
    writer.add("materials", {"name": "look", "pbrMetallicRoughness": look, **how.get("material", {})})
    writer.add("materials", {"name": "plain", "pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.1, 1]}})
    first = writer.mesh(corners, material=0, TEXCOORD_0=writer.accessor(uv))
    writer.show(mesh=first, name="first")
    tints = noise((len(corners), 4))
    tints[:, 3] = 255
    second = writer.mesh(corners, material=1, COLOR_0=writer.accessor(tints, "u1", normalized=True))
    writer.show(mesh=second, name="second", translation=[2, 0, 0])
    writer.show(mesh=first, name="third", translation=[0, 2, 0], scale=[0.5, 0.5, 0.5])
    writer.show(mesh=writer.mesh(corners, material=1), name="fourth", translation=[2, 2, 0])
    lamp = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [0.5, 0.25, 0.1]}
    strong = {"KHR_materials_emissive_strength": {"emissiveStrength": 1.7}}
    writer.add("materials", {"name": "lamp", **lamp, "extensions": strong})
    tinted = writer.accessor(tints, "u1", normalized=True)  # which changes nothing
    writer.show(mesh=writer.mesh(corners, material=2, COLOR_0=tinted), name="fifth", translation=[4, 2, 0])
    return [writer.save(folder / "box.gltf"), folder / "map.png"]


LOOKS = {
    "mixed": {},
    "cut away": {"material": {"alphaMode": "MASK", "alphaCutoff": 0.4}},
    "nearest, mirrored and clamped": {"sampler": {"magFilter": 9728, "wrapS": 33648, "wrapT": 33071}},
    "moved": {"texture": {"extensions": {"KHR_texture_transform": {"scale": [2, -1.5], "offset": [0.1, 0.3]}}}},
    "large": {"image": noise((700, 900, 3))},
    "clear": {"image": np.zeros((4, 4, 4), np.uint8), "material": {"alphaMode": "BLEND"}},
}


def test_gltf_colours_are_those_of_the_native_module(tmp_path: Path) -> None:
    files = [textured_gltf(tmp_path / str(at), **how) for at, how in enumerate(LOOKS.values())]
    for native, found in build_both(files, 6):
        assert found["objects"] == objects_of(native)
        assert sorted(found["warnings"], key=str) == sorted(warnings_of(native.warnings), key=str)


def test_obj_and_ply_colours_are_those_of_the_native_module(tmp_path: Path) -> None:
    box = box_mesh([0, 0, 0], [1, 1, 1])
    corners = box.positions[box.triangles].reshape(-1, 3)
    tints = noise((len(corners), 3))
    Image.fromarray(noise((16, 16, 3))).save(tmp_path / "my map.png")
    (tmp_path / "box.mtl").write_text("newmtl look\nKd 0.5 0.5 0.5\nmap_Kd -s 2 3 -o 0.25 0.5 my map.png\n")
    lines = ["mtllib box.mtl", *(f"v {x} {y} {z}" for x, y, z in corners), *(f"vt {x} {z + y}" for x, y, z in corners)]
    lines += ["usemtl look", *(f"f {i}/{i} {i + 1}/{i + 1} {i + 2}/{i + 2}" for i in range(1, 37, 3))]
    (tmp_path / "box.obj").write_text("\n".join(lines) + "\n")
    tinted = [
        f"v {x} {y} {z} {r / 255} {g / 255} {b / 255}"
        for (x, y, z), (r, g, b) in zip(corners, tints.tolist(), strict=True)
    ]
    faces = [f"f {i} {i + 1} {i + 2}" for i in range(1, 37, 3)]
    (tmp_path / "tinted.obj").write_text("\n".join([*tinted, *faces]) + "\n")
    properties = [f"property float {axis}" for axis in "xyz"]
    properties += [f"property uchar {channel}" for channel in ("red", "green", "blue")]
    rows = [f"{x} {y} {z} {r} {g} {b}" for (x, y, z), (r, g, b) in zip(corners.tolist(), tints.tolist(), strict=True)]
    header = ["ply", "format ascii 1.0", "element vertex 36", *properties, "element face 12"]
    header += ["property list uchar int vertex_indices", "end_header"]
    faces = [f"3 {i} {i + 1} {i + 2}" for i in range(0, 36, 3)]
    (tmp_path / "tinted.ply").write_text("\n".join([*header, *rows, *faces]) + "\n")
    header = ["ply", "format binary_little_endian 1.0", "element vertex 36", *(f"property float {a}" for a in "xyz")]
    header += ["element face 12", "property list uchar int vertex_indices", "end_header\r"]
    faces = [struct.pack("<Biii", 3, i, i + 1, i + 2) for i in range(0, 36, 3)]
    data = (corners * [1, 0.75, 0.5]).astype("<f4").tobytes() + b"".join(faces)
    (tmp_path / "returned.ply").write_bytes(("\n".join(header) + "\n").encode() + data)
    files = [["box.obj", "box.mtl", "my map.png"], ["tinted.obj"], ["tinted.ply"], ["returned.ply"]]
    build_both([[tmp_path / name for name in group] for group in files], 6)


CONCAVE = {
    "arrow": [(0, 0), (4, 0), (1, 1), (0, 4)],
    "arrow turned": [(4, 0), (1, 1), (0, 4), (0, 0)],
    "letter": [(0, 0), (4, 0), (4, 1), (1, 1), (1, 3), (4, 3), (4, 4), (0, 4)],
    "star": [(math.cos(a) * r, math.sin(a) * r) for a, r in ((math.pi * i / 5, 2 + i % 2 * 2) for i in range(10))],
    "comb": [(0, 0), *((2 * i + x, y) for i in range(5) for x, y in ((0, 3), (1, 3), (1, 1), (2, 1))), (10, 0)],
    "convex": [(0, 0), (3, 0), (4, 2), (3, 4), (0, 4)],
}


def prism_obj(outline: list[tuple[float, float]], tilt: float) -> str:
    """A prism whose ends are single polygons, tilted, one of them by numbers that count back."""
    cosine, sine = math.cos(tilt), math.sin(tilt)
    lines = []
    for depth in (0, 1.5):
        lines += [f"v {x} {y * cosine - depth * sine} {y * sine + depth * cosine}" for x, y in outline]
    count = len(outline)
    lines.append("usemtl half")
    lines.append("f " + " ".join(str(count - i) for i in range(count)))
    lines.append("f " + " ".join(str(i - count) for i in range(count)))
    sides = [(i + 1, (i + 1) % count + 1) for i in range(count)]
    lines += [f"f {a} {b} {b + count} {a + count}" for a, b in sides]
    return "\n".join(["mtllib prism.mtl", "o gl\xe6s", *lines]) + "\n"


@pytest.mark.parametrize("tilt", [0, 0.4, 2])
def test_concave_polygons_have_the_words_of_the_native_module(tmp_path: Path, tilt: float) -> None:
    (tmp_path / "prism.mtl").write_text("newmtl half\nKd 0.7 0.5 0.3\n")
    names = [name.replace(" ", "_") for name in CONCAVE]
    for name, outline in zip(names, CONCAVE.values(), strict=True):
        (tmp_path / f"{name}.obj").write_bytes(prism_obj(outline, tilt).encode("cp1252"))
    files = [[tmp_path / f"{name}.obj", tmp_path / "prism.mtl"] for name in names]
    for native, found in build_both(files, 6):
        assert [one["name"] for one in found["objects"]] == [one.name for one in native.objects] == ["gl\xe6s"]


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def interlaced_png(pixels: np.ndarray) -> bytes:
    """A PNG of seven passes, RGB."""
    height, width = pixels.shape[:2]
    lines = bytearray()
    for x, y, dx, dy in (
        *((0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2)),
        (0, 1, 1, 2),
    ):
        part = pixels[y::dy, x::dx]
        if part.size:
            lines += b"".join(b"\0" + row.tobytes() for row in part)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 1)
    packed = zlib.compress(bytes(lines))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")


def test_png_files_are_decoded_as_natively(tmp_path: Path) -> None:
    smooth = np.add.outer(np.arange(37), np.arange(29)).astype(np.uint8)  # which writers filter
    pictures = {
        "rgb": Image.fromarray(noise((13, 17, 3))),
        "rgba": Image.fromarray(noise((13, 17, 4))),
        "smooth": Image.fromarray(np.dstack([smooth, 3 * smooth, 255 - smooth])),
        "grey": Image.fromarray(noise((9, 11))),
        "grey and alpha": Image.fromarray(noise((9, 11, 2)), "LA"),
        "bits": Image.fromarray(noise((9, 11))).convert("1"),
        "palette": Image.fromarray(noise((9, 11, 3))).quantize(13),
        "few": Image.fromarray(noise((9, 11, 3))).quantize(3),
        "grey of 16 bits": Image.fromarray(noise((9, 11)).astype(np.uint16) * 257 + 3),
    }
    for name, picture in pictures.items():
        picture.save(tmp_path / f"{name}.png")
    pictures["palette"].save(tmp_path / "clear palette.png", transparency=bytes(range(0, 130, 10)))
    pictures["rgb"].save(tmp_path / "clear colour.png", transparency=pictures["rgb"].getpixel((3, 4)))
    (tmp_path / "passes.png").write_bytes(interlaced_png(noise((13, 17, 3))))
    (tmp_path / "dot.png").write_bytes(interlaced_png(noise((1, 1, 3))))
    paths = sorted(tmp_path.glob("*.png"))
    found = node("decode_images.mjs", [str(path) for path in paths])
    for path, one in zip(paths, found, strict=True):
        native = decode_image(path.read_bytes(), path, "image", WarningLog())
        assert one == {"size": [native.shape[1], native.shape[0]], "sha": sha(native)}, path


def test_objects_of_gltf_have_rules_and_fills_of_their_own(tmp_path: Path) -> None:
    glb = (ROOT / "examples" / "courtyard.glb").read_bytes()
    length = int.from_bytes(glb[12:16], "little")
    described = json.loads(glb[20 : 20 + length])
    files = []
    for rule, fill in (("half", "solid"), ("touch", "surface"), ("round", "solid"), ("half", "together")):
        for shown in (one for one in described["nodes"] if "mesh" in one):
            shown["extras"] = {**shown.get("extras", {}), "voxrt_rule": rule, "voxrt_fill": fill}
        text = json.dumps(described).encode()
        text += b" " * (-len(text) % 4)
        rest = glb[20 + length :]
        head = glb[:8] + struct.pack("<III", 20 + len(text) + len(rest), len(text), 0x4E4F534A)
        files.append(tmp_path / f"{rule} {fill}.glb")
        files[-1].write_bytes(head + text + rest)
    *found, no_rule, no_fill = page_builds(*([file] for file in files), depth=6)
    plain = sha(voxrt.build(ROOT / "examples" / "courtyard.glb", depth=6).octree.words)
    for file, one in zip(files, found, strict=False):
        assert_same_memory(one, voxrt.build(file, depth=6).rom)
        assert one["words"] != plain
    assert "is no rule; name one of touch, centre, half" in no_rule["problem"]
    assert "is no fill; name one of solid, surface, auto" in no_fill["problem"]


def test_groups_within_objects_of_obj_are_no_objects(tmp_path: Path) -> None:
    """A closed object whose sides are groups is filled, as natively."""
    corners = [f"v {x} {y} {z}" for x, y, z in ((0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4))]
    sides = [f"g side_{i}\nf {face}" for i, face in enumerate(("1 3 2", "1 2 4", "1 4 3", "2 3 4"))]
    (tmp_path / "grouped.obj").write_text("\n".join([*corners, "o wedge", *sides]) + "\n")
    (found,) = page_builds([tmp_path / "grouped.obj"], depth=5)
    native = voxrt.build(tmp_path / "grouped.obj", depth=5)
    assert_same_memory(found, native.rom)
    assert found["objects"] == objects_of(native)


def test_broken_images_are_refused_in_one_line(tmp_path: Path) -> None:
    whole = interlaced_png(noise((13, 17, 3)))
    huge = whole[:16] + struct.pack(">II", 1 << 20, 1 << 20) + whole[24:]
    bad = {"cut": whole[:-60], "head": whole[:20], "huge": huge, "noise": whole[:8] + bytes(100), "other": b"BM"}
    for name, content in bad.items():
        (tmp_path / name).write_bytes(content)
    files = [str(tmp_path / name) for name in bad]
    for one in node("decode_images.mjs", files):
        assert "the image cannot be decoded" in one["problem"]
        assert "\n" not in one["problem"]


ASSETS = (
    *(f"gltf/bevy/{name}" for name in ("PalmTree/PalmTree.gltf", "animated/MorphStressTest.gltf", "animated/Fox.glb")),
    *("gltf/manifold/mengerSponge3.glb", "gltf/trimesh/CesiumMilkTruck.glb", "gltf/trimesh/BoxInterleaved.glb"),
    *("gltf/draco/VertexColorTest/glTF/VertexColorTest.gltf", "gltf/trimesh/nested.glb", "gltf/3d-demo-data/scene.glb"),
    *("gltf/Vulkan-Assets/retroufo.glb", "gltf/bevy/AlienCake/alien.glb", "gltf/bevy/AlienCake/cakeBirthday.glb"),
    *("gltf/bevy/CornellBox/CornellBox.glb", "gltf/meshoptimizer/pirate.glb", "gltf/cesium-native/0.gltf"),
    *("gltf/glTF-Blender-IO/24_gpu_instancing.gltf", "gltf/glTF-Transform/functions/test/in/ShapeCollection.glb"),
    *(f"gltf/gltf-pipeline/{name}/{name}.gltf" for name in ("meshopt-fallback", "meshopt-no-fallback")),
    *("obj/assimp/cube_with_vertexcolors.obj", "obj/assimp/number_formats.obj", "obj/kaolin/amsterdam.obj"),
    *(
        "obj/assimp/regr01.obj",
        "obj/assimp/box_UTF16BE.obj",
        "obj/tinyobjloader/cornell_box_multimaterial.obj",
        "obj/trimesh/rabbit.obj",
    ),
    *("obj/trimesh/quadknot.obj", "obj/trimesh/negative_indices.obj", "ply/trimesh/cube_blender_uv.ply"),
    *(f"ply/USD-Fileformat-plugins/{name}.ply" for name in ("colors", "gargo")),
    *("ply/assimp/cube_uv.ply", "ply/assimp/float-color.ply", "stl/trimesh/soup.stl"),
    *(f"stl/USD-Fileformat-plugins/{name}.stl" for name in ("ascii", "car", "suzanne")),
)
"""Files of all kinds, with textures of PNG, with vertex colours and without either."""


@over_assets("name", ASSETS)
def test_shared_assets_have_the_words_of_the_native_module(name: str) -> None:
    path = asset(name)
    beside = [one for one in sorted(path.parent.rglob("*")) if one.suffix in {".bin", ".png", ".mtl"}]
    build_both([[path, *beside]], 7)
