"""Validation of the parts that a file without visible triangles does not use: they may tell why nothing is visible."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.formats.gltf.accessors import read_accessor

if TYPE_CHECKING:
    from voxrt.voxelize.formats.gltf.document import Document


def refuse_broken_parts(document: Document) -> None:
    """Read all accessors and all buffers, used or not; raise AssetError where one contradicts itself or the file."""
    for index, accessor in enumerate(document.gltf.accessors):
        place = f"accessors[{index}]"
        if accessor.buffer_view is None and accessor.byte_offset is not None:
            raise document.error(place, "has a byteOffset and no bufferView to count it in")
        read_accessor(document, index, place, {accessor.type})
    for index in range(len(document.gltf.buffers)):
        document.buffer(index)
