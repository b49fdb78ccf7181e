import itertools

import numpy as np
import pytest
from assets import asset
from hypothesis import given, settings
from oracles.octree import reference_words
from oracles.random_worlds import dense_cubes

from voxrt import export, octree
from voxrt.octree import BOARDS, Rom, RomError
from voxrt.octree.camera import Camera, Lighting
from voxrt.voxelize import EMPTY, Grid, Material

MATERIALS = (
    EMPTY,
    Material("red", (255, 0, 0)),
    Material("mirror \N{SNOWMAN}", (1, 2, 3), mirror=True, authored=False),
)


def rom(name="scene"):
    cube = np.zeros((4, 4, 4), int)
    cube[0, 0, 0], cube[3, 2, 1] = 1, 2
    return Rom(name, octree.from_dense(cube), MATERIALS, Grid(2, (1.5, -2.0, 0.1), 0.25))


def blob():
    view = Camera((-1, 2, 3), (0, 0, 90), (1, 0, 0), (0, -32768, 0))
    return export.Blob(rom(), view, Lighting((5, -6, 7), ambient=9, on=True, flat=False, bounces=3))


@pytest.mark.parametrize("path", list(itertools.product(export.WRITABLE_SUFFIXES, repeat=2)), ids="".join)
def test_every_format_to_every_other(tmp_path, path):
    first, second = path
    files = export.convert(export.Blob(rom()), tmp_path / f"one{first}", dialect="msb")
    read, warnings = export.read_any(files[0])
    assert warnings == ()
    files = export.convert(read, str(tmp_path / "sub" / f"two{second}") if second != ".blob" else tmp_path / "two.blob")
    read, warnings = export.read_any(str(files[0]))
    assert warnings == ()
    assert (read.rom.materials, read.rom.grid) == (MATERIALS, rom().grid)
    np.testing.assert_array_equal(read.rom.octree.words, rom().octree.words)


def test_words_alone_go_through_every_format(tmp_path):
    export.write_mem(tmp_path / "a.mem", rom().octree.words)
    for suffix in (".coe", ".mif", ".bin"):
        read, warnings = export.read_any(tmp_path / "a.mem", depth=2)
        assert [w.kind for w in warnings] == ["assumed-dialect", "assumed-palette"]
        files = export.convert(read, tmp_path / f"b{suffix}")
        files[1].unlink()
        again, warnings = export.read_any(files[0])
        assert [w.kind for w in warnings] == ["assumed-dialect", "assumed-depth", "assumed-palette"]
        np.testing.assert_array_equal(again.rom.octree.words, rom().octree.words)


def test_files_of_words_keep_camera_and_light_in_their_manifest(tmp_path):
    for target in ("a.mem", "b.coe", "c.blob"):
        export.convert(blob(), tmp_path / target)
        read, warnings = export.read_any(tmp_path / target)
        assert warnings == ()
        assert (read.view, read.lighting) == (blob().view, blob().lighting)


def test_files_of_no_kind(tmp_path):
    with pytest.raises(RomError, match=r"a\.png: is no file that holds an octree memory; name one of \.mem, \.coe"):
        export.read_any(tmp_path / "a.png")
    with pytest.raises(
        RomError, match=r"a\.vox: is not a format to write; name one of \.mem, \.coe, \.mif, \.bin, \.blob"
    ):
        export.convert(blob(), tmp_path / "a.vox")
    with pytest.raises(RomError, match=r"a\.blob: is no file of octree words"):
        export.read_rom(tmp_path / "a.blob")


def test_vox_and_seed_to_blob(tmp_path):
    read, _ = export.read_any(asset("vox/mikelovesrobots-mmmm/vox/chr_army1.vox"))
    export.convert(read, tmp_path / "army.blob")
    again = export.read_blob(tmp_path / "army.blob")
    assert again.rom.materials == read.rom.materials
    np.testing.assert_array_equal(again.rom.octree.words, read.rom.octree.words)
    read, _ = export.read_any(asset("../seed-memories/cubes.mem"), depth=10)
    export.convert(read, tmp_path / "cubes.coe", dialect="seed-rtl")
    again, _ = export.read_any(tmp_path / "cubes.coe")
    np.testing.assert_array_equal(again.rom.octree.words, read.rom.octree.words)


