"""Colours beyond their range are clamped and counted in every format; what only emits shows its emission."""

import base64
import json
import struct

import pytest
from oracles.sound_scenes import kinds

from voxrt.voxelize import AssetError, load

CORNERS = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


def obj(folder, library):
    (folder / "a.mtl").write_text(f"newmtl m\n{library}\n")
    (folder / "a.obj").write_text(f"mtllib a.mtl\n{CORNERS}usemtl m\nf 1 2 3\n")
    return load(folder / "a.obj")


def gltf(folder, material):
    data = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    document = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
        "materials": [material],
        "buffers": [{"byteLength": 36, "uri": uri}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
    }
    (folder / "a.gltf").write_text(json.dumps(document))
    return load(folder / "a.gltf")


def usd(folder, colour):
    (folder / "a.usda").write_text(
        '#usda 1.0\n(upAxis = "Y"\nmetersPerUnit = 1)\ndef Mesh "m" {\nuniform token subdivisionScheme = "none"\n'
        f"point3f[] points = [(0,0,0), (1,0,0), (0,1,0)]\nint[] faceVertexCounts = [3]\n{colour}\n"
        "int[] faceVertexIndices = [0, 1, 2]\n}\n"
    )
    return load(folder / "a.usda")


def ply(folder, kind, row, names=("red", "green", "blue")):
    properties = "".join(f"property {kind} {name}\n" for name in ("x", "y", "z"))
    colours = "".join(f"property {kind} {name}\n" for name in names)
    rows = "".join(f"{corner} {row}\n" for corner in ("0 0 0", "1 0 0", "0 1 0"))
    (folder / "a.ply").write_text(
        f"ply\nformat ascii 1.0\nelement vertex 3\n{properties}{colours}element face 1\n"
        f"property list uchar int vertex_indices\nend_header\n{rows}3 0 1 2\n"
    )
    return load(folder / "a.ply")


def base(*factor, **more):
    return {"pbrMetallicRoughness": {"baseColorFactor": list(factor)}, **more}


@pytest.mark.parametrize(
    ("reader", "colour", "right", "count"),
    [
        (obj, ("Kd 2 0.2 -1",), (255, 51, 0), 1),
        (obj, ("Kd 128 64 255",), (255, 255, 255), 1),
        (gltf, (base(2, 1, -1, 1),), (255, 255, 0), 1),
        (usd, ("color3f[] primvars:displayColor = [(2, 1, -1)]",), (255, 255, 0), 1),
        (usd, ('color3f[] primvars:displayColor = [(2,1,0), (3,1,0), (4,1,0)] (interpolation = "vertex")',),
         (255, 255, 0), 3),
        (ply, ("float", "-1 0.2 3"), (0, 51, 255), 6),
        (ply, ("float", "nan 0.2 0"), (0, 51, 0), 3),
        (ply, ("char", "-1 127 0"), (0, 255, 0), 3),
    ],
)  # fmt: skip
def test_colours_beyond_their_range_are_clamped_and_counted(reader, colour, right, count, tmp_path):
    scene = reader(tmp_path, *colour)
    assert scene.materials[1].colour == right
    assert kinds(scene) == {"colour-range": count}


def test_a_display_colour_that_is_no_number_is_black_and_counted(tmp_path):
    scene = usd(tmp_path, "color3f[] primvars:displayColor = [(nan, 1, 0)]")
    assert scene.materials[1].colour == (0, 255, 0)
    assert kinds(scene) == {"primvar": 1}


@pytest.mark.parametrize(
    ("library", "right"),
    [
        ("Kd 0 0 0\nKe 1 0.2 0", (255, 51, 0)),
        ("Ke 0 0 1\nKd 0 0 0", (0, 0, 255)),
        ("Ke 0 0 1", (0, 0, 255)),
        ("Kd 0 1 0\nKe 1 0 0", (0, 255, 0)),
        ("Kd 0 0 0\nKe 0 0 0", (0, 0, 0)),
    ],
)
def test_an_obj_material_that_only_emits_shows_its_emission(library, right, tmp_path):
    scene = obj(tmp_path, library)
    assert scene.materials[1].colour == right
    assert not scene.warnings


@pytest.mark.parametrize(
    ("library", "message"),
    [
        ("Kd 0,5 0 0", "line 2: '0,5' is not a number; numbers have a decimal point, not a comma: write 0.5"),
        ("Kd 1_0 0 0", "line 2: '1_0' is not a number; repair it, or export the file again"),
        ("Ke 1 0", "line 2: Ke needs three numbers; repair the line"),
    ],
)
def test_numbers_of_libraries_are_those_of_other_files(library, message, tmp_path):
    with pytest.raises(AssetError) as error:
        obj(tmp_path, library)
    assert str(error.value).endswith(message)


@pytest.mark.parametrize(
    ("names", "read"), [(("Red", "Green", "Blue"), True), (("ambient_red", "Green", "rgb"), False)]
)
def test_colours_of_other_names_are_read_or_named(names, read, tmp_path):
    scene = ply(tmp_path, "uchar", "10 20 30", names)
    assert (scene.materials[1].colour == (10, 20, 30)) == read
    assert [one.message for one in scene.warnings] == (
        [] if read else ["properties ambient_red, Green, rgb were left out: name colours red, green, blue"]
    )


def test_a_threshold_of_a_half_is_not_mistaken_for_the_option(tmp_path):
    with pytest.raises(AssetError, match="a lower --opaque-from keeps them, unless their material has a threshold"):
        gltf(tmp_path, base(1, 0, 0, 0.3, alphaMode="MASK"))
