"""Textures and vertex colours of OBJ files."""

import numpy as np
import pytest
from oracles.sound_scenes import kinds
from PIL import Image

from voxrt.voxelize import AssetError
from voxrt.voxelize.colour.appearance import sample
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8, srgb_from_linear
from voxrt.voxelize.formats.obj import load_obj

# Two triangles side by side in the left and the right half of the texture, wound the same way.
QUADS = """mtllib model.mtl
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0
vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 1 0\nvt 1 1
usemtl cloth
f 1/1 2/2 3/3 4/4\nf 2/2/1 5/5/1 6/6/1 3/3/1
"""
RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)


@pytest.fixture
def obj(tmp_path):
    def write(text, mtl="", name="map.png", pixels=((RED, GREEN), (BLUE, WHITE))):
        Image.fromarray(np.array(pixels, dtype=np.uint8)).save(tmp_path / name)
        (tmp_path / "model.mtl").write_text(mtl)
        path = tmp_path / "model.obj"
        path.write_text(text)
        return load_obj(path)

    return write


def colours_at(mesh, weights=(1 / 3, 1 / 3, 1 / 3)):
    rows = np.arange(len(mesh.triangles))
    found = sample(mesh.appearance, rows, np.tile(weights, (len(rows), 1)))
    return [tuple(colour) for colour in srgb_from_linear(found[:, :3]).tolist()]


def test_v_points_up_in_the_image(obj):
    # The image's first row is its top: blue and white lie at v = 0.
    scene = obj(
        QUADS.replace("f 2/2/1 5/5/1 6/6/1 3/3/1\n", ""),
        "newmtl cloth\nmap_Kd map.png\n",
        pixels=[[RED]] * 16 + [[BLUE]] * 16,
    )
    (mesh,) = [one.mesh for one in scene.objects]
    surface_appearance = mesh.appearance
    bottom = sample(surface_appearance, np.array([0]), np.array([[0.9, 0.05, 0.05]]))[0]
    top = sample(surface_appearance, np.array([1]), np.array([[0.05, 0.05, 0.9]]))[0]
    assert srgb_from_linear(bottom[:3]).tolist() == list(BLUE)
    assert srgb_from_linear(top[:3]).tolist() == list(RED)


def test_the_texture_stands_in_for_kd(obj):
    scene = obj(QUADS, "newmtl cloth\nKd 0.5 0.5 0.5\nmap_Kd map.png\n", pixels=[[RED, RED, BLUE, BLUE]])
    (mesh,) = [one.mesh for one in scene.objects]
    named = [scene.materials[number] for number in mesh.materials]
    assert [(material.name, material.colour) for material in named] == [("cloth", (188, 0, 188))] * 4
    assert not scene.warnings


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ("", {0: RED, 2: BLUE}),
        ("-o 0.5 0 0", {0: BLUE, 2: RED}),
        ("-s -1 1", {0: BLUE, 2: RED}),
        ("-clamp on -o 1", {0: BLUE, 2: BLUE}),
        ("-blendu on -bm 0.5 -mm 0 1 -imfchan l", {0: RED, 2: BLUE}),
    ],
)
def test_options_stand_before_a_name_with_blanks(obj, options, expected):
    scene = obj(
        QUADS, f"newmtl cloth\nmap_Kd {options} .\\my map.png\n", name="my map.png", pixels=[[RED] * 8 + [BLUE] * 8]
    )
    found = colours_at(scene.objects[0].mesh)
    for triangle, colour in expected.items():
        assert found[triangle] == colour


def test_vertex_colours_are_srgb_and_multiplied_with_kd(obj):
    text = "mtllib model.mtl\nv 0 0 0 0.5 0.5 0.5\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 0.5 0.5 0.5\nf 1 2 3\n"
    assert obj(text).materials[1].colour == (128, 128, 128)
    assert obj(text.replace("f 1", "usemtl none\nf 1")).materials[1].colour == (128, 128, 128)
    half = int(srgb_from_linear(LINEAR_OF_SRGB8[128] ** 2))
    dyed = obj(text.replace("f 1", "usemtl dye\nf 1"), "newmtl dye\nKd 1 0 0.502\n").materials[1]
    assert dyed.colour == (128, 0, half)
    assert dyed.name == "dye"


@pytest.mark.parametrize(
    ("row", "colour", "warned"),
    [
        ("", None, set()),
        ("1", None, set()),
        ("0.5", None, {"vertex-numbers"}),
        ("1 0", None, {"vertex-numbers"}),
        ("1 0 0", RED, set()),
        ("1 0 0 1", RED, {"vertex-numbers"}),
        ("1 0 0 1 1", RED, {"vertex-numbers"}),
        ("255 0 0", RED, {"colour-range"}),
        ("1.5 0.5 0", (255, 128, 0), {"colour-range"}),
    ],
)
def test_the_numbers_after_a_place(row, colour, warned, obj):
    scene = obj(f"v 0 0 0 {row}\nv 1 0 0 {row}\nv 0 1 0 {row}\nf 1 2 3\n")
    if colour is not None:
        assert scene.materials[1].colour == colour
    assert {kind for kind, count in kinds(scene).items() if count == 3} == warned


