"""Files of points: XYZ, LAS, PLY without faces, Gaussian splats."""

import numpy as np
import pytest

import voxrt
from voxrt.voxelize import AssetError, load

PLACES = np.array([[0, 0, 0], [1.5, -2, 3e2], [4, 5, 6]])
FAR = np.array([500_000, 5_400_000, 0])
COLOURS = np.array([[255, 0, 10], [0, 128, 20], [7, 8, 9]], np.uint8)


def read(tmp_path, text, name="scan.xyz", **options):
    path = tmp_path / name
    path.write_bytes(text.encode() if isinstance(text, str) else text)
    (one,) = (scene := load(path, **options)).objects
    return one.points, one.transform, scene.warnings


def rows(separator=" ", colour="{} {} {}"):
    return [
        separator.join([f"{x:g}", f"{y:g}", f"{z:g}", *colour.format(*rgb).split()]).strip(separator)
        for (x, y, z), rgb in zip(PLACES.tolist(), COLOURS.tolist(), strict=True)
    ]


@pytest.mark.parametrize("separator", [" ", "\t", ",", ", ", ";", "  ", " ; "])
@pytest.mark.parametrize("head", ["", "# a comment\n", "// a comment\n", "x y z r g b\n", "X,Y,Z,R,G,B\n", "3\n"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\n\n", " \n"])
def test_rows_of_numbers(tmp_path, separator, head, end):
    points, transform, warnings = read(tmp_path, head + end.join(rows(separator)) + end)
    np.testing.assert_array_equal(points.positions, PLACES)
    np.testing.assert_array_equal(points.colours, COLOURS)
    np.testing.assert_array_equal(transform @ [0, 0, 1, 1], [0, 1, 0, 1])  # z is up
    assert not warnings


def test_rows_without_colours_with_reals_and_with_more(tmp_path):
    assert read(tmp_path, "\n".join(rows(colour="")))[0].colours is None
    unit = read(tmp_path, "0 0 0 1 0.5 0\n1 1 1 0.2 1 0\n")[0]
    np.testing.assert_array_equal(unit.colours, [[255, 128, 0], [51, 255, 0]])
    points, _, (warning,) = read(tmp_path, "0 0 0 17 255 128 0\n")
    np.testing.assert_array_equal(points.colours, [[255, 128, 0]])
    assert (warning.kind, warning.count) == ("point-attributes", 1)
    points, _, (warning,) = read(tmp_path, "0 0 0 17\n")
    assert (points.colours, warning.kind) == (None, "point-attributes")


def test_normals_are_no_colours(tmp_path):
    normals = ["0 0 -1", "0.6 0.8 0", "0 1 0"]
    for colours in ([], COLOURS.tolist()):
        cells = [" ".join(map(str, rgb)) for rgb in colours] or [""] * 3
        text = [f"{place} {normal} {rgb}" for place, normal, rgb in zip(rows(colour=""), normals, cells, strict=True)]
        points, _, (warning,) = read(tmp_path, "\n".join(text))
        assert (warning.kind, warning.count) == ("point-attributes", 3)
        np.testing.assert_array_equal(points.positions, PLACES)
        if colours:
            np.testing.assert_array_equal(points.colours, COLOURS)
        else:
            assert points.colours is None
    assert read(tmp_path, "0 0 0 0 0 1\n1 1 1 0 1 0\n")[0].colours is None  # none is below 0; all have unit length
    assert read(tmp_path, "0 0 0 70000 0 0\n")[0].colours is None


def test_colours_of_16_bits(tmp_path):
    points = read(tmp_path, "0 0 0 65280 256 0\n1 1 1 65535 511 255\n")[0]
    np.testing.assert_array_equal(points.colours, [[255, 1, 0], [255, 1, 0]])


def test_many_rows_are_those_of_numpy(tmp_path):
    rng = np.random.default_rng(0)
    table = np.column_stack([rng.normal(size=(500_000, 3)) * 1e3, rng.integers(0, 256, (500_000, 3))])
    path = tmp_path / "many.xyz"
    np.savetxt(path, table, fmt=["%.17g"] * 3 + ["%d"] * 3)
    points = load(path).objects[0].points
    np.testing.assert_array_equal(points.positions, table[:, :3])
    np.testing.assert_array_equal(points.colours, table[:, 3:])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "has no points"),
        ("# nothing\n", "has no points"),
        ("1 2\n3 4\n", "has rows of 2 numbers"),
        ("0 0 0\n1 2 3 4\n5 6\n", "'1 2 3 4': has 4 numbers, and the first row 3"),
        ("0 0 0\n1 2 q\n", "'1 2 q': 'q' is not a number"),
        ("0 0 0\n1_0 2 3\n", "'1_0' is not a number"),
        ("1,5 2,5 3,5\n", "write 1.5"),
        ("1,5;2,5;3,5\n", "write 1.5"),
        ("nan nan nan\n", "has no points"),
        ("1e61 0 0\n", "has no points"),
    ],
)
def test_rows_that_are_refused(tmp_path, text, message):
    with pytest.raises(AssetError) as caught:
        read(tmp_path, text)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_broken_places_are_left_out(tmp_path):
    points, _, (warning,) = read(tmp_path, "0 0 0\nnan 0 0\n0 inf 0\n1 1 1\n")
    np.testing.assert_array_equal(points.positions, [[0, 0, 0], [1, 1, 1]])
    assert (warning.kind, warning.count) == ("broken-point", 2)


