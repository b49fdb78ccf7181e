"""KHR_meshopt_compression and EXT_meshopt_compression: decoding of compressed buffer views.

Source: the extensions' descriptions of their bit streams and filters (Kapoulkine and St. Pierre, appendices A and B).
EXT_ has attribute streams of version 0 alone; both are decoded under either name. Streams do not hold their length:
every read is checked, and a stream with bytes left over is refused.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from msgspec import Struct

from voxrt.voxelize.formats.gltf.meshopt_attributes import BadStreamError, decode_attributes
from voxrt.voxelize.formats.gltf.meshopt_filters import FILTERS, SIZES
from voxrt.voxelize.formats.gltf.schema import Count, Index  # noqa: TC001 -- msgspec reads the annotations

if TYPE_CHECKING:
    from numpy.typing import NDArray

Mode: TypeAlias = Literal["ATTRIBUTES", "TRIANGLES", "INDICES"]
Filter: TypeAlias = Literal["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"]

_TRIANGLES, _INDICES = 0xE1, 0xD1


class CompressedView(Struct, frozen=True, rename="camel"):
    """The extension on a buffer view."""

    buffer: Index
    byte_length: Count
    byte_stride: Count
    count: Count
    mode: Mode
    byte_offset: Index = 0
    filter: Filter = "NONE"


def decode(view: CompressedView, data: bytes) -> bytes:
    """Return the ``count * byte_stride`` bytes that `data` encodes.

    Raise BadStreamError where the stream is damaged, or the view's numbers contradict each other.
    """
    _check(view)
    if view.mode == "ATTRIBUTES":
        return FILTERS[view.filter](decode_attributes(data, view.count, view.byte_stride)).tobytes()
    indices = _triangles(data, view.count // 3) if view.mode == "TRIANGLES" else _indices(data, view.count)
    if view.byte_stride == 2:
        if int(indices.max()) > 0xFFFF:
            raise BadStreamError("an index does not fit its 2 bytes")
        return indices.astype("<u2").tobytes()
    return indices.astype("<u4").tobytes()


def _check(view: CompressedView) -> None:
    if view.mode == "ATTRIBUTES":
        fits = view.byte_stride in SIZES[view.filter]
    else:
        fits = view.byte_stride in (2, 4) and view.filter == "NONE"
    if not fits:
        raise BadStreamError(f"{view.mode} with filter {view.filter} cannot have elements of {view.byte_stride} bytes")
    if view.mode == "TRIANGLES" and view.count % 3:
        raise BadStreamError(f"{view.count} indices are no whole triangles")


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