def test_faces_without_colour_keep_their_material(obj):
    text = "v 0 0 0 0 0 1\nv 1 0 0 0 0 1\nv 0 1 0 0 0 1\nv 5 0 0\nv 6 0 0\nv 5 1 0\nf 1 2 3\nusemtl plain\nf 4 5 6\n"
    scene = obj("mtllib model.mtl\n" + text, "newmtl plain\nKd 0 1 0\n")
    assert {(one.name, one.colour) for one in scene.materials[1:]} == {("plain", GREEN), ("vertex colours", BLUE)}
    (one,) = scene.objects
    assert [scene.materials[number].colour for number in one.mesh.materials] == [BLUE, GREEN]
    assert one.mesh.appearance is None
    assert kinds(scene)["vertex-colour"] == 3


def test_negative_texture_numbers(obj):
    relative = QUADS.replace("f 1/1 2/2 3/3 4/4", "f 1/-6 2/-5 3/-4 4/-3")
    mtl = "newmtl cloth\nmap_Kd map.png\n"
    one, other = obj(relative, mtl).objects[0].mesh, obj(QUADS, mtl).objects[0].mesh
    assert np.array_equal(one.appearance.uv, other.appearance.uv)


def test_faces_without_texture_coordinates_are_counted(obj):
    scene = obj(QUADS.replace("f 1/1 2/2", "f 1 2//4"), "newmtl cloth\nmap_Kd map.png\n")
    assert kinds(scene) == {"texture": 1}


@pytest.mark.parametrize(
    ("change", "message"),
    [(("2/2/1 5/5/1", "2/2/1 5/9/1"), "line 16: texture coordinate 9 of a face does not exist: the file has 6")],
)
def test_refused(obj, change, message):
    with pytest.raises(AssetError) as caught:
        obj(QUADS.replace(*change), "newmtl cloth\nmap_Kd map.png\n")
    assert message in str(caught.value)


def test_a_broken_image(obj, tmp_path):
    obj(QUADS, "newmtl cloth\nmap_Kd map.png\n")
    data = (tmp_path / "map.png").read_bytes()
    for broken in (b"", b"GIF89a", data[:30], data[:45]):
        (tmp_path / "map.png").write_bytes(broken)
        scene = load_obj(tmp_path / "model.obj")
        assert kinds(scene)["texture"] == len(scene.objects[0].mesh.triangles) // 2


def test_an_image_that_promises_too_much(obj, tmp_path):
    obj(QUADS, "newmtl cloth\nmap_Kd map.png\n")
    header = bytearray((tmp_path / "map.png").read_bytes())
    header[16:24] = (10_000).to_bytes(4, "big") * 2
    import zlib

    header[29:33] = zlib.crc32(header[12:29]).to_bytes(4, "big")
    (tmp_path / "map.png").write_bytes(header)
    with pytest.raises(AssetError, match="more than 67,108,864 pixels"):
        load_obj(tmp_path / "model.obj")


def test_opacity_maps_cut_away_what_lies_below_a_half(obj, tmp_path):
    grey = np.array([[0, 255], [0, 255]], np.uint8)
    Image.fromarray(grey).save(tmp_path / "grey.png")
    clear = np.dstack([np.full((2, 2, 3), 9, np.uint8), grey])
    Image.fromarray(clear).save(tmp_path / "clear.png")
    for name in ("grey.png", "clear.png"):
        for lines, colour in ((f"map_Kd map.png\nmap_d {name}", GREEN), (f"map_d -s 1 1 {name}", RED)):
            scene = obj(QUADS, f"newmtl cloth\nKd 1 0 0\n{lines}\n", pixels=[[BLUE, BLUE, GREEN, GREEN]])
            (mesh,) = [one.mesh for one in scene.objects]
            assert len(mesh.triangles) == 2, "the left half is air"
            assert [mesh.positions[row].min(axis=0)[0] for row in mesh.triangles] == [1, 1]
            assert colours_at(mesh) == [colour] * 2


def test_an_opacity_map_of_another_layout_is_counted(obj, tmp_path):
    Image.fromarray(np.full((2, 2), 255, np.uint8)).save(tmp_path / "white.png")
    scene = obj(QUADS, "newmtl cloth\nmap_Kd -S 2 2 -O 0.5 map.png\nmap_d white.png\n")
    assert [one.kind for one in scene.warnings if one.kind != "painted"] == ["texture"]


def test_opacity_without_colour_of_other_sizes(obj, tmp_path):
    Image.fromarray(np.array([[0, 255, 255, 255]], np.uint8)).save(tmp_path / "wide.png")
    scene = obj(QUADS, "newmtl cloth\nmap_Kd map.png\nmap_d wide.png\n", pixels=[[RED], [BLUE]])
    (mesh,) = [one.mesh for one in scene.objects]
    assert mesh.appearance.entries[0].texture.pixels[:, :, 3].tolist() == [[0, 255, 255, 255]] * 2
    assert mesh.appearance.entries[0].texture.pixels[:, 3, :3].tolist() == [list(RED), list(BLUE)]


def test_textures_stand_beside_the_library_or_beside_the_file(tmp_path):
    """The library's folder comes first; names may have blanks, and a comment may follow them."""
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps" / "paint.mtl").write_text("newmtl cloth\nmap_Kd my map #1.png # painted\n")
    (tmp_path / "a.obj").write_text("mtllib maps/paint.mtl\n" + QUADS)
    image = Image.fromarray(np.full((2, 2, 3), RED, np.uint8))
    image.save(tmp_path / "my map #1.png")
    assert load_obj(tmp_path / "a.obj").materials[1].colour == RED
    Image.fromarray(np.full((2, 2, 3), BLUE, np.uint8)).save(tmp_path / "maps" / "my map #1.png")
    assert load_obj(tmp_path / "a.obj").materials[1].colour == BLUE
