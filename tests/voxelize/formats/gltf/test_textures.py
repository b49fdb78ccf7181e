"""Colour from textures, vertices, factors, variants and extensions, on files whose answer is known."""

import io
import json

import numpy as np
import pytest
from oracles.gltf_writer import GltfWriter
from oracles.sound_scenes import kinds
from PIL import Image

from voxrt.voxelize import AssetError, DoesNotFitError, load
from voxrt.voxelize.colour.appearance import sample
from voxrt.voxelize.colour.srgb import srgb_from_linear

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
RED, GREEN, BLUE, WHITE = (255, 0, 0, 255), (0, 255, 0, 255), (0, 0, 255, 255), (255, 255, 255, 255)
QUARTERS = np.array([[RED, GREEN], [BLUE, WHITE]], np.uint8)  # seen from above: v grows downwards
MIDDLE = np.array([[1, 1, 1]]) / 3


def encoded(pixels, kind="PNG", **options):
    data = io.BytesIO()
    Image.fromarray(np.asarray(pixels)).save(data, kind, **options)
    return data.getvalue()


def textured(uv=(0.25, 0.25), image=None, *, material=None, texture=None, sampler=None, colours=None, set_number=0):
    """A triangle whose corners all have the texture coordinates `uv`."""
    writer = GltfWriter()
    data = encoded(QUARTERS) if image is None else image
    writer.add("images", {"bufferView": writer.view(data), "mimeType": "image/png"})
    writer.add("samplers", {"magFilter": 9728, "wrapS": 10497, "wrapT": 10497} | (sampler or {}))
    writer.add("textures", {"sampler": 0, "source": 0})
    base = {"baseColorTexture": {"index": 0} | (texture or {})}
    writer.add("materials", {"name": "cloth", "pbrMetallicRoughness": base} | (material or {}))
    attributes = {f"TEXCOORD_{set_number}": writer.accessor([uv] * 3)}
    if colours is not None:
        attributes["COLOR_0"] = colours(writer)
    writer.show(mesh=writer.mesh(TRIANGLE, material=0, **attributes))
    return writer


def seen(writer, path, **options):
    """The sRGB colour of the only triangle, by its material and by its appearance."""
    scene = load(writer.save(path), **options)
    (thing,) = scene.objects
    colour = scene.materials[int(thing.mesh.materials[0])].colour
    if thing.mesh.appearance is not None:
        painted = sample(thing.mesh.appearance, np.array([0]), MIDDLE)[0, :3]
        assert tuple(srgb_from_linear(painted).tolist()) == colour
    return colour


@pytest.mark.parametrize("kind", ["PNG", "WEBP"])
@pytest.mark.parametrize(
    ("uv", "colour"), [((0.25, 0.25), RED), ((0.75, 0.25), GREEN), ((0.25, 0.75), BLUE), ((0.75, 0.75), WHITE)]
)
def test_row_0_of_the_image_is_at_v_0(uv, colour, kind, tmp_path):
    image = encoded(QUARTERS, kind, **({"lossless": True} if kind == "WEBP" else {}))
    assert seen(textured(uv, image), tmp_path / "a.glb") == colour[:3]


@pytest.mark.parametrize("mode", ["L", "LA", "P", "RGB", "I;16", "1"])
def test_images_of_any_mode_become_colours(mode, tmp_path):
    if mode == "I;16":
        image = Image.fromarray(np.full((2, 2), 0x80FF, np.uint16))
    else:
        image = Image.fromarray(np.full((2, 2, 3), 255 if mode == "1" else 128, np.uint8)).convert(
            mode, palette=Image.Palette.ADAPTIVE
        )
    data = io.BytesIO()
    image.save(data, "PNG")
    expected = 255 if mode == "1" else 128
    assert seen(textured(image=data.getvalue()), tmp_path / "a.glb") == (expected,) * 3


@pytest.mark.parametrize(
    ("wrap", "uv", "colour"),
    [
        ((10497, 10497), (1.25, -0.25), BLUE),
        ((33071, 33071), (1.75, -0.25), GREEN),
        ((33648, 33648), (1.25, -0.25), GREEN),
        ((33071, 10497), (-5.0, 3.75), BLUE),
    ],
)
def test_wrapping(wrap, uv, colour, tmp_path):
    sampler = {"wrapS": wrap[0], "wrapT": wrap[1]}
    assert seen(textured(uv, sampler=sampler), tmp_path / "a.glb") == colour[:3]


