"""MagicaVoxel ``.vox`` files, chunk by chunk.

Layout: https://github.com/ephtracy/voxel-model (``MagicaVoxel-file-format-vox.txt`` and its extension), versions 150
and 200. Chunks that do not affect the voxels' colours (cameras, notes, render settings) are skipped.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct, field

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import read_asset

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from numpy.typing import NDArray

_VERSIONS = (150, 200)
_LONGEST_SIDE = 256

Vector = tuple[int, int, int]


class VoxModel(Struct, frozen=True, eq=False):
    """One model: `size` in voxels, `voxels` uint8 of shape (N, 4), rows (x, y, z, colour index 1 … 255), z up."""

    size: Vector
    voxels: NDArray[np.uint8]


class Transform(Struct, frozen=True):
    """A node that places its child: world = rows · child + offset, signed unit `rows`."""

    child: int
    rows: tuple[Vector, Vector, Vector]
    offset: Vector
    hidden: bool
    layer: int
    frames: int


class Group(Struct, frozen=True):
    """A node that holds others."""

    children: tuple[int, ...]


class Shape(Struct, frozen=True):
    """A node that shows models, one per frame of its animation."""

    models: tuple[int, ...]


def default_palette() -> NDArray[np.uint8]:
    """Make the palette of files without one: a 6x6x6 cube from white down (black left out), then four ramps of ten."""
    steps = [255, 204, 153, 102, 51, 0]
    rows = [(0, 0, 0), *((red, green, blue) for red in steps for green in steps for blue in steps)][:-1]
    ramp = [0xEE, 0xDD, 0xBB, 0xAA, 0x88, 0x77, 0x55, 0x44, 0x22, 0x11]
    for axes in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)):
        rows += [(axes[0] * value, axes[1] * value, axes[2] * value) for value in ramp]
    return np.array(rows, dtype=np.uint8)


class VoxFile(Struct):
    """The content of a file."""

    models: list[VoxModel] = field(default_factory=list)  # in the order of the file
    # uint8, shape (256, 3): sRGB by colour index; row 0 is empty space.
    palette: NDArray[np.uint8] = field(default_factory=default_palette)
    # The scene graph by node id; empty in files without one.
    nodes: dict[int, Transform | Group | Shape] = field(default_factory=dict)
    hidden_layers: set[int] = field(default_factory=set)  # layers that the author hid
    # By colour index: ``_metal``, ``_glass``, ``_emit`` and so on, where it is not ``_diffuse``.
    material_types: dict[int, str] = field(default_factory=dict)


def read_chunks(path: Path) -> VoxFile:
    """Read a file; raise AssetError with the chunk and its offset where the file breaks the format."""
    data = read_asset(path)
    reader = _Reader(path, data, 0, len(data), "header")
    if reader.take(4) != b"VOX ":
        raise AssetError(path, "does not start with 'VOX '", fix="name a MagicaVoxel file")
    version = reader.integer()
    if version not in _VERSIONS:
        raise AssetError(
            path, f"version {version} is none of {_VERSIONS}", fix="save it with MagicaVoxel 0.98 or later"
        )
    file = VoxFile()
    size: Vector | None = None
    for name, content in reader.chunks():
        if name == "MAIN":
            continue  # its children follow it
        if name == "SIZE":
            size = _size(content)
        elif name == "XYZI":
            if size is None:
                raise content.fault("has no SIZE before it")
            file.models.append(VoxModel(size, _voxels(content, size)))
            size = None
        elif parse := _PARSERS.get(name):
            parse(content, file)
    return file


class _Reader:
    """A part of the file, read from its start to its end."""

    def __init__(self, path: Path, data: bytes, start: int, end: int, name: str) -> None:
        self._path, self._data, self._position, self._end = path, data, start, end
        self._place = f"chunk {name} at byte {start}"

    def fault(self, problem: str) -> AssetError:
        return AssetError(self._path, problem, place=self._place, fix="the file is damaged; save it again")

    def take(self, count: int) -> bytes:
        if not 0 <= count <= self._end - self._position:
            raise self.fault(f"{count} bytes should follow, and {self._end - self._position} do")
        self._position += count
        return self._data[self._position - count : self._position]

    def integer(self) -> int:
        return int(struct.unpack("<i", self.take(4))[0])

    def count(self, size: int) -> int:
        """Read the number of entries of `size` bytes or more that follow."""
        count = self.integer()
        if not 0 <= count <= (self._end - self._position) // size:
            raise self.fault(f"{count} entries should follow, and the chunk is too short for them")
        return count

    def dictionary(self) -> dict[str, str]:
        pairs = [(self._text(), self._text()) for _ in range(self.count(8))]
        return dict(pairs)

    def _text(self) -> str:
        return self.take(self.count(1)).decode("utf-8", "replace")

    def chunks(self) -> Iterator[tuple[str, _Reader]]:
        """All chunks, parents before their children."""
        while self._position < self._end:
            name = self.take(4).decode("latin-1").encode("unicode_escape").decode()  # printable, in messages
            start = self._position + 8
            content, children = self.integer(), self.integer()
            if content < 0 or children < 0 or content + children > self._end - start:
                raise AssetError(
                    self._path,
                    f"should have {content} + {children} bytes, and {self._end - start} follow",
                    place=f"chunk {name} at byte {start - 12}",
                    fix="the file is cut short or damaged; save it again",
                )
            self._position = start + content
            yield name, _Reader(self._path, self._data, start, start + content, name)


def _size(content: _Reader) -> Vector:
    size = content.integer(), content.integer(), content.integer()
    if not all(1 <= side <= _LONGEST_SIDE for side in size):
        raise content.fault(f"a model of {size} voxels is outside 1 ... {_LONGEST_SIDE}")
    return size


def _voxels(content: _Reader, size: Vector) -> NDArray[np.uint8]:
    rows = np.frombuffer(content.take(4 * content.count(4)), dtype=np.uint8).reshape(-1, 4)
    outside = (rows[:, :3] >= np.array(size)).any(axis=1) | (rows[:, 3] == 0)
    if outside.any():
        x, y, z, colour = rows[int(np.argmax(outside))].tolist()
        raise content.fault(f"voxel ({x}, {y}, {z}) of colour {colour} does not belong in a model of {size}")
    return rows


def _palette(content: _Reader, file: VoxFile) -> None:
    rows = np.frombuffer(content.take(1024), dtype=np.uint8).reshape(256, 4)[:, :3]
    file.palette = np.concatenate([np.zeros((1, 3), dtype=np.uint8), rows[:255]])


def _transform(content: _Reader, file: VoxFile) -> None:
    node, attributes = content.integer(), content.dictionary()
    child, _, layer = content.integer(), content.integer(), content.integer()
    frames = [content.dictionary() for _ in range(content.count(4))]
    frame = frames[0] if frames else {}
    file.nodes[node] = Transform(
        child,
        _rotation(content, frame.get("_r", "4")),
        _offset(content, frame.get("_t", "0 0 0")),
        attributes.get("_hidden") == "1",
        layer,
        len(frames),
    )


def _rotation(content: _Reader, text: str) -> tuple[Vector, Vector, Vector]:
    """Return a rotation: two bits per row give the column of the first two rows, one bit per row gives its sign."""
    bits = int(text) if text.isdecimal() and len(text) <= 3 else 3
    first, second = bits & 3, bits >> 2 & 3
    if first == 3 or second in (3, first) or bits >> 7:
        raise content.fault(f"{text[:20]!r} is not a rotation")
    columns = (first, second, 3 - first - second)
    rows = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]
    for row, column in enumerate(columns):
        rows[row][column] = -1 if bits >> (4 + row) & 1 else 1
    return tuple((row[0], row[1], row[2]) for row in rows)  # type: ignore[return-value]


def _offset(content: _Reader, text: str) -> Vector:
    try:
        x, y, z = (int(number) for number in text[:64].split())
    except ValueError:
        raise content.fault(f"{text[:20]!r} is not a translation") from None
    if max(abs(x), abs(y), abs(z)) >= 1 << 31:
        raise content.fault(f"{text[:20]!r} is not a translation")
    return x, y, z


def _group(content: _Reader, file: VoxFile) -> None:
    node, _ = content.integer(), content.dictionary()
    file.nodes[node] = Group(tuple(content.integer() for _ in range(content.count(4))))


def _shape(content: _Reader, file: VoxFile) -> None:
    node, _ = content.integer(), content.dictionary()
    models = []
    for _ in range(content.count(8)):
        models.append(content.integer())
        content.dictionary()
    file.nodes[node] = Shape(tuple(models))


def _layer(content: _Reader, file: VoxFile) -> None:
    layer, attributes = content.integer(), content.dictionary()
    if attributes.get("_hidden") == "1":
        file.hidden_layers.add(layer)


def _material(content: _Reader, file: VoxFile) -> None:
    colour, attributes = content.integer(), content.dictionary()
    kind = attributes.get("_type", "_diffuse")
    if kind != "_diffuse":
        file.material_types[colour & 0xFF] = kind


_PARSERS = {"RGBA": _palette, "nTRN": _transform, "nGRP": _group, "nSHP": _shape, "LAYR": _layer, "MATL": _material}
