"""Accessors against what NumPy says of the same numbers, through a writer that knows nothing of the reader."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles.gltf_writer import SHAPES, GltfWriter

from voxrt.voxelize import AssetError
from voxrt.voxelize.formats.gltf.accessors import normalized, read_accessor, read_floats
from voxrt.voxelize.formats.gltf.document import Document

ALL = set(SHAPES.values())


@st.composite
def stored_elements(draw):
    dtype = draw(st.sampled_from(["i1", "u1", "i2", "u2", "u4", "f4"]))
    shape = draw(st.sampled_from(list(SHAPES)))
    count = draw(st.integers(1, 9))
    if dtype == "f4":
        numbers = st.floats(-1e6, 1e6, width=32)
    else:
        limits = np.iinfo(dtype)
        numbers = st.integers(int(limits.min), int(limits.max))
    size = count * int(np.prod(shape, dtype=int))
    flat = draw(st.lists(numbers, min_size=size, max_size=size))
    return dtype, np.array(flat, dtype).reshape(count, *shape)


@settings(max_examples=150, deadline=None)
@given(data=st.data(), elements=stored_elements(), suffix=st.sampled_from([".glb", ".gltf"]))
def test_every_type_layout_and_sparse_patch_is_read_back(data, elements, suffix, tmp_path_factory):
    dtype, values = elements
    writer = GltfWriter()
    stride = data.draw(st.none() | st.integers(64, 252), "stride")
    offset = data.draw(st.integers(0, 5), "offset")
    expected = values.copy()
    sparse = None
    base = values
    if data.draw(st.booleans(), "sparse"):
        rows = sorted(data.draw(st.sets(st.integers(0, len(values) - 1), min_size=1), "rows"))
        patch = values[::-1][: len(rows)]
        sparse = (rows, patch, data.draw(st.sampled_from(["u1", "u2", "u4"])))
        if data.draw(st.booleans(), "zeros"):
            base, expected = len(values), np.zeros_like(values)
        expected[rows] = patch
    index = writer.accessor(base, dtype, stride=stride, offset=offset, sparse=sparse)
    document = Document(writer.save(tmp_path_factory.mktemp("accessor") / f"a{suffix}"))
    read = read_accessor(document, index, "here", ALL)
    assert read.dtype == np.dtype(dtype)
    np.testing.assert_array_equal(read, expected.reshape(len(expected), -1))


@pytest.mark.parametrize("dtype", ["i1", "u1", "i2", "u2"])
def test_normalized_integers_are_the_nearest_double_to_the_fraction(dtype):
    limits = np.iinfo(dtype)
    values = np.arange(limits.min, limits.max + 1).astype(dtype)
    expected = [float(max(Fraction(int(value), int(limits.max)), Fraction(-1))) for value in values]
    np.testing.assert_array_equal(normalized(values), expected)


def test_normalized_is_honoured_only_where_it_is_said(tmp_path):
    writer = GltfWriter()
    plain = writer.accessor([[0, 128, 255]], "u1")
    scaled = writer.accessor([[0, 51, 255]], "u1", normalized=True)
    document = Document(writer.save(tmp_path / "a.glb"))
    assert read_floats(document, plain, "here", ALL).tolist() == [[0.0, 128.0, 255.0]]
    assert read_floats(document, scaled, "here", ALL).tolist() == [[0.0, 0.2, 1.0]]


def broken(change, tmp_path, message, read=read_accessor):
    writer = GltfWriter()
    index = writer.accessor([[1, 2, 3], [4, 5, 6]], sparse=([1], [[7, 8, 9]], "u1"))
    change(writer.json)
    path = writer.save(tmp_path / "broken.gltf")
    with pytest.raises(AssetError, match=message):
        read(Document(path), index, "here", {"VEC3"})


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"count": 3}, r"accessors\[0\]: 3 elements end at byte 36 of a buffer view of 24"),
        ({"byteOffset": 4}, r"accessors\[0\]: 2 elements end at byte 28"),
        ({"count": 10**15}, r"accessors\[0\]: needs 12000000000000000 bytes"),
        ({"bufferView": 9}, r"accessors\[0\]\.bufferView: buffer view 9 does not exist, the file has 3"),
        ({"type": "VEC2"}, r"here: accessor 0 holds VEC2 elements, which are not allowed here"),
        ({"type": "VEC5"}, r"accessors\[0\]\.type: invalid enum value 'VEC5'"),
        ({"componentType": 5124}, r"accessors\[0\]\.componentType: invalid enum value 5124"),
        ({"count": 0}, r"accessors\[0\]\.count: expected `int` >= 1"),
        ({"count": 1.5}, r"accessors\[0\]\.count: expected `int`, got `float`"),
    ],
)
def test_broken_accessors_are_refused_with_their_place(changes, message, tmp_path):
    broken(lambda gltf: gltf["accessors"][0].update(changes), tmp_path, message)


@pytest.mark.parametrize(
    ("part", "changes", "message"),
    [
        ("indices", {"componentType": 5123}, r"accessors\[0\]\.sparse\.indices: 1 elements end at byte 2"),
        ("indices", {"byteOffset": 1}, r"accessors\[0\]\.sparse\.indices: 1 elements end at byte 2"),
        ("values", {"bufferView": 1}, r"accessors\[0\]\.sparse\.values: 1 elements end at byte 12"),
    ],
)
def test_broken_sparse_parts_are_refused(part, changes, message, tmp_path):
    broken(lambda gltf: gltf["accessors"][0]["sparse"][part].update(changes), tmp_path, message)


def test_sparse_indices_beyond_the_accessor_are_refused(tmp_path):
    writer = GltfWriter()
    index = writer.accessor([1.0, 2.0], sparse=([2], [5.0], "u1"))
    more = writer.accessor([1.0], sparse=([0, 0], [5.0, 6.0], "u1"))
    document = Document(writer.save(tmp_path / "a.glb"))
    with pytest.raises(AssetError, match=r"accessors\[0\]\.sparse\.indices: index 2 of 2 elements"):
        read_accessor(document, index, "here", ALL)
    with pytest.raises(AssetError, match=r"accessors\[1\]\.sparse: replaces 2 of 1 elements"):
        read_accessor(document, more, "here", ALL)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_not_finite_are_refused(value, tmp_path):
    writer = GltfWriter()
    index = writer.accessor([[0, 0, 0], [0, value, 0]])
    document = Document(writer.save(tmp_path / "a.glb"))
    with pytest.raises(AssetError, match=r"accessors\[0\]: element 1 is not a finite number"):
        read_floats(document, index, "here", ALL)


def test_a_stride_smaller_than_the_element_is_refused(tmp_path):
    writer = GltfWriter()
    index = writer.accessor([[1, 2, 3], [4, 5, 6]])
    writer.json["bufferViews"][0]["byteStride"] = 8
    document = Document(writer.save(tmp_path / "a.glb"))
    with pytest.raises(AssetError, match=r"accessors\[0\]: elements of 12 bytes in a buffer view of stride 8"):
        read_accessor(document, index, "here", ALL)