def test_texture_factor_and_vertex_colours_multiply_in_linear_light(tmp_path):
    def colours(writer):
        return writer.accessor([[0.5, 0.25, 1.0]] * 3)

    base = {"baseColorTexture": {"index": 0}, "baseColorFactor": [1.0, 0.5, 0.5, 1.0]}
    writer = textured((0.75, 0.75), material={"pbrMetallicRoughness": base}, colours=colours)
    assert seen(writer, tmp_path / "a.glb") == tuple(srgb_from_linear([0.5, 0.125, 0.5]).tolist())


@pytest.mark.parametrize(("dtype", "scale"), [("u1", 255), ("u2", 65535), ("f4", 1)])
@pytest.mark.parametrize("flagged", [True, False])
def test_vertex_colours_are_linear_whatever_their_type(dtype, scale, flagged, tmp_path):
    writer = GltfWriter()
    values = np.array([[scale, 0, 0, scale], [0, scale, 0, scale], [0, 0, scale, scale]])
    colours = writer.accessor(values, dtype, normalized=flagged and dtype != "f4")
    writer.show(mesh=writer.mesh(TRIANGLE, COLOR_0=colours))
    scene = load(writer.save(tmp_path / "a.glb"))
    # Without a material, vertex colours are the author's: no default material.
    assert scene.materials[1].colour == (156, 156, 156)
    assert not scene.warnings


def test_white_vertex_colours_leave_the_material_exact_and_named(tmp_path):
    writer = GltfWriter()
    writer.add("materials", {"name": "wood", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.214, 0, 1]}})
    colours = writer.accessor([[255, 255, 255]] * 3, "u1", normalized=True, stride=4)
    writer.show(mesh=writer.mesh(TRIANGLE, material=0, COLOR_0=colours))
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [(material.name, material.colour) for material in scene.materials[1:]] == [("wood", (188, 127, 0))]
    assert scene.objects[0].mesh.appearance is None
    assert scene.warnings == ()


@pytest.mark.parametrize(
    ("transform", "uv", "colour"),
    [
        ({"offset": [0.5, 0.0]}, (0.25, 0.25), GREEN),
        ({"scale": [1.0, 3.0]}, (0.25, 0.25), BLUE),
        # A quarter turn: what was at u is then at -v, by the extension's own example of a lower left quadrant.
        ({"rotation": np.pi / 2}, (0.75, 0.25), RED),
        ({"offset": [0, 1], "rotation": np.pi / 2, "scale": [0.5, 0.5]}, (0.75, 0.75), BLUE),
        ({"offset": [0, 1], "scale": [1, -1]}, (0.25, 0.75), RED),
    ],
)
def test_texture_transform(transform, uv, colour, tmp_path):
    writer = textured(uv, texture={"extensions": {"KHR_texture_transform": transform}})
    writer.json["extensionsUsed"] = writer.json["extensionsRequired"] = ["KHR_texture_transform"]
    assert seen(writer, tmp_path / "a.glb") == colour[:3]


def test_the_second_set_of_coordinates_and_its_override(tmp_path):
    assert seen(textured((0.75, 0.25), texture={"texCoord": 1}, set_number=1), tmp_path / "a.glb") == GREEN[:3]
    override = {"texCoord": 7, "extensions": {"KHR_texture_transform": {"texCoord": 1}}}
    assert seen(textured((0.75, 0.25), texture=override, set_number=1), tmp_path / "b.glb") == GREEN[:3]


