"""The PLY format: a header that describes tables, and their rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from msgspec import Struct

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.written_numbers import read_reals

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

_TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "float32": "f4",
    "float64": "f8",
}
_LONGEST_NUMBER = 64
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


class _Property(Struct, frozen=True):
    name: str
    kind: str
    count_kind: str | None  # the type of a list's length; None for a plain value


class _Element(Struct, frozen=True):
    name: str
    count: int
    properties: tuple[_Property, ...]


class ListColumn(Struct, frozen=True, eq=False):
    """A list property of all rows: their lengths, int64 (N,), and their values end to end."""

    counts: NDArray[np.int64]
    values: Column


Column: TypeAlias = "NDArray[np.float64] | NDArray[np.integer]"
Table: TypeAlias = "dict[str, Column | ListColumn]"


class _Binary(Struct, frozen=True):
    """A binary file under reading."""

    path: Path
    data: bytes
    order: str


class PlyFile(Struct, frozen=True, eq=False):
    """The content of a file."""

    # Columns by property, by element, of the type that the header says. In ASCII files reals are float64, and whole
    # numbers that do not fit their type are int64.
    tables: dict[str, Table]
    textures: tuple[str, ...]  # the names of ``comment TextureFile`` lines, in order


def read_ply(path: Path, data: bytes) -> PlyFile:
    """Read all tables; raise AssetError where the header is invalid, or the rows do not match it."""
    order, elements, body, textures = _header(path, data)
    if order:
        return PlyFile(_binary(_Binary(path, data, order), body, elements), textures)
    return PlyFile(_ascii(path, data[body:], elements), textures)


def _header(path: Path, data: bytes) -> tuple[str, list[_Element], int, tuple[str, ...]]:
    """Byte order ("" for ASCII), elements, where the body begins, and the names of textures."""
    end = data.find(b"end_header", 0, 1 << 16)
    if not data.startswith(b"ply") or end < 0:
        raise AssetError(path, "is empty" if not data else "has no PLY header", fix="export it again")
    # A header's lines end with LF, CR LF, or CR alone.
    newline = b"\n" if b"\n" in data[:end] else b"\r"
    body = data.find(newline, end)
    body = len(data) if body < 0 else body + 1
    textures: list[str] = []
    orders: list[str] = []
    elements: list[_Element] = []
    for number, line in enumerate(data[:end].decode("latin-1").splitlines()[1:], start=2):
        try:
            if line.lower().startswith("comment texturefile "):
                textures.append(line[len("comment texturefile ") :].strip())
            _header_line(line.split(), orders, elements)
        except (KeyError, ValueError, IndexError):
            problem = f"cannot understand {line!r}"
            raise AssetError(path, problem, place=f"line {number}", fix="export it again") from None
    if len(orders) != 1:
        raise AssetError(path, f"has {len(orders)} format lines", fix="export it again")
    return orders[0], elements, body, tuple(textures)


def _header_line(words: list[str], orders: list[str], elements: list[_Element]) -> None:
    match words:
        case ["format", encoding, _]:
            orders.append(_ORDERS[encoding])
        case ["element", name, count]:
            if int(count) < 0 or any(name == other.name for other in elements):
                raise ValueError
            elements.append(_Element(name, int(count), ()))
        case ["property", "list", count_kind, kind, name] if _TYPES[count_kind][0] != "f":
            elements[-1] = _with(elements[-1], _Property(name, _TYPES[kind], _TYPES[count_kind]))
        case ["property", kind, name]:
            elements[-1] = _with(elements[-1], _Property(name, _TYPES[kind], None))
        case [] | ["comment", *_] | ["obj_info", *_]:
            pass
        case _:
            raise ValueError


def _with(element: _Element, one: _Property) -> _Element:
    if any(one.name == other.name for other in element.properties):
        raise ValueError
    return _Element(element.name, element.count, (*element.properties, one))


def _cut_short(path: Path, element: _Element) -> AssetError:
    return AssetError(path, f"ends before its {element.count} {element.name} rows do", fix="copy or export it again")


def _ascii(path: Path, body: bytes, elements: list[_Element]) -> dict[str, Table]:
    words = body.split()
    tables: dict[str, Table] = {}
    at = 0
    for element in elements:
        if not any(one.count_kind for one in element.properties):
            width = len(element.properties)
            block = words[at : at + width * element.count]
            if len(block) < width * element.count:
                raise _cut_short(path, element)
            values = read_reals(path, block, element.name).reshape(element.count, width)
            tables[element.name] = {one.name: _declared(one, values[:, i]) for i, one in enumerate(element.properties)}
            at += width * element.count
            continue
        columns: list[list[bytes]] = [[] for _ in element.properties]
        counts: list[list[int]] = [[] for _ in element.properties]
        for _ in range(element.count):
            for column, lengths, one in zip(columns, counts, element.properties, strict=True):
                length = 1
                if one.count_kind:
                    length = int(words[at]) if at < len(words) and words[at].isdigit() else -1
                    at += 1
                if length < 0 or at + length > len(words):
                    raise _cut_short(path, element)
                lengths.append(length)
                column.extend(words[at : at + length])
                at += length
        tables[element.name] = {
            one.name: ListColumn(np.array(lengths, dtype=np.int64), read_reals(path, column, element.name))
            if one.count_kind
            else _declared(one, read_reals(path, column, element.name))
            for column, lengths, one in zip(columns, counts, element.properties, strict=True)
        }
    return tables


def _declared(one: _Property, values: NDArray[np.float64]) -> Column:
    """Return whole numbers in the type that the header says, or in int64 where they do not fit; reals stay."""
    kind = np.dtype(one.kind)
    if kind.kind == "f" or not ((values == np.floor(values)) & (np.abs(values) < 2.0**53)).all():
        return values
    limits = np.iinfo(kind)
    return values.astype(kind if ((values >= limits.min) & (values <= limits.max)).all() else np.int64)


def _binary(file: _Binary, at: int, elements: list[_Element]) -> dict[str, Table]:
    tables: dict[str, Table] = {}
    for element in elements:
        table, at = _binary_element(file, at, element)
        tables[element.name] = table
    return tables


def _binary_element(file: _Binary, at: int, element: _Element) -> tuple[Table, int]:
    if not element.count or not element.properties:
        empty = np.zeros(0)
        no_list = ListColumn(np.zeros(0, dtype=np.int64), empty)
        return {one.name: no_list if one.count_kind else empty for one in element.properties}, at
    lengths = _first_lengths(file, at, element)
    row = _row_type(file.order, element, lengths)
    if at + row.itemsize * element.count <= len(file.data):
        rows = np.frombuffer(file.data, dtype=row, count=element.count, offset=at)
        if all((rows[f"{name} count"] == length).all() for name, length in lengths.items()):
            return {
                one.name: ListColumn(
                    np.full(element.count, lengths[one.name], dtype=np.int64), rows[one.name].reshape(-1)
                )
                if one.count_kind
                else rows[one.name]
                for one in element.properties
            }, at + row.itemsize * element.count
    return _binary_rows(file, at, element)


def _first_lengths(file: _Binary, at: int, element: _Element) -> dict[str, int]:
    """Return the lengths of the first row's lists: nearly always all rows are alike."""
    lengths: dict[str, int] = {}
    for one in element.properties:
        if one.count_kind:
            lengths[one.name], at = _length(file, at, element, one)
            at += np.dtype(one.kind).itemsize * lengths[one.name]
        else:
            at += np.dtype(one.kind).itemsize
    return lengths


