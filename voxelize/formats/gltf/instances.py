"""EXT_mesh_gpu_instancing: one node that shows its mesh several times."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.formats.gltf.accessors import read_floats
from voxrt.voxelize.formats.gltf.extensions import INSTANCING
from voxrt.voxelize.formats.gltf.nodes import compose
from voxrt.voxelize.formats.gltf.schema import Instances

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.document import Document


def read_instances(document: Document, index: int) -> NDArray[np.float64] | None:
    """Return the transforms of the instances of node `index` in its frame, float64, shape (N, 4, 4).

    None where the node is not instanced.
    """
    place = f"nodes[{index}]"
    instances = document.extension(document.gltf.nodes[index], INSTANCING, Instances, place)
    if instances is None:
        return None
    here = f"{place}.extensions.{INSTANCING}.attributes"
    parts: dict[str, NDArray[np.float64]] = {}
    for name, kind in (("TRANSLATION", "VEC3"), ("ROTATION", "VEC4"), ("SCALE", "VEC3")):
        if name in instances.attributes:
            parts[name] = read_floats(document, instances.attributes[name], f"{here}.{name}", {kind})
    if not parts:
        document.log.add("instancing", "instanced nodes without instance transforms are shown once")
        return None
    count = len(next(iter(parts.values())))
    if any(len(part) != count for part in parts.values()):
        sizes = ", ".join(f"{name} {len(part)}" for name, part in parts.items())
        raise document.error(here, f"different numbers of instances: {sizes}")
    document.charge(count * 1024, here)
    return compose(
        document,
        parts.get("TRANSLATION", np.zeros((count, 3))),
        parts.get("ROTATION", np.tile((0.0, 0.0, 0.0, 1.0), (count, 1))),
        parts.get("SCALE", np.ones((count, 3))),
        f"{here}.ROTATION[{{}}]",
    )