def las(path, factor=257, **fields):
    laspy = pytest.importorskip("laspy", reason="pip install laspy")
    made = laspy.create(point_format=2, file_version="1.2")
    made.header.scales, made.header.offsets = [0.001] * 3, [500_000, 5_400_000, 0]
    made.x, made.y, made.z = (PLACES + FAR).T
    for name, channel in zip(("red", "green", "blue"), COLOURS.T, strict=True):
        made[name] = channel.astype(np.uint16) * factor
    for name, value in fields.items():
        made[name] = value
    made.write(path)
    return path


@pytest.mark.parametrize("suffix", [".las", ".laz"])
@pytest.mark.parametrize("factor", [1, 256, 257])  # bytes; as the format says; all 16 bits
def test_las(tmp_path, suffix, factor):
    if suffix == ".laz":
        pytest.importorskip("lazrs", reason="pip install lazrs")
    one = load(las(tmp_path / f"scan{suffix}", factor), unit=0.5).objects[0]
    np.testing.assert_allclose(one.points.positions, PLACES + FAR, atol=1e-6)
    np.testing.assert_array_equal(one.points.colours, COLOURS)
    np.testing.assert_array_equal(one.transform @ [0, 0, 1, 1], [0, 0.5, 0, 1])


def test_withheld_points_are_left_out_and_black_is_no_colour(tmp_path):
    path = las(tmp_path / "scan.las", withheld=[0, 1, 0], red=[0] * 3, green=[0] * 3, blue=[0] * 3)
    points = load(path).objects[0].points
    assert (len(points.positions), points.colours) == (2, None)


@pytest.mark.parametrize("cut", [0, 3, 100, 230, 300])
def test_damaged_las_files_are_refused_in_one_line(tmp_path, cut):
    path = las(tmp_path / "scan.las")
    path.write_bytes(path.read_bytes()[:cut])
    with pytest.raises(AssetError) as caught:
        load(path)
    assert "\n" not in str(caught.value)


def ply(properties, table, faces=""):
    lines = [f"property {one}" for one in properties]
    body = "\n".join(" ".join(map(str, row)) for row in table)
    return "\n".join(["ply", "format ascii 1.0", f"element vertex {len(table)}", *lines, faces + "end_header", body])


XYZ = ["float x", "float y", "float z"]


@pytest.mark.parametrize("faces", ["", "element face 0\nproperty list uchar int vertex_indices\n"])
def test_ply_without_faces(tmp_path, faces):
    table = [[0, 0, 0, 255, 0, 10, 255], [1, 2, 3, 7, 8, 9, 20]]
    names = [*XYZ, "uchar red", "uchar green", "uchar blue", "uchar alpha"]
    points, transform, (warning,) = read(tmp_path, ply(names, table, faces), "scan.ply", points=4)
    np.testing.assert_array_equal(points.positions, [[0, 0, 0]])
    np.testing.assert_array_equal(points.colours, [[255, 0, 10]])
    assert (points.least, warning.kind) == (4, "transparent")
    np.testing.assert_array_equal(transform, np.eye(4))
    with pytest.raises(AssetError, match="lower --opaque-from"):
        read(tmp_path, ply(names, table[1:], faces), "scan.ply")


def test_gaussian_splats_are_the_centres_of_their_gaussians(tmp_path):
    names = [*XYZ, *(f"float {one}" for one in ("f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "rot_0"))]
    constant = 0.5 / 0.28209479177387814
    table = [
        [0, 0, 0, constant, -constant, 0, 0.01, 1, 1],
        [1, 1, 1, 0, 0, 0, -0.01, 1, 1],
        [2, 2, 2, 9, 9, 9, 50, 1, 1],
    ]
    points, transform, warnings = read(tmp_path, ply(names, table), "splat.ply")
    np.testing.assert_array_equal(points.positions, [[0, 0, 0], [2, 2, 2]])
    np.testing.assert_array_equal(points.colours, [[255, 0, 128], [255, 255, 255]])
    assert [one.kind for one in warnings] == ["gaussian-splat", "up-axis", "transparent"]
    np.testing.assert_array_equal(transform @ [1, -1, 1, 1], [-1, 1, 1, 1])  # y points down
    _, transform, warnings = read(tmp_path, ply(names, table), "splat.ply", up="y")
    np.testing.assert_array_equal(transform, np.eye(4))
    assert [one.kind for one in warnings] == ["gaussian-splat", "transparent"]


def test_points_is_for_formats_with_points():
    with pytest.raises(ValueError, match="points must be an integer 1"):
        load("examples/house.obj", points=0)
    assert [one.message for one in load("examples/house.obj", points=2).warnings] == [
        "--points was ignored: obj files have no points"
    ]


def test_scene_files_have_points_beside_solids(tmp_path):
    (tmp_path / "scan.xyz").write_text("0 0 0\n0 0 0\n1 1 1\n")
    scene = tmp_path / "scene.toml"
    scene.write_text('[[objects]]\nname = "scan"\nasset = { file = "scan.xyz" }\ntranslate = [2, 0, 0]\n')
    built = voxrt.build(scene, voxel_size=0.5, points=2)
    assert len(built.coordinates) == 1
    scene.write_text('[[objects]]\nname = "scan"\nasset = { file = "scan.xyz" }\ncollider = "box"\n')
    with pytest.raises(AssetError, match="points have no collider"):
        voxrt.build(scene, depth=3)