def _length(file: _Binary, at: int, element: _Element, one: _Property) -> tuple[int, int]:
    kind = np.dtype(file.order + str(one.count_kind))
    if at + kind.itemsize > len(file.data):
        raise _cut_short(file.path, element)
    length = int(np.frombuffer(file.data, dtype=kind, count=1, offset=at)[0])
    if length < 0 or at + kind.itemsize + length * np.dtype(one.kind).itemsize > len(file.data):
        raise _cut_short(file.path, element)
    return length, at + kind.itemsize


def _row_type(order: str, element: _Element, lengths: dict[str, int]) -> np.dtype[np.void]:
    fields: list[tuple[str, str] | tuple[str, str, tuple[int]]] = []
    for one in element.properties:
        if one.count_kind:
            fields.append((f"{one.name} count", order + one.count_kind))
            fields.append((one.name, order + one.kind, (lengths[one.name],)))
        else:
            fields.append((one.name, order + one.kind))
    return np.dtype(fields)


def _binary_rows(file: _Binary, at: int, element: _Element) -> tuple[Table, int]:
    """Rows whose lists differ in length, one after another."""
    columns: list[list[bytes]] = [[] for _ in element.properties]
    counts: list[list[int]] = [[] for _ in element.properties]
    for _ in range(element.count):
        for column, lengths, one in zip(columns, counts, element.properties, strict=True):
            length = 1
            if one.count_kind:
                length, at = _length(file, at, element, one)
            size = np.dtype(one.kind).itemsize * length
            if at + size > len(file.data):
                raise _cut_short(file.path, element)
            column.append(file.data[at : at + size])
            lengths.append(length)
            at += size
    table: Table = {}
    for column, lengths, one in zip(columns, counts, element.properties, strict=True):
        values = np.frombuffer(b"".join(column), dtype=file.order + one.kind)
        table[one.name] = ListColumn(np.array(lengths, dtype=np.int64), values) if one.count_kind else values
    return table, at
