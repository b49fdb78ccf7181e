"""A glTF writer for tests: says exactly what it is told, right or wrong."""

from __future__ import annotations

import base64
import json
import struct

import numpy as np

COMPONENT = {"i1": 5120, "u1": 5121, "i2": 5122, "u2": 5123, "u4": 5125, "f4": 5126}
SHAPES = {(): "SCALAR", (2,): "VEC2", (3,): "VEC3", (4,): "VEC4", (2, 2): "MAT2", (3, 3): "MAT3", (4, 4): "MAT4"}


class GltfWriter:
    """Collects accessors and objects; `json` may be changed at will before saving."""

    def __init__(self):
        self.data = bytearray()
        self.json = {"asset": {"version": "2.0"}}

    def add(self, array, value):
        """Append `value` to the top-level `array` and return its index."""
        self.json.setdefault(array, []).append(value)
        return len(self.json[array]) - 1

    def view(self, data, stride=None):
        self.data += bytes(-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)}
        if stride is not None:
            view["byteStride"] = stride
        self.data += data
        return self.add("bufferViews", view)

    def accessor(self, values, dtype="f4", *, normalized=False, stride=None, offset=0, sparse=None):
        """Add elements (matrices as (columns, rows)), each `stride` bytes apart, the first at `offset`.

        `sparse` = (rows, elements, index dtype) replaces some of them; `values` = a count stands for zeros.
        """
        shape = np.shape(sparse[1])[1:] if isinstance(values, int) else np.shape(values)[1:]
        accessor = {"componentType": COMPONENT[dtype], "type": SHAPES[shape]}
        if isinstance(values, int):
            accessor["count"] = values
        else:
            accessor["count"] = len(values)
            packed = [_packed(element, dtype) for element in values]
            step = stride or len(packed[0])
            data = bytearray(b"\xaa" * (offset + step * (len(packed) - 1) + len(packed[0])))
            for at, element in enumerate(packed):
                data[offset + at * step : offset + at * step + len(element)] = element
            accessor["bufferView"] = self.view(bytes(data), stride)
            accessor["byteOffset"] = offset
        if normalized:
            accessor["normalized"] = True
        if sparse is not None:
            rows, elements, index_dtype = sparse
            indices = self.view(np.asarray(rows, f"<{index_dtype}").tobytes())
            replaced = self.view(b"".join(_packed(element, dtype) for element in elements))
            accessor["sparse"] = {
                "count": len(rows),
                "indices": {"bufferView": indices, "componentType": COMPONENT[index_dtype]},
                "values": {"bufferView": replaced},
            }
        return self.add("accessors", accessor)

    def mesh(self, positions, indices=None, *, mode=None, material=None, index_dtype="u2", **attributes):
        """Add a mesh of one primitive; attributes are accessor indices."""
        primitive = {"attributes": {"POSITION": self.accessor(positions), **attributes}}
        if indices is not None:
            primitive["indices"] = self.accessor(indices, index_dtype)
        if mode is not None:
            primitive["mode"] = mode
        if material is not None:
            primitive["material"] = material
        return self.add("meshes", {"primitives": [primitive]})

    def show(self, **node):
        """Add a root node to the default scene."""
        index = self.add("nodes", node)
        self.json.setdefault("scene", 0)
        self.json.setdefault("scenes", [{"nodes": []}])[0]["nodes"].append(index)
        return index

    def save(self, path):
        """Write a GLB, or a .gltf with inline data, by the suffix of `path`."""
        document = dict(self.json)
        if path.suffix == ".glb":
            if self.data:
                document["buffers"] = [{"byteLength": len(self.data)}]
            path.write_bytes(glb_of(json.dumps(document).encode(), self.data))
        else:
            if self.data:
                uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
                document["buffers"] = [{"byteLength": len(self.data), "uri": uri}]
            path.write_text(json.dumps(document))
        return path


def glb_of(text, binary=b""):
    """Return a GLB of JSON, and of a binary chunk where there is one."""
    chunks = [(b"JSON", _padded(text, b" "))]
    if binary:
        chunks.append((b"BIN\0", _padded(bytes(binary), b"\0")))
    return glb(chunks)


def glb(chunks):
    """Return a GLB of (kind, data) chunks."""
    body = b"".join(struct.pack("<I", len(data)) + kind + data for kind, data in chunks)
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def _packed(element, dtype):
    """Bytes of one element: columns of matrices start at multiples of 4 bytes."""
    array = np.asarray(element, f"<{dtype}")
    if array.ndim < 2:
        return array.tobytes()
    return b"".join(_padded(column.tobytes(), b"\0") for column in array)


def _padded(data, filler):
    return data + filler * (-len(data) % 4)
