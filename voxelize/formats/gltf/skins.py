"""Skins: the transforms of joints.

Source: Khronos, glTF 2.0 specification, section 3.7.3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.formats.gltf.accessors import read_floats

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.document import Document


def joint_matrices(document: Document, index: int, transforms: NDArray[np.float64], place: str) -> NDArray[np.float64]:
    """Return the transform of each joint from the bind pose to the scene frame: float64, shape (J, 4, 4).

    `transforms`, float64, shape (N, 4, 4), are those of the file's nodes. The JSON path `place` refers to the skin.
    """
    skin = document.item(document.gltf.skins, index, place, "skin")
    here = f"skins[{index}]"
    document.charge(len(skin.joints) * 256, here)
    for at, joint in enumerate(skin.joints):
        document.item(document.gltf.nodes, joint, f"{here}.joints[{at}]", "node")
    matrices = transforms[skin.joints]
    if skin.inverse_bind_matrices is None:
        return matrices
    bound = read_floats(document, skin.inverse_bind_matrices, f"{here}.inverseBindMatrices", {"MAT4"})
    if len(bound) < len(matrices):
        raise document.error(f"{here}.inverseBindMatrices", f"{len(bound)} matrices for {len(matrices)} joints")
    with np.errstate(over="ignore", invalid="ignore"):
        return matrices @ bound[: len(matrices)].reshape(-1, 4, 4).transpose(0, 2, 1)