def test_missing_coordinates_and_images_leave_the_factor_and_are_counted(tmp_path):
    writer = textured(texture={"texCoord": 3})
    scene = load(writer.save(tmp_path / "a.glb"))
    assert (scene.materials[1].name, kinds(scene)) == ("cloth", {"texture": 1})
    writer = textured()
    writer.json["images"][0] = {"uri": "gone.png"}
    scene = load(writer.save(tmp_path / "a.glb"))
    assert (scene.materials[1].name, kinds(scene)) == ("cloth", {"texture": 1})
    assert "no image 'gone.png' in the asset's folder" in scene.warnings[0].message
    writer = textured()
    writer.json["textures"][0] = {"extensions": {"KHR_texture_basisu": {"source": 0}}}
    scene = load(writer.save(tmp_path / "a.glb"))
    assert "textures[0] has only a KTX2 image" in scene.warnings[0].message


@pytest.mark.parametrize(
    ("image", "what"),
    [
        (b"not an image", "is broken or of an unknown kind"),
        (encoded(QUARTERS)[:40], "is broken or of an unknown kind"),
        (b"DDS |...", "is a DDS file"),
        (b"version https://git-lfs.github.com/spec/v1\n", "is a Git LFS pointer"),
    ],
)
def test_an_image_that_cannot_be_read_leaves_the_factor(image, what, tmp_path):
    scene = load(textured(image=image).save(tmp_path / "a.glb"))
    assert scene.warnings[0].message.startswith(f"images[0]: the image {what} and was not read")
    assert scene.objects[0].mesh.appearance is None


def test_an_oversized_image_is_refused(tmp_path):
    image = encoded(np.zeros((9000, 9000), np.uint8))
    with pytest.raises(AssetError, match=r"images\[0\]: the image has more than 67,108,864 pixels"):
        load(textured(image=image).save(tmp_path / "a.glb"))


def test_webp_by_extension(tmp_path):
    writer = textured()
    webp = writer.view(encoded(np.array([[BLUE]], np.uint8), "WEBP", lossless=True))
    writer.add("images", {"bufferView": webp, "mimeType": "image/webp"})
    writer.json["textures"][0]["extensions"] = {"EXT_texture_webp": {"source": 1}}
    assert seen(writer, tmp_path / "a.glb") == BLUE[:3]


@pytest.mark.parametrize(
    ("mode", "alpha", "factor", "there"),
    [
        ("OPAQUE", 0, 1.0, True),
        ("OPAQUE", 255, -1.0, True),
        ("MASK", 127, 1.0, False),
        ("MASK", 128, 1.0, True),
        ("MASK", 255, 0.4, False),
        ("BLEND", 100, 1.0, False),
        ("BLEND", 200, 1.0, True),
    ],
)
def test_alpha_cuts_away(mode, alpha, factor, there, tmp_path):
    base = {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 1, factor]}
    image = encoded(np.array([[[10, 20, 30, alpha]]], np.uint8))
    writer = textured(image=image, material={"pbrMetallicRoughness": base, "alphaMode": mode})
    writer.show(name="other", mesh=writer.mesh(TRIANGLE))
    scene = load(writer.save(tmp_path / "a.glb"))
    assert len(scene.objects) == 1 + there
    assert kinds(scene).get("transparent", 0) == (not there)


@pytest.mark.parametrize(("mode", "left_out"), [("BLEND", [True, True, False, False]), ("MASK", [True] * 4)])
def test_opaque_from_decides_for_what_blends(mode, left_out, tmp_path):
    """The author's cutoff decides for a mask."""
    writer = GltfWriter()
    glass = {"alphaMode": mode, "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.3]}}
    writer.add("materials", glass)
    writer.show(mesh=writer.mesh(TRIANGLE, material=0))
    writer.show(name="other", mesh=writer.mesh(TRIANGLE))
    path = writer.save(tmp_path / "a.glb")
    scenes = [load(path, opaque_from=opaque_from) for opaque_from in (None, 0.31, 0.3, 0)]
    assert [kinds(scene).get("transparent", 0) == 1 for scene in scenes] == left_out


def test_what_emits_alone_shows_its_emission(tmp_path):
    black = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [0, 0, 1]}
    assert seen(textured(material=black), tmp_path / "a.glb") == BLUE[:3]
    lamp = black | {"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}
    assert seen(textured(material=lamp), tmp_path / "b.glb") == RED[:3]
    grey = black | {"pbrMetallicRoughness": {"baseColorFactor": [0, 1, 0, 1]}}
    assert seen(textured(material=grey), tmp_path / "c.glb") == GREEN[:3]


@pytest.mark.parametrize(
    ("strength", "colour", "clamped"), [(2.0, (255, 188, 0), 0), (8.0, (255, 255, 0), 1), (0.0, (0, 0, 0), 0)]
)
def test_the_strength_of_emission(strength, colour, clamped, tmp_path):
    """Linear 0.25 of it is 188 of 255 at twice the strength; beyond the range each channel is clamped."""
    strong = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
    lamp = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [0.5, 0.25, 0]}
    writer = GltfWriter()
    writer.add("materials", lamp | {"extensions": strong})
    writer.show(mesh=writer.mesh(TRIANGLE, material=0))
    scene = load(writer.save(tmp_path / "a.glb"))
    assert scene.materials[1].colour == colour
    assert kinds(scene).get("colour-range", 0) == clamped


