"""STL, binary and ASCII, against trimesh and by hand."""

import numpy as np
import pytest
import trimesh
from assets import asset, over_assets
from oracles.sound_scenes import kinds
from oracles.surfaces import area, bounds, scene_triangles, volume

from voxrt.voxelize import AssetError
from voxrt.voxelize.assets import load
from voxrt.voxelize.formats.stl.load import load_stl

FACET = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"


def binary(triangles, header=b"", attribute=0, tail=b""):
    data = header.ljust(80, b" ") + len(triangles).to_bytes(4, "little")
    for triangle in triangles:
        data += np.zeros(3, "<f4").tobytes() + np.array(triangle, "<f4").tobytes() + attribute.to_bytes(2, "little")
    return data + tail


ONE = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]


@pytest.fixture
def stl(tmp_path):
    def write(data):
        path = tmp_path / "part.stl"
        path.write_bytes(data if isinstance(data, bytes) else data.encode())
        return load_stl(path)

    return write


def test_binary_that_begins_like_ascii(stl):
    scene = stl(binary(ONE, header=b"solid part"))
    assert [len(one.mesh.triangles) for one in scene.objects] == [1]


def test_binary_that_begins_with_a_byte_order_mark(stl):
    scene = stl(binary(ONE, header=b"\xef\xbb\xbfsolid part"))
    assert [len(one.mesh.triangles) for one in scene.objects] == [1]


@pytest.mark.parametrize("before", [b"\xef\xbb\xbf", b"; a comment\n", b"\n \n", b"\xef\xbb\xbf# made by hand\n\n"])
def test_text_before_the_first_solid(stl, before):
    scene = stl(before + f"solid part\n{FACET}endsolid\n".encode())
    assert [(one.name, len(one.mesh.triangles)) for one in scene.objects] == [("part", 1)]


@pytest.mark.parametrize("encoding", ["utf-16", "utf-32"])
def test_text_with_a_mark_of_wide_characters(stl, encoding):
    scene = stl(f"solid part\n{FACET}endsolid\n".encode(encoding))
    assert [(one.name, len(one.mesh.triangles)) for one in scene.objects] == [("part", 1)]


def test_ascii_solids_become_objects(stl):
    scene = stl(f"solid a b\n{FACET}endsolid\nSOLID\n{FACET.upper()}{FACET}ENDSOLID\nsolid a b\n{FACET}endsolid a b\n")
    assert [(one.name, len(one.mesh.triangles)) for one in scene.objects] == [("a b", 1), ("part", 2), ("a b (2)", 1)]


def test_corners_at_one_place_become_one_vertex(stl):
    fan = [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[-0.0, 0, 0], [0, 1, 0], [-1, 0, 0]]]
    (one,) = stl(binary(fan)).objects
    assert one.mesh.positions.shape == (4, 3)
    assert one.mesh.positions[one.mesh.triangles].tolist() == fan


def test_attributes_and_trailing_bytes_are_counted(stl):
    scene = stl(binary(ONE, attribute=7, tail=b"more"))
    assert kinds(scene) == {"trailing-bytes": 4, "stl-attribute": 1}


@pytest.mark.parametrize(
    ("header", "attribute", "colour"),
    [
        (b"", 0x8000 | 31 << 10, (255, 0, 0)),  # VisCAM: red in the highest bits
        (b"", 0x8000 | 16, (0, 0, 131)),
        (b"COLOR=\x01\x02\x03\xff", 31, (255, 0, 0)),  # Materialise: red in the lowest
        (b"xCOLOR=\x01\x02\x03\xff,MATERIAL=", 0x801F, (1, 2, 3)),
    ],
)
def test_colours_of_both_kinds(stl, header, attribute, colour):
    scene = stl(binary(ONE, header=header, attribute=attribute))
    (mesh,) = [one.mesh for one in scene.objects]
    assert scene.materials[mesh.materials[0]].colour == colour
    assert "default-material" not in [one.kind for one in scene.warnings]


