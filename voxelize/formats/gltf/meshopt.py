"""EXT_meshopt_compression: decoding of compressed buffer views.

Source: the extension's description of its bit streams and filters (Kapoulkine and St. Pierre, appendices A and B).
Streams do not hold their length: every read is checked, and a stream with bytes left over is refused.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from msgspec import Struct

from voxrt.voxelize.formats.gltf.schema import Count, Index  # noqa: TC001 -- msgspec reads the annotations

if TYPE_CHECKING:
    from numpy.typing import NDArray

Mode: TypeAlias = Literal["ATTRIBUTES", "TRIANGLES", "INDICES"]
Filter: TypeAlias = Literal["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"]

_ATTRIBUTES, _TRIANGLES, _INDICES = 0xA0, 0xE1, 0xD1
_GROUP = 16
# The deltas that a byte packs, first the most significant.
_PACKED = {
    bits: [bytes(byte >> shift & (1 << bits) - 1 for shift in range(8 - bits, -1, -bits)) for byte in range(256)]
    for bits in (2, 4)
}


class CompressedView(Struct, frozen=True, rename="camel"):
    """The extension on a buffer view."""

    buffer: Index
    byte_length: Count
    byte_stride: Count
    count: Count
    mode: Mode
    byte_offset: Index = 0
    filter: Filter = "NONE"


class BadStreamError(ValueError):
    """A bit stream that contradicts its header; the message says why."""


def decode(view: CompressedView, data: bytes) -> bytes:
    """Return the ``count * byte_stride`` bytes that `data` encodes.

    Raises
    ------
    BadStreamError
        The stream is damaged, or the view's numbers contradict each other.
    """
    _check(view)
    if view.mode == "ATTRIBUTES":
        elements = _attributes(data, view.count, view.byte_stride)
        return _FILTERS[view.filter](elements).tobytes()
    indices = _triangles(data, view.count // 3) if view.mode == "TRIANGLES" else _indices(data, view.count)
    if view.byte_stride == 2:
        if int(indices.max()) > 0xFFFF:
            raise BadStreamError("an index does not fit its 2 bytes")
        return indices.astype("<u2").tobytes()
    return indices.astype("<u4").tobytes()


def _check(view: CompressedView) -> None:
    if view.mode == "ATTRIBUTES":
        sizes = {"NONE": range(4, 257, 4), "OCTAHEDRAL": (4, 8), "QUATERNION": (8,), "EXPONENTIAL": range(4, 257, 4)}
        fits = view.byte_stride in sizes[view.filter]
    else:
        fits = view.byte_stride in (2, 4) and view.filter == "NONE"
    if not fits:
        raise BadStreamError(f"{view.mode} with filter {view.filter} cannot have elements of {view.byte_stride} bytes")
    if view.mode == "TRIANGLES" and view.count % 3:
        raise BadStreamError(f"{view.count} indices are no whole triangles")


def _attributes(data: bytes, count: int, stride: int) -> NDArray[np.uint8]:
    """Decode mode 0: shape (count, stride)."""
    tail = max(stride, 32)
    if len(data) < 1 + tail or data[0] != _ATTRIBUTES:
        raise BadStreamError("not an attribute stream of version 0")
    end = len(data) - tail
    last = np.frombuffer(data, np.uint8, stride, len(data) - stride)
    most = min(8192 // stride & ~15, 256)
    decoded = np.empty((count, stride), np.uint8)
    at = 1
    for start in range(0, count, most):
        size = min(count - start, most)
        groups = -(-size // _GROUP)
        deltas = np.empty((stride, groups * _GROUP), np.uint8)
        for lane in range(stride):
            packed, at = _deltas(data, at, end, groups)
            deltas[lane] = np.frombuffer(packed, np.uint8)
        signed = (deltas >> 1) ^ (0 - (deltas & 1)).astype(np.uint8)
        block = np.cumsum(signed, axis=1, dtype=np.uint8)[:, :size].T + last
        decoded[start : start + size] = block
        last = block[-1]
    if at != end:
        raise BadStreamError(f"{end - at} bytes are left over")
    return decoded


def _deltas(data: bytes, at: int, end: int, groups: int) -> tuple[bytes, int]:
    """Read one byte's deltas for `groups` groups of 16; return them and where reading stopped."""
    header = at
    at += -(-groups // 4)
    if at > end:
        raise BadStreamError("ends inside a block header")
    found = []
    for group in range(groups):
        mode = data[header + (group >> 2)] >> (group & 3) * 2 & 3
        if mode == 0:
            found.append(bytes(_GROUP))
            continue
        size = _GROUP if mode == 3 else 4 * mode
        if at + size > end:
            raise BadStreamError("ends inside a group of deltas")
        packed = data[at : at + size]
        at += size
        if mode == 3:
            found.append(packed)
            continue
        table, sentinel = _PACKED[2 * mode], (1 << 2 * mode) - 1
        unpacked = bytearray(b"".join([table[byte] for byte in packed]))
        place = unpacked.find(sentinel)
        while place >= 0:
            if at >= end:
                raise BadStreamError("ends inside a group of deltas")
            unpacked[place] = data[at]
            at += 1
            place = unpacked.find(sentinel, place + 1)
        found.append(bytes(unpacked))
    return b"".join(found), at


class _Varints:
    """Little-endian base-128 numbers of a stream, up to `end`."""

    def __init__(self, data: bytes, at: int, end: int) -> None:
        self._data = data
        self._end = end
        self.at = at

    def byte(self) -> int:
        if self.at >= self._end:
            raise BadStreamError("ends inside an index")
        self.at += 1
        return self._data[self.at - 1]

    def read(self) -> int:
        value = 0
        for shift in range(0, 35, 7):
            byte = self.byte()
            value |= (byte & 127) << shift
            if byte < 128:
                return value & 0xFFFFFFFF
        raise BadStreamError("an index of more than 32 bits")


def _zigzag(value: int) -> int:
    return ~(value >> 1) if value & 1 else value >> 1


class _Triangles:
    """The state of the triangle decoder: recent edges and vertices, and the next and the last index."""

    def __init__(self, data: bytes, extra: _Varints) -> None:
        self._aux = data[-16:]
        self._extra = extra
        self._edges = [(0, 0)] * 16
        self._vertices = [0] * 16
        self._next = 0
        self._last = 0

    def triangle(self, code: int) -> tuple[int, int, int]:
        """Decode the triangle of one code byte."""
        high, low = code >> 4, code & 15
        if high == 15:
            return self._corners(low)
        a, b = self._edges[-1 - high]
        if low == 0:
            c = self._fresh()
        elif low < 13:
            c = self._vertices[-1 - low]
        else:
            c = self._last = self._last + {13: -1, 14: 1}[low] & 0xFFFFFFFF if low < 15 else self._explicit()
        if low == 0 or low >= 13:
            self._push(c)
        self._edges = [*self._edges[2:], (c, b), (a, c)]
        return a, b, c

    def _corners(self, low: int) -> tuple[int, int, int]:
        if low < 14:
            pair, a = self._aux[low], self._fresh()
        else:
            pair = self._extra.byte()
            if pair == 0:
                self._next = 0
            a = self._fresh() if low == 14 else self._explicit()
        b, b_is_new = self._corner(pair >> 4)
        c, c_is_new = self._corner(pair & 15)
        self._push(a)
        if b_is_new:
            self._push(b)
        if c_is_new:
            self._push(c)
        self._edges = [*self._edges[3:], (b, a), (c, b), (a, c)]
        return a, b, c

    def _corner(self, nibble: int) -> tuple[int, bool]:
        if nibble == 0:
            return self._fresh(), True
        if nibble < 15:
            return self._vertices[-nibble], False
        return self._explicit(), True

    def _fresh(self) -> int:
        self._next += 1
        return self._next - 1

    def _explicit(self) -> int:
        self._last = self._last + _zigzag(self._extra.read()) & 0xFFFFFFFF
        return self._last

    def _push(self, vertex: int) -> None:
        self._vertices = [*self._vertices[1:], vertex]


def _triangles(data: bytes, count: int) -> NDArray[np.int64]:
    """Decode mode 1: shape (3 * count,)."""
    end = len(data) - 16
    if end < 1 + count or data[0] != _TRIANGLES:
        raise BadStreamError("not a triangle stream of version 1")
    extra = _Varints(data, 1 + count, end)
    state = _Triangles(data, extra)
    corners = np.array([state.triangle(code) for code in data[1 : 1 + count]], np.int64).reshape(-1)
    if extra.at != end:
        raise BadStreamError(f"{end - extra.at} bytes are left over")
    return corners


def _indices(data: bytes, count: int) -> NDArray[np.int64]:
    """Decode mode 2: shape (count,)."""
    end = len(data) - 4
    if end < 1 + count or data[0] != _INDICES:
        raise BadStreamError("not an index stream of version 1")
    stream = _Varints(data, 1, end)
    last = [0, 0]
    found = []
    for _ in range(count):
        value = stream.read()
        last[value & 1] = last[value & 1] + _zigzag(value >> 1) & 0xFFFFFFFF
        found.append(last[value & 1])
    if stream.at != end:
        raise BadStreamError(f"{end - stream.at} bytes are left over")
    return np.array(found, np.int64)


def _unfiltered(elements: NDArray[np.uint8]) -> NDArray[np.uint8]:
    return elements


def _octahedral(elements: NDArray[np.uint8]) -> NDArray[np.int8] | NDArray[np.int16]:
    """Unfold unit vectors from the octahedron that they were folded onto; the fourth component stays."""
    stored: NDArray[np.int8] | NDArray[np.int16] = elements.view("<i1" if elements.shape[1] == 4 else "<i2")
    wide = stored.astype(np.float64)
    with np.errstate(divide="ignore", invalid="ignore"):
        x, y = wide[:, 0] / wide[:, 2], wide[:, 1] / wide[:, 2]
        z = 1.0 - np.abs(x) - np.abs(y)
        fold = np.minimum(z, 0.0)
        unit = np.stack([x - np.copysign(fold, x), y - np.copysign(fold, y), z], axis=1)
        unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    decoded = stored.copy()
    decoded[:, :3] = _rounded(unit, np.iinfo(stored.dtype).max)
    return decoded


def _quaternion(elements: NDArray[np.uint8]) -> NDArray[np.int16]:
    """Complete unit quaternions from their three smaller components."""
    stored = elements.view("<i2").astype(np.int64)
    one = (stored[:, 3] | 3).astype(np.float64)
    small = stored[:, :3] / one[:, None] * np.sqrt(0.5)
    largest = np.sqrt(np.maximum(0.0, 1.0 - (small**2).sum(axis=1)))
    decoded = np.empty(stored.shape, "<i2")
    rows = np.arange(len(stored))
    for step, component in enumerate((*small.T, largest), start=1):
        decoded[rows, ((stored[:, 3] & 3) + step) % 4] = _rounded(component, 32767)
    return decoded


def _exponential(elements: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Make floating-point numbers of 24 bits of mantissa and 8 of exponent."""
    stored = elements.view("<i4").astype(np.int64)
    exponent, mantissa = stored >> 24, ((stored & 0xFFFFFF) ^ 0x800000) - 0x800000
    with np.errstate(over="ignore", under="ignore"):
        numbers: NDArray[np.float32] = np.ldexp(mantissa.astype(np.float64), exponent).astype("<f4")
    return numbers


def _rounded(values: NDArray[np.float64], scale: int) -> NDArray[np.float64]:
    """Round to whole numbers of 1 / `scale`, halves away from 0; what is not a number becomes 0."""
    scaled = np.nan_to_num(np.clip(values, -1.0, 1.0)) * scale
    return np.copysign(np.floor(np.abs(scaled) + 0.5), scaled)


_FILTERS = {
    "NONE": _unfiltered,
    "OCTAHEDRAL": _octahedral,
    "QUATERNION": _quaternion,
    "EXPONENTIAL": _exponential,
}
