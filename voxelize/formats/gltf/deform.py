"""Morph targets and skins: the vertices of a mesh in a pose.

Source: Khronos, glTF 2.0 specification, sections 3.7.2.2 (morph targets) and 3.7.3 (skins).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import Struct

from voxrt.voxelize.formats.gltf.accessors import as_unit_floats, read_floats

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.attributes import Attributes
    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.schema import Primitive


class Pose(Struct, frozen=True, eq=False):
    """The deformation of a mesh."""

    weights: tuple[float, ...] = ()  # the weight of each morph target
    # float64, shape (J, 4, 4): bind pose to scene frame, per joint; None for a mesh without skin.
    joints: NDArray[np.float64] | None = None


def is_deformed(primitive: Primitive, pose: Pose) -> bool:
    """Tell whether a pose moves the vertices of a primitive against one another."""
    moved = zip(pose.weights, primitive.targets, strict=False)
    return pose.joints is not None or any(weight != 0.0 and "POSITION" in target for weight, target in moved)


def morphed(
    document: Document, primitive: Primitive, positions: NDArray[np.floating], pose: Pose, place: str
) -> NDArray[np.floating]:
    """Return `positions`, shape (V, 3), with the weighted displacements of the morph targets added."""
    for at, (weight, target) in enumerate(zip(pose.weights, primitive.targets, strict=False)):
        if weight == 0.0 or "POSITION" not in target:
            continue
        here = f"{place}.targets[{at}].POSITION"
        moved = read_floats(document, target["POSITION"], here, {"VEC3"})
        if len(moved) != len(positions):
            raise document.error(here, f"moves {len(moved)} of {len(positions)} vertices")
        with np.errstate(over="ignore", invalid="ignore"):
            positions = _finite(document, positions + weight * moved, place)
    return positions


def skinned(
    document: Document, attributes: Attributes, positions: NDArray[np.floating], pose: Pose, place: str
) -> NDArray[np.floating]:
    """Return `positions`, shape (V, 3), moved by the joints of `pose` to the scene frame."""
    if pose.joints is None:
        return positions
    document.charge(positions.nbytes * 8, place)
    total = np.zeros((len(positions), 1))
    carried = np.zeros(positions.shape)
    number = 0
    with np.errstate(over="ignore", invalid="ignore"):
        while f"JOINTS_{number}" in attributes and f"WEIGHTS_{number}" in attributes:
            joints, weights = _influences(document, attributes, number, (len(positions), len(pose.joints)))
            for column in range(4):
                matrices = pose.joints[joints[:, column]]
                moved = np.einsum("vij,vj->vi", matrices[:, :3, :3], positions) + matrices[:, :3, 3]
                carried += weights[:, column, None] * moved
            total += weights.sum(axis=1, keepdims=True)
            number += 1
        bare = total[:, 0] <= 0.0
        if bare.any():
            document.log.add("skin", "vertices without joints were attached to the first joint", int(bare.sum()))
            carried[bare] = positions[bare] @ pose.joints[0, :3, :3].T + pose.joints[0, :3, 3]
            total[bare] = 1.0
        carried /= total
    return _finite(document, carried, place)


def _influences(
    document: Document, attributes: Attributes, number: int, counts: tuple[int, int]
) -> tuple[NDArray[Any], NDArray[np.float64]]:
    """Read set `number` of joints and weights, shape (V, 4) each, of a primitive; `counts` has vertices and joints."""
    joints = attributes.stored(f"JOINTS_{number}", {"VEC4"})
    weights = attributes.stored(f"WEIGHTS_{number}", {"VEC4"})
    here = f"{attributes.place}.attributes"
    vertices, limit = counts
    if len(joints) != vertices or len(weights) != vertices:
        problem = f"{len(joints)} joints and {len(weights)} weights for {vertices} vertices"
        raise document.error(f"{here}.JOINTS_{number}", problem)
    share = as_unit_floats(weights)
    if not (np.isfinite(share).all() and (share >= 0).all()):
        raise document.error(f"{here}.WEIGHTS_{number}", "a weight is negative or not a number")
    if joints.dtype.kind != "u":
        raise document.error(
            f"{here}.JOINTS_{number}", f"joints of type {joints.dtype.name}, they must be unsigned integers"
        )
    # Unused influences may have any joint.
    used = np.where(share > 0, joints, 0)
    if int(used.max()) >= limit:
        raise document.error(f"{here}.JOINTS_{number}", f"joint {int(used.max())} of a skin that has {limit}")
    return used, share


def _finite(document: Document, positions: NDArray[np.float64], place: str) -> NDArray[np.float64]:
    if not np.isfinite(positions).all():
        raise document.error(place, "the vertices overflow")
    return positions


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