def test_vertex_colours_do_not_change_emission(tmp_path):
    lamp = {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}, "emissiveFactor": [0, 0, 1]}
    writer = GltfWriter()
    writer.add("materials", lamp)
    dark = writer.accessor(np.zeros((3, 3), np.float32))
    writer.show(mesh=writer.mesh(TRIANGLE, material=0, COLOR_0=dark))
    assert seen(writer, tmp_path / "a.glb") == BLUE[:3]


def test_a_uniform_transparent_material_is_air_and_alone_refused(tmp_path):
    writer = GltfWriter()
    glass = {"alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.3]}}
    writer.add("materials", glass)
    writer.show(mesh=writer.mesh(TRIANGLE, material=0))
    with pytest.raises(AssetError, match="has no triangles to voxelize"):
        load(writer.save(tmp_path / "a.glb"))


def test_specular_glossiness_gives_the_diffuse_colour(tmp_path):
    glossy = {"KHR_materials_pbrSpecularGlossiness": {"diffuseFactor": [0, 0, 1, 1]}}
    writer = textured(material={"extensions": glossy, "pbrMetallicRoughness": {}})
    assert seen(writer, tmp_path / "a.glb") == BLUE[:3]
    glossy["KHR_materials_pbrSpecularGlossiness"]["diffuseTexture"] = {"index": 0}
    glossy["KHR_materials_pbrSpecularGlossiness"]["diffuseFactor"] = [1, 1, 1, 1]
    writer = textured((0.75, 0.25), material={"extensions": glossy, "pbrMetallicRoughness": {}})
    assert seen(writer, tmp_path / "a.glb") == GREEN[:3]


def test_variants(tmp_path):
    writer = GltfWriter()
    for name, colour in (("plain", [1, 0, 0, 1]), ("summer", [0, 1, 0, 1]), ("winter", [0, 0, 1, 1])):
        writer.add("materials", {"name": name, "pbrMetallicRoughness": {"baseColorFactor": colour}})
    mesh = writer.mesh(TRIANGLE, material=0)
    mappings = [{"material": 1, "variants": [0, 2]}, {"material": 2, "variants": [1]}]
    writer.json["meshes"][mesh]["primitives"][0]["extensions"] = {"KHR_materials_variants": {"mappings": mappings}}
    names = [{"name": "Beach"}, {"name": "Snow"}, {"name": "Park"}, {"name": "Moon"}]
    writer.json["extensions"] = {"KHR_materials_variants": {"variants": names}}
    writer.show(mesh=mesh)
    path = writer.save(tmp_path / "a.glb")
    for variants, name in (((), "plain"), (("Beach",), "summer"), (("Snow",), "winter"), (("Moon",), "plain")):
        assert [material.name for material in load(path, variants=variants).materials[1:]] == [name]
    with pytest.raises(AssetError, match=r"no variant 'Sea' in the file; it has 'Beach', 'Snow', 'Park', 'Moon'"):
        load(path, variants=("Sea",))
    with pytest.raises(AssetError, match=r"2 variants were requested, and one can be shown; request one"):
        load(path, variants=("Snow", "Park"))


def painted_triangles(names, uniform=()):
    """A file with a uniform material for each of `uniform` and a triangle in vertex colours for each of `names`."""
    random = np.random.default_rng(1)
    writer = GltfWriter()
    for name in names:
        index = writer.add("materials", {"name": name})
        writer.show(mesh=writer.mesh(TRIANGLE, material=index, COLOR_0=writer.accessor(random.random((3, 3)))))
    for name in uniform:
        index = writer.add("materials", {"name": name})
        writer.show(mesh=writer.mesh(TRIANGLE, material=index))
    return writer


def test_paints_have_their_materials_behind_the_uniform_ones(tmp_path):
    uniform = [f"m{at}" for at in range(240)]
    scene = load(painted_triangles(["silk", "wool"], uniform).save(tmp_path / "a.glb"))
    assert [material.name for material in scene.materials[1:]] == [*uniform, "silk", "wool"]
    assert not scene.warnings


def test_paints_share_materials_where_there_are_too_many(tmp_path):
    writer = painted_triangles([f"p{at}" for at in range(300)], [f"m{at}" for at in range(205)])
    scene = load(writer.save(tmp_path / "a.glb"))
    assert len(scene.materials) - 1 <= 205 + 25
    assert all(0 < int(thing.mesh.materials[0]) < len(scene.materials) for thing in scene.objects)
    full = painted_triangles(["silk"], [f"m{at}" for at in range(255)]).save(tmp_path / "b.glb")
    with pytest.raises(DoesNotFitError, match="leave none for textures and vertex colours"):
        load(full)


def test_paint_of_one_colour_is_a_material(tmp_path):
    writer = GltfWriter()
    writer.add("materials", {"name": "dye", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1]}})
    colours = writer.accessor(np.full((3, 3), 0.5))
    writer.show(mesh=writer.mesh(TRIANGLE, material=0, COLOR_0=colours))
    scene = load(writer.save(tmp_path / "a.glb"))
    assert scene.objects[0].mesh.appearance is None
    (dye,) = scene.materials[1:]
    assert (dye.name, dye.colour) == ("dye", tuple(srgb_from_linear([0.5, 0.25, 0.125]).tolist()))


