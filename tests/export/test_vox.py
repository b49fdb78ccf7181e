import itertools
import random
import struct

import numpy as np
import pytest
from assets import asset, over_assets
from hypothesis import given
from hypothesis import strategies as st

from voxrt import export, octree
from voxrt.voxelize import AssetError, DoesNotFitError, SceneWarning


def chunk(name, content=b"", children=b""):
    return name + struct.pack("<ii", len(content), len(children)) + content + children


def text(string):
    return struct.pack("<i", len(string)) + string.encode()


def dictionary(**entries):
    return struct.pack("<i", len(entries)) + b"".join(text(key) + text(value) for key, value in entries.items())


def model(size, voxels):
    return chunk(b"SIZE", struct.pack("<iii", *size)) + chunk(
        b"XYZI", struct.pack("<i", len(voxels)) + b"".join(bytes(voxel) for voxel in voxels)
    )


def transform(node, child, offset="0 0 0", rotation="4", *, layer=0, frames=1, **attributes):
    return chunk(
        b"nTRN",
        struct.pack("<i", node) + dictionary(**attributes) + struct.pack("<iiii", child, -1, layer, frames)
        + dictionary(_t=offset, _r=rotation) * frames,
    )  # fmt: skip


def group(node, *children):
    return chunk(
        b"nGRP",
        struct.pack("<i", node) + dictionary() + struct.pack(f"<{len(children) + 1}i", len(children), *children),
    )


def shape(node, *models):
    shown = b"".join(struct.pack("<i", m) + dictionary() for m in models)
    return chunk(b"nSHP", struct.pack("<i", node) + dictionary() + struct.pack("<i", len(models)) + shown)


def vox(*chunks, version=150):
    return b"VOX " + struct.pack("<i", version) + chunk(b"MAIN", b"", b"".join(chunks))


def read(folder, data):
    path = folder / "a.vox"
    path.write_bytes(data)
    return export.read_vox(path)


ONE = model((1, 1, 1), [(0, 0, 0, 7)])


def test_axes_turn_and_nothing_is_mirrored(tmp_path):
    """An arrow along each axis of the file: x stays x, its z becomes y (up), its y becomes -z."""
    arrows = [(x, 0, 0, 1) for x in range(4)] + [(0, y, 0, 2) for y in range(1, 3)] + [(0, 0, 1, 3)]
    rom, warnings = read(tmp_path, vox(model((4, 3, 2), arrows)))
    dense = octree.to_dense(rom.octree)
    assert warnings == ()
    assert rom.name == "a"
    assert dense[:, 0, 2].tolist() == [1, 1, 1, 1]
    assert dense[0, 0, :].tolist() == [2, 2, 1, 0]
    assert dense[0, 1, 2] == 3
    assert np.count_nonzero(dense) == 7


