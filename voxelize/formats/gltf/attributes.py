"""The vertices and corners of a primitive, plain or compressed.

Source: Khronos, KHR_draco_mesh_compression; the decoding is DracoPy's.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.voxelize.formats.gltf.accessors import as_floats, as_reals, layout_of, read_accessor
from voxrt.voxelize.formats.gltf.extensions import DRACO
from voxrt.voxelize.formats.gltf.schema import TRIANGLE_STRIP, TRIANGLES, DracoPrimitive

if TYPE_CHECKING:
    from collections.abc import Container

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.schema import Accessor, Primitive


_DRACO_FLOATS = (9, 10)


class Attributes:
    """The vertices and corners of one primitive, whose JSON path is `place`."""

    def __init__(self, document: Document, primitive: Primitive, place: str) -> None:
        self._document = document
        self._primitive = primitive
        self.place = place
        self._compressed = document.extension(primitive, DRACO, DracoPrimitive, place)
        self._decoded: Any = None

    def __contains__(self, name: str) -> bool:
        return name in self._primitive.attributes

    @property
    def is_compressed(self) -> bool:
        """Whether the corners are a list of triangles, whatever the primitive's mode."""
        return self._compressed is not None

    def floats(self, name: str, types: Container[str]) -> NDArray[np.float64]:
        """Read attribute `name` as finite float64, shape (vertices, components), normalized integers mapped."""
        accessor = self._primitive.attributes[name]
        return as_floats(self._document, self.stored(name, types), accessor)

    def reals(self, name: str, types: Container[str]) -> NDArray[np.floating]:
        """Read attribute `name` as :meth:`floats` does; float32 stays float32."""
        return as_reals(self._document, self.stored(name, types), self._primitive.attributes[name])

    def stored(self, name: str, types: Container[str]) -> NDArray[Any]:
        """Read attribute `name` as it is stored, shape (vertices, components)."""
        accessor = self._primitive.attributes[name]
        place = f"{self.place}.attributes.{name}"
        if self._compressed is None or name not in self._compressed.attributes:
            return read_accessor(self._document, accessor, place, types)
        declared = self._document.item(self._document.gltf.accessors, accessor, place, "accessor")
        number = self._compressed.attributes[name]
        for attribute in self._mesh().attributes:
            if attribute["unique_id"] == number:
                return self._declared(attribute, declared, place, types)
        raise self._document.error(place, f"there is no compressed attribute {number}")

    def _declared(
        self, attribute: dict[str, Any], declared: Accessor, place: str, types: Container[str]
    ) -> NDArray[Any]:
        """Return a decoded attribute in its accessor's type; DracoPy converts integers to floats."""
        layout = layout_of(declared)
        data: NDArray[Any] = np.asarray(attribute["data"]).reshape(-1, attribute["num_components"])
        is_float = attribute["data_type"] in _DRACO_FLOATS
        if declared.type not in types or data.shape != (declared.count, layout.components):
            problem = f"{data.shape[0]} x {data.shape[1]} numbers for an accessor of {declared.count} {declared.type}"
            raise self._document.error(place, problem)
        if is_float != (layout.dtype.kind == "f"):
            raise self._document.error(place, f"compressed as another type than {layout.dtype.name}")
        return data.astype(layout.dtype)

    def corners(self) -> NDArray[Any] | None:
        """Return the vertex of each corner, unsigned, shape (N,), or None where the vertices are in order."""
        if self._compressed is not None:
            corners: NDArray[Any] = np.asarray(self._mesh().faces).reshape(-1)
            return corners
        if self._primitive.indices is None:
            return None
        place = f"{self.place}.indices"
        stored = read_accessor(self._document, self._primitive.indices, place, {"SCALAR"})[:, 0]
        if stored.dtype.kind != "u":
            raise self._document.error(place, f"indices of type {stored.dtype.name}, they must be unsigned integers")
        return stored

    def _mesh(self) -> Any:  # noqa: ANN401 -- DracoPy has no types
        if self._decoded is None:
            assert self._compressed is not None
            place = f"{self.place}.extensions.{DRACO}"
            if self._primitive.mode not in (TRIANGLES, TRIANGLE_STRIP):
                raise self._document.error(place, "compressed primitives must be triangles or strips")
            data = bytes(self._document.view(self._compressed.buffer_view, f"{place}.bufferView"))
            import DracoPy  # noqa: PLC0415 -- few files need it, and it is large

            try:
                self._decoded = DracoPy.decode(data)
            except (DracoPy.FileTypeException, ValueError, RuntimeError, MemoryError) as error:
                raise self._document.error(place, "the Draco data cannot be decoded") from error
            if not hasattr(self._decoded, "faces"):
                raise self._document.error(place, "the Draco data is a point cloud, not a mesh")
            self._document.charge(self._decoded.faces.nbytes, place)
        return self._decoded
