"""Meshopt's attribute streams, versions 0 and 1 (appendix A of the extensions, mode 0).

Elements come in blocks, each byte of the element on its own, as differences from the element before. Version 1 chooses
for each byte of a block how differences are packed, and for each four bytes of the element what a difference is.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_VERSION_0, _VERSION_1 = 0xA0, 0xA1
_LEAST_TAIL = {_VERSION_0: 32, _VERSION_1: 24}
_GROUP = 16
_ZEROS, _LITERAL = 2, 3
# Bits of a difference by the mode of its group; by the control mode of the byte, and for version 0.
_BITS_0 = (0, 2, 4, 8)
_BITS = ((0, 1, 2, 4), (1, 2, 4, 8))
# The differences that a byte packs: of one bit the least significant first, of more the most significant.
_PACKED = {1: [bytes(byte >> shift & 1 for shift in range(8)) for byte in range(256)]} | {
    bits: [bytes(byte >> shift & (1 << bits) - 1 for shift in range(8 - bits, -1, -bits)) for byte in range(256)]
    for bits in (2, 4)
}


class BadStreamError(ValueError):
    """A bit stream that contradicts its header; the message says why."""


def decode_attributes(data: bytes, count: int, stride: int) -> NDArray[np.uint8]:
    """Return the elements of a stream: uint8, shape (count, stride). Raise BadStreamError where it is damaged."""
    version = data[0] if data else 0
    if version not in _LEAST_TAIL:
        raise BadStreamError("not an attribute stream of version 0 or 1")
    channels = stride // 4 if version == _VERSION_1 else 0
    tail = stride + channels
    end = len(data) - max(tail, _LEAST_TAIL[version])
    if end < 1:
        raise BadStreamError("ends inside its header")
    last = np.frombuffer(data, np.uint8, stride, len(data) - tail)
    modes = data[len(data) - channels :] if channels else bytes(stride // 4)
    if any(mode & 15 > 2 or (mode & 15 < 2 and mode > 15) for mode in modes):
        raise BadStreamError("a channel mode that does not exist")
    most = min(8192 // stride & ~15, 256)
    decoded = np.empty((count, stride), np.uint8)
    at = 1
    for start in range(0, count, most):
        size = min(count - start, most)
        deltas, at = _block(data, at, end, (stride, size), version)
        for channel, mode in enumerate(modes):
            here = slice(4 * channel, 4 * channel + 4)
            decoded[start : start + size, here] = _undone(deltas[here], mode, last[here])[:size]
        last = decoded[start + size - 1]
    if at != end:
        raise BadStreamError(f"{end - at} bytes are left over")
    return decoded


def _block(data: bytes, at: int, end: int, shape: tuple[int, int], version: int) -> tuple[NDArray[np.uint8], int]:
    """Return the differences of a block of `shape` (bytes, elements), in whole groups, and where reading stopped."""
    stride, elements = shape
    groups = -(-elements // _GROUP)
    controls = b""
    if version == _VERSION_1:
        controls, at = data[at : at + stride // 4], at + stride // 4
        if at > end:
            raise BadStreamError("ends inside a control header")
    deltas = np.zeros((stride, groups * _GROUP), np.uint8)
    for lane in range(stride):
        bits = _BITS_0
        if controls:
            control = controls[lane >> 2] >> (lane & 3) * 2 & 3
            if control == _ZEROS:
                continue
            if control == _LITERAL:
                if at + elements > end:
                    raise BadStreamError("ends inside literal bytes")
                deltas[lane, :elements] = np.frombuffer(data, np.uint8, elements, at)
                at += elements
                continue
            bits = _BITS[control]
        packed, at = _deltas(data, at, end, groups, bits)
        deltas[lane] = np.frombuffer(packed, np.uint8)
    return deltas, at


def _deltas(data: bytes, at: int, end: int, groups: int, bits_of: tuple[int, ...]) -> tuple[bytes, int]:
    """Read one byte's differences for `groups` groups of 16; return them and where reading stopped."""
    header = at
    at += -(-groups // 4)
    if at > end:
        raise BadStreamError("ends inside a block header")
    found = []
    for group in range(groups):
        bits = bits_of[data[header + (group >> 2)] >> (group & 3) * 2 & 3]
        size = _GROUP * bits // 8
        if at + size > end:
            raise BadStreamError("ends inside a group of deltas")
        packed = data[at : at + size]
        at += size
        if bits in (0, 8):
            found.append(packed or bytes(_GROUP))
            continue
        table, sentinel = _PACKED[bits], (1 << bits) - 1
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


def _undone(deltas: NDArray[np.uint8], mode: int, last: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return the bytes of which `deltas`, shape (4, N), are the differences: shape (N, 4); `last` came before."""
    kind = np.dtype(("<u1", "<u2", "<u4")[mode & 15])
    stored = np.ascontiguousarray(deltas.T).view(kind)
    before = np.ascontiguousarray(last).view(kind)
    if kind.itemsize == 4:
        turn = mode >> 4  # the encoder turned to the left
        turned = stored >> turn | stored << (32 - turn) if turn else stored
        values = np.bitwise_xor.accumulate(turned, axis=0) ^ before
    else:
        signed = stored >> 1 ^ (0 - (stored & 1)).astype(kind)
        values = np.cumsum(signed, axis=0, dtype=kind) + before
    return np.ascontiguousarray(values.astype(kind)).view(np.uint8)
