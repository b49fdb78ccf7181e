"""Accessors as NumPy arrays: every component type, normalized, interleaved and sparse.

Source: Khronos, glTF 2.0 specification, sections 3.6.2 (accessors) and 3.11 (normalized integers).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import Struct

from voxrt.voxelize.formats.gltf.schema import BYTE, FLOAT, SHORT, UNSIGNED_BYTE, UNSIGNED_INT, UNSIGNED_SHORT

if TYPE_CHECKING:
    from collections.abc import Container

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.schema import Accessor, ElementType, Sparse, SparseIndices, SparseValues

_DTYPES: dict[int, np.dtype[Any]] = {
    BYTE: np.dtype("<i1"),
    UNSIGNED_BYTE: np.dtype("<u1"),
    SHORT: np.dtype("<i2"),
    UNSIGNED_SHORT: np.dtype("<u2"),
    UNSIGNED_INT: np.dtype("<u4"),
    FLOAT: np.dtype("<f4"),
}
# Columns and rows; vectors are one column.
_SHAPES: dict[ElementType, tuple[int, int]] = {
    "SCALAR": (1, 1),
    "VEC2": (1, 2),
    "VEC3": (1, 3),
    "VEC4": (1, 4),
    "MAT2": (2, 2),
    "MAT3": (3, 3),
    "MAT4": (4, 4),
}


class Layout(Struct, frozen=True):
    """The memory layout of one element. Columns of matrices start at multiples of 4 bytes."""

    dtype: np.dtype[Any]  # the type of its components, little-endian
    # Its shape; scalars and vectors are one column.
    columns: int
    rows: int

    @property
    def column_bytes(self) -> int:
        """Bytes from one column to the next."""
        packed = self.rows * self.dtype.itemsize
        return packed if self.columns == 1 else -(-packed // 4) * 4

    @property
    def element_bytes(self) -> int:
        """Bytes of one element."""
        return self.columns * self.column_bytes

    @property
    def components(self) -> int:
        """Numbers of one element."""
        return self.columns * self.rows


def layout_of(accessor: Accessor) -> Layout:
    """Return the memory layout of an accessor's elements."""
    return Layout(_DTYPES[accessor.component_type], *_SHAPES[accessor.type])


def read_accessor(document: Document, index: int, place: str, types: Container[str]) -> NDArray[Any]:
    """Read the elements of accessor `index`, to which the JSON path `place` refers, as they are stored.

    They have shape (count, components), matrices column by column. Raise AssetError where the accessor does not exist,
    has none of the allowed element `types`, or leaves its buffer view.
    """
    accessor = document.item(document.gltf.accessors, index, place, "accessor")
    here = f"accessors[{index}]"
    if accessor.type not in types:
        raise document.error(place, f"accessor {index} holds {accessor.type} elements, which are not allowed here")
    layout = layout_of(accessor)
    document.charge(accessor.count * layout.element_bytes, here)
    if accessor.buffer_view is None:
        elements = np.zeros((accessor.count, layout.components), layout.dtype)
    else:
        elements = _strided(document, accessor, accessor.count, layout, here)
    if accessor.sparse is None:
        return elements
    return _patched(document, accessor.sparse, elements, layout, f"{here}.sparse")


def read_floats(document: Document, index: int, place: str, types: Container[str]) -> NDArray[np.float64]:
    """Read accessor `index` as :func:`read_accessor` does, but as finite float64, normalized integers mapped."""
    return as_floats(document, read_accessor(document, index, place, types), index)


def as_reals(document: Document, stored: NDArray[Any], index: int) -> NDArray[np.floating]:
    """Return the elements of accessor `index` as finite reals, normalized integers mapped.

    Elements stored as reals stay float32, without a copy.
    """
    if stored.dtype.kind == "f":
        finite = np.isfinite(stored)
        if not finite.all():
            row = int(np.argmin(finite.all(axis=1)))
            raise document.error(f"accessors[{index}]", f"element {row} is not a finite number")
        return stored
    document.charge(stored.size * 8, f"accessors[{index}]")
    return normalized(stored) if document.gltf.accessors[index].normalized else stored.astype(np.float64)


def as_floats(document: Document, stored: NDArray[Any], index: int) -> NDArray[np.float64]:
    """Return the elements of accessor `index` as finite float64, normalized integers mapped."""
    document.charge(stored.size * 8, f"accessors[{index}]")
    return as_reals(document, stored, index).astype(np.float64, copy=False)


def as_unit_floats(stored: NDArray[Any]) -> NDArray[np.float64]:
    """Return `stored` as float64, integers always mapped as normalized: colours, weights."""
    if stored.dtype.kind == "f":
        return stored.astype(np.float64)
    return normalized(stored)


def normalized(stored: NDArray[Any]) -> NDArray[np.float64]:
    """Map the range of an integer type to [0, 1], or to [-1, 1] where it has a sign."""
    elements: NDArray[np.float64] = np.maximum(stored / np.float64(np.iinfo(stored.dtype).max), -1.0)
    return elements


def refuse_broken_parts(document: Document) -> None:
    """Read all accessors and all buffers, used or not; raise AssetError where one contradicts itself or the file."""
    for index, accessor in enumerate(document.gltf.accessors):
        place = f"accessors[{index}]"
        if accessor.buffer_view is None and accessor.byte_offset is not None:
            raise document.error(place, "has a byteOffset and no bufferView to count it in")
        read_accessor(document, index, place, {accessor.type})
    for index in range(len(document.gltf.buffers)):
        document.buffer(index)


def _strided(
    document: Document, source: Accessor | SparseIndices | SparseValues, count: int, layout: Layout, place: str
) -> NDArray[Any]:
    """Return `count` elements of a buffer view; packed elements are not copied."""
    assert source.buffer_view is not None
    view = document.item(document.gltf.buffer_views, source.buffer_view, f"{place}.bufferView", "buffer view")
    stride = view.byte_stride or layout.element_bytes
    if stride < layout.element_bytes:
        raise document.error(place, f"elements of {layout.element_bytes} bytes in a buffer view of stride {stride}")
    data = document.view(source.buffer_view, f"{place}.bufferView")
    offset = source.byte_offset or 0
    end = offset + stride * (count - 1) + layout.element_bytes
    if end > len(data):
        raise document.error(place, f"{count} elements end at byte {end} of a buffer view of {len(data)}")
    shape = (count, layout.columns, layout.rows)
    strides = (stride, layout.column_bytes, layout.dtype.itemsize)
    elements: NDArray[Any] = np.ndarray(shape, layout.dtype, data, offset, strides)
    return elements.reshape(count, layout.components)


def _patched(document: Document, sparse: Sparse, base: NDArray[Any], layout: Layout, place: str) -> NDArray[Any]:
    """Return `base` with the elements of `sparse` replaced."""
    if sparse.count > len(base):
        raise document.error(place, f"replaces {sparse.count} of {len(base)} elements")
    scalar = Layout(_DTYPES[sparse.indices.component_type], 1, 1)
    rows = _strided(document, sparse.indices, sparse.count, scalar, f"{place}.indices")[:, 0]
    if int(rows.max()) >= len(base):
        raise document.error(f"{place}.indices", f"index {int(rows.max())} of {len(base)} elements")
    patched = base.copy()
    patched[rows] = _strided(document, sparse.values, sparse.count, layout, f"{place}.values")
    return patched