def test_mirrored_paint_is_a_mirror(tmp_path):
    writer = textured(material={"extras": {"voxrt_reflect": True}})
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [(material.colour, material.mirror) for material in scene.materials[1:]] == [((255, 0, 0), True)]


def test_textures_beside_the_asset_are_found(tmp_path):
    writer = textured()
    writer.json["images"][0] = {"uri": "wood%20grain.png"}
    (tmp_path / "wood grain.png").write_bytes(encoded(np.array([[BLUE]], np.uint8)))
    assert seen(writer, tmp_path / "a.gltf") == BLUE[:3]
    assert json.loads((tmp_path / "a.gltf").read_text())["images"] == [{"uri": "wood%20grain.png"}]


def test_attributes_that_do_not_fit_their_vertices_are_refused(tmp_path):
    writer = GltfWriter()
    writer.show(mesh=writer.mesh(TRIANGLE, COLOR_0=writer.accessor([[0.5, 0, 0]] * 2)))
    with pytest.raises(AssetError, match=r"attributes\.COLOR_0: 2 elements, fewer than there are vertices"):
        load(writer.save(tmp_path / "a.glb"))
    transform = {"KHR_texture_transform": {"scale": [1e308, 1e308], "rotation": 1.0}}
    with pytest.raises(AssetError, match=r"baseColorTexture: the texture coordinates overflow"):
        load(textured((1e3, 1e3), texture={"extensions": transform}).save(tmp_path / "a.glb"))


def test_vertex_colours_that_are_not_numbers_are_black_and_counted(tmp_path):
    writer = GltfWriter()
    writer.show(mesh=writer.mesh(TRIANGLE, COLOR_0=writer.accessor([[np.nan, np.inf, 1.0]] * 3)))
    scene = load(writer.save(tmp_path / "a.glb"))
    assert scene.materials[1].colour == (0, 0, 255)
    assert kinds(scene)["vertex-colour"] == 1


def test_an_image_without_a_source_is_refused(tmp_path):
    writer = textured()
    writer.json["images"][0] = {"name": "nothing"}
    with pytest.raises(AssetError, match=r"images\[0\]: has neither a uri nor a buffer view"):
        load(writer.save(tmp_path / "a.glb"))