def listed(cube):
    """Print a cube as the original's script did: breadth-first, children in the order x = 4, y = 2, z = 1."""
    names = {
        0: "None, MID1 = False",
        1: "Red (Instance), MID1 = False",
        2: "Blue, MID1 = False",
        3: "None, MID1 = True",
    }
    waiting, lines = [np.asarray(cube)], []
    for part in waiting:  # grows while it is walked
        node = len(lines)
        if (part == part.flat[0]).all():
            lines.append(f"Node {node}: Material ID = {names[int(part.flat[0])]}")
            continue
        lines.append(f"Node {node}: Material ID = None, MID1 = True, First Child Index = {len(waiting)}")
        h = len(part) // 2
        waiting += [part[x : x + h, y : y + h, z : z + h] for x in (0, h) for y in (0, h) for z in (0, h)]
    return "\n".join(lines) + "\n"


COLOURS = {"Red": (255, 0, 0), "Blue": (0, 0, 255)}


@given(cube=dense_cubes(3))
@settings(max_examples=40)
def test_listings_become_shared_words(tmp_path_factory, cube):
    cube %= 4
    path = tmp_path_factory.mktemp("listing") / "a.txt"
    path.write_text(listed(cube))
    read, _ = export.read_any(path, depth=len(cube).bit_length() - 1, colours=COLOURS)
    np.testing.assert_array_equal(read.rom.octree.words, reference_words(cube))
    expected = ["empty", "Red", "Blue"] + ["default"] * (3 in cube)
    assert [m.name for m in read.rom.materials] == expected


SMALL = listed(np.arange(8).reshape(2, 2, 2) % 2)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "cut short or damaged"),
        ("Node 1: Material ID = None, MID1 = False", "line 1: is not 'Node 0: Material ID"),
        ("Node 0: Material ID = None", "line 1: is not 'Node 0"),
        (SMALL.replace("Red", "Green"), r"line 3: material 'Green \(Instance\)' has no colour; .*: Red, Blue\)"),
        (SMALL.rsplit("Node 8", 1)[0], "line 1: eight children are not there"),
        (SMALL.replace("Index = 1", "Index = 0"), "line 1: eight children are not there"),
        (SMALL.replace("Index = 1", "Index = 2"), "line 1: eight children are not there"),
        (SMALL.replace("Index = 1", "Index = 9"), "line 1: eight children are not there"),
        (SMALL + "Node 9: Material ID = None, MID1 = False", "the last nodes are missing"),
        (
            SMALL.replace("Node 5: Material ID = None, MID1 = False", "Node 5: Material ID = a, MID1 = True, First Child Index = 1"),  # noqa: E501
            "line 6, word 0x2: pointer 00000001 leads back",
        ),
    ],
)  # fmt: skip
def test_broken_listings_are_refused(tmp_path, text, message):
    path = tmp_path / "a.txt"
    path.write_text(text)
    with pytest.raises(RomError, match=message):
        export.read_listing(path, COLOURS)


def test_listings_need_no_colour_that_they_do_not_use(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("\nNode 0: Material ID = Red (Instance), MID1 = False\n\n")
    assert export.read_listing(path, COLOURS).octree.words.tolist() == [0xFFFFFF01]
    many = {f"m{i}": (0, 0, 0) for i in range(256)} | COLOURS
    with pytest.raises(RomError, match="line 2: more than 255 materials"):
        export.read_listing(path, many)


def test_info():
    cube = np.zeros((8, 8, 8), int)
    cube[0, 0, 0], cube[4, 4, 4], cube[0:4, 4:8, 0:4] = 1, 1, 2
    info = export.rom_info(Rom("a", octree.from_dense(cube), MATERIALS))
    assert (info.name, info.depth, info.words, info.blocks, info.shared_words) == ("a", 3, 25, 3, 25)
    assert info.unshared_blocks == 5
    assert info.voxels == 66
    assert info.bounds == ((0, 0, 0), (5, 8, 5))
    assert [(level.level, level.solid, level.empty) for level in info.levels] == [
        (3, 0, 0),
        (2, 1, 5),
        (1, 0, 14),
        (0, 2, 14),
    ]
    assert [(m.id, m.name, m.voxels) for m in info.materials] == [
        (0, "empty", 446),
        (1, "red", 2),
        (2, MATERIALS[2].name, 64),
    ]
    assert {board.name: board.fits for board in info.boards} == dict.fromkeys(BOARDS, True)
