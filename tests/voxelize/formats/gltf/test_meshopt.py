"""Compressed buffer views against encoders written for the test, and against the uncompressed data of real files."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest
from assets import asset, over_assets
from hypothesis import given, settings
from hypothesis import strategies as st

from voxrt.voxelize import AssetError, load
from voxrt.voxelize.formats.gltf.meshopt import CompressedView, decode
from voxrt.voxelize.formats.gltf.meshopt_attributes import BadStreamError


def view(mode, count, stride, **options):
    return CompressedView(buffer=0, byte_length=1, byte_stride=stride, count=count, mode=mode, **options)


def zigzag(value):
    return value << 1 if value >= 0 else ~(value << 1)


def varint(value):
    found = bytearray()
    while value >= 128:
        found.append(value & 127 | 128)
        value >>= 7
    return bytes([*found, value])


def pack_group(deltas, mode):
    """One group of 16 deltas in one of the four ways that a header can name."""
    if mode == 0:
        assert not any(deltas)
        return b""
    if mode == 3:
        return bytes(deltas)
    bits = 2 * mode
    most = (1 << bits) - 1
    codes = [min(delta, most) for delta in deltas]
    each = 8 // bits
    packed = [
        sum(code << bits * (each - 1 - at) for at, code in enumerate(codes[start : start + each]))
        for start in range(0, 16, each)
    ]
    return bytes(packed) + bytes(delta for delta in deltas if delta >= most)


def encode_attributes(elements, choose):
    """Mode 0; `choose` picks among the ways to pack a group."""
    count, stride = elements.shape
    most = min(8192 // stride & ~15, 256)
    stream = bytearray([0xA0])
    last = first = elements[0]
    for start in range(0, count, most):
        block = elements[start : start + most]
        groups = -(-len(block) // 16)
        for lane in range(stride):
            values = [int(last[lane]), *map(int, block[:, lane])]
            deltas = []
            for before, after in pairwise(values):
                signed = (after - before + 128) % 256 - 128
                deltas.append(zigzag(signed) & 255)
            deltas += [0] * (groups * 16 - len(deltas))
            header, body = [], b""
            for at in range(groups):
                group = deltas[at * 16 : at * 16 + 16]
                mode = choose([0, 1, 2, 3] if not any(group) else [1, 2, 3])
                header.append(mode)
                body += pack_group(group, mode)
            header += [0] * (-len(header) % 4)
            stream += bytes(
                sum(mode << 2 * at for at, mode in enumerate(header[start : start + 4]))
                for start in range(0, len(header), 4)
            )
            stream += body
        last = block[-1]
    return bytes(stream) + bytes(max(0, 32 - stride)) + first.tobytes()


@settings(max_examples=60, deadline=None)
@given(data=st.data())
def test_attributes_are_read_back(data):
    stride = data.draw(st.sampled_from([4, 8, 12, 64, 256]))
    count = data.draw(st.integers(1, 300 if stride < 64 else 40))
    seed = data.draw(st.integers(0, 2**32))
    random = np.random.default_rng(seed)
    elements = np.cumsum(random.integers(-3, 4, (count, stride)), axis=0).astype(np.uint8)
    elements[random.random(count) < 0.1] = random.integers(0, 256)
    stream = encode_attributes(elements, random.choice)
    assert decode(view("ATTRIBUTES", count, stride), stream) == elements.tobytes()


def test_the_example_of_the_specification():
    packed = bytes([0x17, 0x5F, 0xF0, 0xBC, 0x77, 0xA9, 0x21, 0x00, 0x34, 0xB5])
    expected = np.cumsum([-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]).astype(np.uint8)
    lanes = b"\x02" + packed + b"\x00" * 3
    stream = b"\xa0" + lanes + bytes(32)
    found = np.frombuffer(decode(view("ATTRIBUTES", 16, 4), stream), np.uint8).reshape(16, 4)
    assert found[:, 0].tolist() == expected.tolist()
    assert not found[:, 1:].any()


class TriangleEncoder:
    """Mode 1, taking any encoding that fits, at random."""

    def __init__(self, random):
        self.random, self.codes, self.extra = random, bytearray(), b""
        self.edges, self.vertices, self.next, self.last = [], [], 0, 0
        self.aux = bytes([0x00, 0x76, 0x87, 0x56, 0x67, 0x78, 0xA9, 0x86, 0x65, 0x89, 0x68, 0x98, 0x01, 0x69, 0, 0])

    def explicit(self, index):
        delta = (index - self.last + 2**31) % 2**32 - 2**31
        self.extra += varint(zigzag(delta))
        self.last = index

    def corner(self, index):
        """A nibble for one corner, by any means; and whether it is new to the vertex FIFO."""
        ways = ["explicit"] + (["next"] if index == self.next else [])
        recent = self.vertices[::-1][:14]
        ways += ["recent"] if index in recent else []
        way = self.random.choice(ways)
        if way == "next":
            self.next += 1
            return 0, True
        if way == "recent":
            return recent.index(index) + 1, False
        return 15, True

    def add(self, a, b, c):
        for turned in ((a, b, c), (b, c, a), (c, a, b)):
            recent = self.edges[::-1][:15]
            if turned[:2] in recent and self.random.random() < 0.8:
                return self.by_edge(recent.index(turned[:2]), *turned)
        return self.by_corners(a, b, c)

    def by_edge(self, edge, a, b, c):
        recent = self.vertices[::-1][:13]
        if c == self.next:
            low, self.next = 0, self.next + 1
        elif c in recent[1:]:
            low = recent.index(c, 1)
        elif c in (self.last - 1, self.last + 1):
            low, self.last = (13 if c < self.last else 14), c
        else:
            low = 15
            self.explicit(c)
        self.codes.append(edge << 4 | low)
        self.edges += [(c, b), (a, c)]
        if low in (0, 13, 14, 15):
            self.vertices.append(c)
        return a, b, c

    def by_corners(self, a, b, c):
        if (a, b, c) == (self.next, self.next + 1, self.next + 2) and self.random.random() < 0.7:
            self.codes.append(0xF0)
            self.next += 3
            news = (True, True)
        else:
            fresh = a == self.next
            self.codes.append(0xFE if fresh else 0xFF)
            self.next += fresh
            # The corners' nibbles stand before the indices that they announce.
            before, self.extra = self.extra, b""
            if not fresh:
                self.explicit(a)
            nibbles, news = [], []
            for index in (b, c):
                nibble, new = self.corner(index)
                if nibble == 15:
                    self.explicit(index)
                nibbles.append(nibble)
                news.append(new)
            byte = nibbles[0] << 4 | nibbles[1]
            if byte == 0:
                # Two fresh corners by this code would restart the sequence: say it the long way.
                self.next -= 2
                for index in (b, c):
                    self.explicit(index)
                byte = 0xFF
            self.extra = before + bytes([byte]) + self.extra
        self.edges += [(b, a), (c, b), (a, c)]
        self.vertices.append(a)
        self.vertices += [index for index, new in zip((b, c), news, strict=True) if new]
        return a, b, c

    def stream(self):
        return b"\xe1" + bytes(self.codes) + self.extra + self.aux


@settings(max_examples=100, deadline=None)
@given(seed=st.integers(0, 2**32), count=st.integers(1, 120), stride=st.sampled_from([2, 4]))
def test_triangles_are_read_back(seed, count, stride):
    random = np.random.default_rng(seed)
    encoder = TriangleEncoder(random)
    expected = []
    for _ in range(count):
        if encoder.edges and random.random() < 0.7:
            a, b = encoder.edges[-1 - int(random.integers(0, min(15, len(encoder.edges))))]
            c = int(random.choice([encoder.next, max(encoder.last - 1, 0), encoder.last + 1, random.integers(0, 500)]))
        else:
            a, b, c = (
                (encoder.next + at for at in range(3)) if random.random() < 0.5 else random.integers(0, 500, 3).tolist()
            )
        expected.append(encoder.add(a, b, c))
    found = np.frombuffer(decode(view("TRIANGLES", 3 * count, stride), encoder.stream()), f"<u{stride}")
    assert found.reshape(-1, 3).tolist() == [list(triangle) for triangle in expected]


@settings(max_examples=60, deadline=None)
@given(
    values=st.lists(st.integers(0, 2**32 - 1).map(lambda v: v % 2**30), min_size=1, max_size=40),
    seed=st.integers(0, 99),
)
def test_indices_are_read_back(values, seed):
    random = np.random.default_rng(seed)
    last, stream = [0, 0], b"\xd1"
    for value in values:
        base = int(random.integers(0, 2))
        stream += varint(zigzag(value - last[base]) << 1 | base)
        last[base] = value
    found = np.frombuffer(decode(view("INDICES", len(values), 4), stream + bytes(4)), "<u4")
    assert found.tolist() == values


def test_exponential_numbers():
    numbers = [(0, 1), (-3, 5), (4, -7), (-100, 1), (100, -(2**23))]
    stored = np.array([[exponent << 24 | mantissa & 0xFFFFFF] for exponent, mantissa in numbers]).astype("<u4")
    stream = encode_attributes(stored.view(np.uint8), lambda modes: modes[-1])
    found = np.frombuffer(decode(view("ATTRIBUTES", len(numbers), 4, filter="EXPONENTIAL"), stream), "<f4")
    assert found.tolist() == [math.ldexp(mantissa, exponent) for exponent, mantissa in numbers]


@given(st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 0.1))
def test_quaternions(numbers):
    unit = np.array(numbers) / np.linalg.norm(numbers)
    largest = int(np.abs(unit).argmax())
    unit *= np.sign(unit[largest])
    one = 2047
    rest = [round(unit[(largest + step) % 4] * math.sqrt(2) * one) for step in (1, 2, 3)]
    stored = np.array([[*rest, one & ~3 | largest]], "<i2")
    stream = encode_attributes(stored.view(np.uint8), lambda modes: modes[-1])
    found = np.frombuffer(decode(view("ATTRIBUTES", 1, 8, filter="QUATERNION"), stream), "<i2") / 32767
    np.testing.assert_allclose(found, unit, atol=2e-3)


@pytest.mark.parametrize(("dtype", "one", "tolerance"), [("<i1", 127, 0.02), ("<i2", 511, 0.005)])
@given(st.lists(st.floats(-1, 1), min_size=3, max_size=3).filter(lambda v: np.linalg.norm(v) > 0.1))
def test_octahedral_vectors(dtype, one, tolerance, vector):
    unit = np.array(vector) / np.linalg.norm(vector)
    x, y, z = unit / np.abs(unit).sum()
    if z < 0:
        x, y = math.copysign(1 - abs(y), x), math.copysign(1 - abs(x), y)
    stored = np.array([[round(x * one), round(y * one), one, -5]], dtype)
    stream = encode_attributes(stored.view(np.uint8), lambda modes: modes[-1])
    size = stored.itemsize * 4
    found = np.frombuffer(decode(view("ATTRIBUTES", 1, size, filter="OCTAHEDRAL"), stream), dtype)
    assert found[3] == -5
    np.testing.assert_allclose(found[:3] / np.iinfo(dtype).max, unit, atol=tolerance)


@settings(max_examples=200, deadline=None)
@given(
    st.sampled_from(["ATTRIBUTES", "TRIANGLES", "INDICES"]),
    st.sampled_from([b"\xa0", b"\xe1", b"\xd1"]),
    st.integers(1, 60),
    st.binary(max_size=120),
)
def test_noise_is_decoded_or_refused(mode, header, count, noise):
    try:
        found = decode(view(mode, count, 4), header + noise)
    except BadStreamError:
        return
    assert len(found) == count * 4


@pytest.mark.parametrize(
    ("broken", "message"),
    [
        (view("TRIANGLES", 4, 2), "4 indices are no whole triangles"),
        (view("INDICES", 4, 3), "INDICES with filter NONE cannot have elements of 3 bytes"),
        (view("ATTRIBUTES", 4, 12, filter="QUATERNION"), "QUATERNION cannot have elements of 12 bytes"),
        (view("INDICES", 3, 2), "an index does not fit its 2 bytes"),
    ],
)
def test_contradictions_are_refused(broken, message):
    stream = b"\xd1" + varint(zigzag(70000) << 1) * 3 + bytes(4)
    with pytest.raises(BadStreamError, match=message):
        decode(broken, stream)


def test_what_a_real_file_compresses_is_its_own_fallback():
    path = asset("gltf/gltf-pipeline/meshopt-fallback/meshopt-fallback.gltf")
    gltf = json.loads(path.read_text())
    buffers = [(path.parent / buffer["uri"]).read_bytes() for buffer in gltf["buffers"]]
    for plain in gltf["bufferViews"]:
        packed = plain["extensions"]["EXT_meshopt_compression"]
        start = packed.get("byteOffset", 0)
        data = buffers[packed["buffer"]][start : start + packed["byteLength"]]
        # Its fallback is what the stream holds before the filter.
        found = decode(view(packed["mode"], packed["count"], packed["byteStride"]), data)
        start = plain.get("byteOffset", 0)
        expected = buffers[plain["buffer"]][start : start + plain["byteLength"]]
        if packed["mode"] == "TRIANGLES":  # whose corners an encoder may turn
            turned = [
                [min((a, b, c), (b, c, a), (c, a, b)) for a, b, c in np.frombuffer(side, "<u2").reshape(-1, 3).tolist()]
                for side in (found, expected)
            ]
            assert turned[0] == turned[1]
        else:
            assert found == expected


def test_twin_files_make_equal_scenes():
    folder = "gltf/gltf-pipeline/meshopt"
    one, other = (load(asset(f"{folder}-{kind}/meshopt-{kind}.gltf")) for kind in ("fallback", "no-fallback"))
    assert one.materials == other.materials
    for mine, twin in zip(one.objects, other.objects, strict=True):
        np.testing.assert_array_equal(mine.mesh.positions, twin.mesh.positions)
        np.testing.assert_array_equal(mine.mesh.triangles, twin.mesh.triangles)
        np.testing.assert_array_equal(mine.transform, twin.transform)


def test_damaged_views_are_refused_with_their_place(tmp_path):
    path = asset("gltf/gltf-pipeline/meshopt-no-fallback/meshopt-no-fallback.gltf")
    gltf = json.loads(path.read_text())
    data = bytearray((path.parent / gltf["buffers"][0]["uri"]).read_bytes())
    for packed in (plain["extensions"]["EXT_meshopt_compression"] for plain in gltf["bufferViews"]):
        data[packed.get("byteOffset", 0)] = 0
    (tmp_path / gltf["buffers"][0]["uri"]).write_bytes(data)
    (tmp_path / "a.gltf").write_text(path.read_text())
    with pytest.raises(
        AssetError, match=r"bufferViews\[\d\]\.extensions\.EXT_meshopt_compression: the compressed data"
    ):
        load(tmp_path / "a.gltf")


@over_assets(
    ("changes", "message"),
    [
        ({"byteLength": 10**6}, r"EXT_meshopt_compression: ends at byte \d+ of a buffer of \d+"),
        ({"count": 10}, r"EXT_meshopt_compression: holds \d+ bytes for a buffer view of \d+"),
        ({"buffer": 9}, r"EXT_meshopt_compression\.buffer: buffer 9 does not exist"),
    ],
)
def test_views_that_contradict_their_buffers_are_refused(changes, message, tmp_path):
    path = asset("gltf/gltf-pipeline/meshopt-no-fallback/meshopt-no-fallback.gltf")
    gltf = json.loads(path.read_text())
    (tmp_path / gltf["buffers"][0]["uri"]).write_bytes((path.parent / gltf["buffers"][0]["uri"]).read_bytes())
    for plain in gltf["bufferViews"]:
        plain["extensions"]["EXT_meshopt_compression"] |= changes
    (tmp_path / "a.gltf").write_text(json.dumps(gltf))
    with pytest.raises(AssetError, match=message):
        load(tmp_path / "a.gltf")