def test_some_facets_with_colours(stl):
    plain, red = (binary(ONE, attribute=attribute)[84:] for attribute in (0, 0x8000 | 31 << 10))
    scene = stl(bytes(80) + (2).to_bytes(4, "little") + plain + red)
    (mesh,) = [one.mesh for one in scene.objects]
    assert [scene.materials[number].colour for number in mesh.materials] == [(200, 200, 200), (255, 0, 0)]


@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", "\n\n \t"])
def test_by_lines_and_by_words_the_same(stl, end):
    text = f"solid a#b\n{FACET}{FACET.replace('1', '-2.5e-1')}endsolid a#b\n solid\n{FACET}endsolid"
    laid_out = stl(text.replace("\n", end))
    run_together = stl(text.replace("vertex 0 0 0\nvertex", "vertex 0 0 0 vertex"))
    assert [one.name for one in laid_out.objects] == [one.name for one in run_together.objects] == ["a#b", "part"]
    for one, other in zip(laid_out.objects, run_together.objects, strict=True):
        assert np.array_equal(one.mesh.positions[one.mesh.triangles], other.mesh.positions[other.mesh.triangles])


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is empty"),
        (b"solidarity", "has no triangles"),
        (b"abc", "too short"),
        (binary([]), "has no triangles"),
        (binary(ONE)[:-1], "is cut short: 0 of 1 triangles"),
        (b"\0" * 80 + b"\xff\xff\xff\xff", "is cut short: 0 of 4294967295 triangles"),
        (binary([[[0, 0, 0], [1, 0, 0], [0, float("nan"), 0]]]), "not a number"),
        (b"solid empty\nendsolid empty", "has no triangles"),
        (f"solid a\n{FACET}".replace("vertex 0 1 0\n", ""), "facet that is not a triangle"),
        (f"solid a\n{FACET}".replace("vertex 0 1 0", "vertex 0 one 0"), "not a number"),
        (f"solid a\n{FACET}".replace("vertex 0 1 0", f"vertex 0 {'1' * 10000} 0"), "facet that is not a triangle"),
    ],
)
def test_refused(stl, data, message):
    with pytest.raises(AssetError) as caught:
        stl(data)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@over_assets(
    "name",
    [
        "stl/trimesh/idler_riser.STL",
        "stl/trimesh/featuretype.STL",
        "stl/trimesh/angle_block.STL",
        "stl/trimesh/soup.stl",
        "stl/trimesh/multibody.stl",
        "stl/trimesh/two_objects_mixed_case_names.stl",
        "stl/USD-Fileformat-plugins/car.stl",
        "stl/USD-Fileformat-plugins/ascii.stl",
        "stl/USD-Fileformat-plugins/suzanne.stl",
        "trouble/assimp/STL/sphereWithHole.stl",
        "trouble/assimp/STL/3DSMaxExport.STL",
    ],
)
def test_same_surface_as_trimesh(name):
    path = asset(name)
    ours = scene_triangles(load(path, up="y"))
    with path.open("rb") as file:  # trimesh keeps solids of one ASCII file apart, too
        theirs = trimesh.load(file, file_type="stl", process=False)
    theirs = (theirs.to_mesh() if isinstance(theirs, trimesh.Scene) else theirs).triangles
    assert len(ours) == len(theirs)
    assert np.allclose(bounds(ours), bounds(theirs), rtol=1e-6)
    assert area(ours) == pytest.approx(area(theirs), rel=1e-5)
    assert volume(ours) == pytest.approx(volume(theirs), rel=1e-4, abs=1e-9)


def test_z_is_up_unless_the_user_says_otherwise(stl):
    low, high = bounds(scene_triangles(stl(binary([[[0, 0, 0], [1, 0, 0], [0, 2, 3]]]))))
    assert (low.tolist(), high.tolist()) == ([0, 0, -2], [1, 3, 0])


def test_the_two_solids_keep_their_names():
    scene = load(asset("stl/trimesh/two_objects_mixed_case_names.stl"))
    assert [one.name for one in scene.objects] == ["CubeExportedFromCAD", "TranslatedCubeExportedFromCAD"]