def test_palettes(tmp_path):
    palette = bytes(itertools.chain.from_iterable((i, 255 - i, i // 2, 255) for i in range(256)))
    rom, _ = read(
        tmp_path, vox(model((3, 1, 1), [(0, 0, 0, 200), (1, 0, 0, 1), (2, 0, 0, 255)]), chunk(b"RGBA", palette))
    )
    assert [m.colour for m in rom.materials[1:]] == [(0, 255, 0), (199, 56, 99), (254, 1, 127)]
    assert [m.name for m in rom.materials[1:]] == ["colour 1", "colour 200", "colour 255"]
    assert octree.to_dense(rom.octree)[:3, 0, 0].tolist() == [2, 1, 3]
    rom, _ = read(tmp_path, vox(model((3, 1, 1), [(0, 0, 0, 2), (1, 0, 0, 216), (2, 0, 0, 255)])))
    assert [m.colour for m in rom.materials[1:]] == [(255, 255, 204), (0xEE, 0, 0), (0x11, 0x11, 0x11)]


@given(st.data())
def test_instances_stand_where_the_scene_graph_says(tmp_path_factory, data):
    """Oracle: turn the corners of every voxel's cell about the model's pivot, in rationals of one half."""
    folder = tmp_path_factory.mktemp("vox")
    rng = random.Random(data.draw(st.integers(0, 9999)))
    size = [rng.randint(1, 4) for _ in range(3)]
    cells = [c for c in itertools.product(*map(range, size)) if rng.random() < 0.5] or [(0, 0, 0)]
    graph, expected = [transform(0, 1), group(1, 2, 4)], {}
    for node in (2, 4):
        columns, signs = rng.sample(range(3), 3), [rng.choice((1, -1)) for _ in range(3)]
        bits = columns[0] | columns[1] << 2 | sum((sign < 0) << (4 + row) for row, sign in enumerate(signs))
        offset = [rng.randint(-6, 6) for _ in range(3)]
        graph += [transform(node, node + 1, " ".join(map(str, offset)), str(bits)), shape(node + 1, 0)]
        for cell in cells:
            low = [c - s // 2 for c, s in zip(cell, size, strict=True)]
            ends = [[signs[r] * (low[columns[r]] + e) + offset[r] for e in (0, 1)] for r in range(3)]
            x, y, z = (min(pair) for pair in ends)
            expected.setdefault((x, z, -1 - y), sum(cell) % 5 + 1)
    rom, _ = read(folder, vox(model(size, [(*c, sum(c) % 5 + 1) for c in cells]), *graph))
    lowest = [min(p[axis] for p in expected) for axis in range(3)]
    dense = octree.to_dense(rom.octree)
    found = {
        tuple(int(c) + lo for c, lo in zip(p, lowest, strict=True)): rom.materials[dense[tuple(p)]].name
        for p in np.argwhere(dense)
    }
    assert found == {p: f"colour {colour}" for p, colour in expected.items()}


def test_what_is_left_out_is_said(tmp_path):
    graph = [
        transform(0, 1), group(1, 2, 4, 6), transform(2, 3, "9 0 0", _hidden="1"), shape(3, 0),
        transform(4, 5, "0 9 0", layer=3), shape(5, 0), transform(6, 7, frames=2), shape(7, 0, 0),
    ]  # fmt: skip
    layer = chunk(b"LAYR", struct.pack("<i", 3) + dictionary(_hidden="1") + struct.pack("<i", -1))
    glass = chunk(b"MATL", struct.pack("<i", 7) + dictionary(_type="_glass", _weight="0.5"))
    other = chunk(b"MATL", struct.pack("<i", 8) + dictionary(_type="_emit"))
    rom, warnings = read(tmp_path, vox(ONE, *graph, layer, glass, other, chunk(b"NOTE", b"hello"), version=200))
    assert octree.census(rom.octree).solid_voxels == 1
    assert warnings == (
        SceneWarning("vox-hidden", "nodes that the author hid are left out", 2),
        SceneWarning("vox-animation", "only the first frame of what is animated is shown", 2),
        SceneWarning("vox-material", "glass materials became plain colours", 1),
    )


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "4 bytes should follow, and 0 do"),
        (b"DOOM....", "does not start with 'VOX '"),
        (vox(ONE, version=99), r"version 99 is none of \(150, 200\)"),
        (vox(ONE)[:-1], r"chunk MAIN at byte 8: should have 0 \+ 44 bytes, and 43 follow"),
        (vox(chunk(b"XYZI", b"\0" * 4)), "chunk XYZI at byte 32: has no SIZE before it"),
        (vox(chunk(b"SIZE", b"\1\0\0\0")), "chunk SIZE at byte 32: 4 bytes should follow, and 0 do"),
        (vox(model((0, 1, 1), [])), r"a model of \(0, 1, 1\) voxels is outside 1 \.\.\. 256"),
        (vox(model((1, 1, 1), [(0, 0, 1, 1)])), r"voxel \(0, 0, 1\) of colour 1 does not belong in a model of \(1, 1"),
        (vox(model((1, 1, 1), [(0, 0, 0, 0)])), "of colour 0 does not belong"),
        (vox(model((1, 1, 1), [])), "holds no visible voxel"),
        (vox(), "holds no visible voxel"),
        (vox(ONE, transform(0, 1)), "scene node 1: is not there"),
        (vox(ONE, transform(0, 1), group(1, 0)), "scene node 0: holds itself"),
        (vox(ONE, transform(0, 1), shape(1, 1)), r"scene node 1: shows no model of 0 \.\.\. 0"),
        (vox(ONE, transform(0, 1, "1 2"), shape(1, 0)), "'1 2' is not a translation"),
        (vox(ONE, transform(0, 1, "1 2 9999999999"), shape(1, 0)), "is not a translation"),
        (vox(ONE, transform(0, 1, rotation="0"), shape(1, 0)), "'0' is not a rotation"),
        (vox(ONE, transform(0, 1, rotation="-4"), shape(1, 0)), "'-4' is not a rotation"),
        (vox(ONE, chunk(b"nGRP", struct.pack("<iii", 0, 0, 2**31 - 1))), "2147483647 entries should follow"),
    ],
)  # fmt: skip
def test_malformed_files_are_refused(tmp_path, data, message):
    with pytest.raises(AssetError, match=message):
        read(tmp_path, data)


def test_scenes_too_large_are_refused(tmp_path):
    graph = [transform(0, 1), group(1, 2, 4), transform(2, 3), shape(3, 0), transform(4, 5, "70000 0 0"), shape(5, 0)]
    with pytest.raises(DoesNotFitError, match="70001 voxels from end to end do not fit depth 16"):
        read(tmp_path, vox(ONE, *graph))
    doubling = [piece for n in range(0, 60, 2) for piece in (transform(n, n + 1), group(n + 1, n + 2, n + 2))]
    with pytest.raises(DoesNotFitError, match="more than 65536 scene nodes"):
        read(tmp_path, vox(ONE, *doubling, transform(60, 61), shape(61, 0)))
    chain = [transform(n, n + 1) for n in range(999)]
    with pytest.raises(DoesNotFitError, match="or 256 in one another"):
        read(tmp_path, vox(ONE, *chain, shape(999, 0)))


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(AssetError, match=r"none\.vox: cannot be read"):
        export.read_vox(tmp_path / "none.vox")


def test_damaged_files_are_refused_or_read(tmp_path):
    """Bytes exchanged and files cut at random: an octree or one of our errors, nothing else."""
    good = vox(
        ONE,
        model((2, 2, 2), [(0, 0, 0, 1), (1, 1, 1, 2)]),
        transform(0, 1),
        group(1, 2),
        transform(2, 3, "1 2 3"),
        shape(3, 1),
    )
    rng = random.Random(5)
    refused = 0
    for _ in range(400):
        data = bytearray(good)
        for _ in range(rng.randint(1, 3)):
            data[rng.randrange(len(data))] = rng.choice([0, 1, 3, 127, 128, 255, rng.randrange(256)])
        try:
            read(tmp_path, bytes(data[: rng.choice([len(data), rng.randrange(len(data))])]))
        except (AssetError, DoesNotFitError):
            refused += 1
    assert 100 < refused < 400


@over_assets(
    ("name", "voxels", "colours", "high"),
    [
        ("mikelovesrobots-mmmm/vox/scene_store8.vox", 441118, 49, (117, 61, 124)),
        ("mikelovesrobots-mmmm/vox/scene_house.vox", 92855, 28, (124, 25, 126)),
        ("mikelovesrobots-mmmm/vox/chr_army1.vox", 341, 8, (8, 12, 7)),
        ("opengametools/test_meta_chunk.vox", 64000, 1, (40, 40, 40)),
        ("dot_vox/placeholder-with-materials.vox", 4, 4, (2, 2, 2)),
    ],
)
def test_real_files_of_one_model(name, voxels, colours, high):
    rom, _ = export.read_vox(asset(f"vox/{name}"))
    assert octree.census(rom.octree).solid_voxels == voxels
    assert len(rom.materials) == colours + 1
    assert octree.solid_bounds(rom.octree) == ((0, 0, 0), high)


def test_real_files_of_many_models():
    rom, _ = export.read_vox(asset("vox/opengametools/test_multiple_model_scene.vox"))
    assert octree.solid_bounds(rom.octree) == ((0, 0, 0), (106, 16, 106))
    rom, _ = export.read_vox(asset("vox/dot_vox/axes.vox"))
    assert len(rom.materials) == 5


def test_not_a_vox():
    with pytest.raises(AssetError, match="does not start with 'VOX '"):
        export.read_vox(asset("malformed/dot_vox/not_a.vox"))


def test_odd_chunk_names_keep_to_one_line(tmp_path):
    data = (
        b"VOX " + struct.pack("<i", 150) + b"MAIN" + struct.pack("<ii", 0, 12) + b"a\n\r\xff" + struct.pack("<ii", 9, 0)
    )
    with pytest.raises(AssetError, match=r"^[^\n\r]*chunk a\\n\\r\\xff at byte 20[^\n\r]*$"):
        read(tmp_path, data)
