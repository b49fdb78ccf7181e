"""The node hierarchy: visible nodes in authored order, and the transforms of all nodes.

Source: Khronos, glTF 2.0 specification, section 3.5.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from voxrt.voxelize.formats.gltf.accessors import read_floats
from voxrt.voxelize.formats.gltf.extensions import INSTANCING, VISIBILITY
from voxrt.voxelize.formats.gltf.schema import Instances, Visibility

if TYPE_CHECKING:
    from collections.abc import Container, Iterator

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.document import Document


class Hierarchy(Struct, frozen=True, eq=False):
    """The transforms and the visible nodes of a file."""

    shown: tuple[int, ...]  # the visible nodes of the scene, parents before children, siblings in authored order
    # float64, shape (N, 4, 4): frame of each node of the file to the scene frame. May mirror.
    transforms: NDArray[np.float64]


def place_nodes(document: Document) -> Hierarchy:
    """Return the transforms of all nodes, and the visible nodes of the file's scene.

    The scene is the file's default scene, else its first. A file without scenes shows every root node. Raise AssetError
    where the hierarchy is not a forest, or a transform is not affine and finite.
    """
    nodes = document.gltf.nodes
    parents = _parents(document)
    document.charge(len(nodes) * 1024, "nodes")
    transforms = _local_transforms(document)
    with np.errstate(over="ignore", invalid="ignore"):
        for index in _descendants(document, [index for index in range(len(nodes)) if index not in parents]):
            if index in parents:
                transforms[index] = transforms[parents[index]] @ transforms[index]
    lost = np.flatnonzero(~np.isfinite(transforms).all(axis=(1, 2)))
    if len(lost):
        raise document.error(f"nodes[{lost[0]}]", "the transform overflows")
    hidden = {index for index in range(len(nodes)) if _is_hidden(document, index)}
    shown = _descendants(document, _roots(document, parents), hidden)
    return Hierarchy(tuple(shown), transforms)


def _descendants(document: Document, roots: list[int], hidden: Container[int] = ()) -> Iterator[int]:
    """Yield `roots` and their descendants, parents before children, in authored order.

    Nodes that are `hidden` are left out with their descendants.
    """
    pending = roots[::-1]
    while pending:
        index = pending.pop()
        if index not in hidden:
            yield index
            pending.extend(reversed(document.gltf.nodes[index].children))


def _is_hidden(document: Document, index: int) -> bool:
    node = document.gltf.nodes[index]
    visibility = document.extension(node, VISIBILITY, Visibility, f"nodes[{index}]")
    return visibility is not None and not visibility.visible


def _parents(document: Document) -> dict[int, int]:
    """Return the parent of each node that has one."""
    parents: dict[int, int] = {}
    for index, node in enumerate(document.gltf.nodes):
        for at, child in enumerate(node.children):
            place = f"nodes[{index}].children[{at}]"
            document.item(document.gltf.nodes, child, place, "node")
            if child in parents:
                raise document.error(place, f"node {child} already has a parent, node {parents[child]}")
            parents[child] = index
    _refuse_cycles(document, parents)
    return parents


def _refuse_cycles(document: Document, parents: dict[int, int]) -> None:
    above: set[int] = set()
    for start in parents:
        path: set[int] = set()
        node = start
        while node in parents and node not in above:
            if node in path:
                raise document.error(f"nodes[{node}]", "the node is its own ancestor")
            path.add(node)
            node = parents[node]
        above |= path


def _roots(document: Document, parents: dict[int, int]) -> list[int]:
    gltf = document.gltf
    if gltf.scene is None and not gltf.scenes:
        if gltf.nodes:
            document.log.add("no-scene", "the file has no scene: all its root nodes are shown")
        return [index for index in range(len(gltf.nodes)) if index not in parents]
    number = gltf.scene or 0
    scene = document.item(gltf.scenes, number, "scene", "scene")
    others = len(gltf.scenes) - 1
    if others:
        which = "the default scene" if gltf.scene is not None else "the first scene, as the file names no default,"
        document.log.add("other-scenes", f"only {which} is shown: the other scenes of the file were left out", others)
    for at, root in enumerate(scene.nodes):
        document.item(gltf.nodes, root, f"scenes[{number}].nodes[{at}]", "node")
    listed = dict.fromkeys(scene.nodes)
    if len(listed) != len(scene.nodes):
        document.log.add("repeated-root", "nodes that the scene lists twice are shown once")
    # glTF allows roots only, but some exporters list the child of a helper node.
    inner = sum(root in parents for root in listed)
    if not inner:
        return list(listed)
    message = "nodes that the scene lists although they have a parent are shown"
    document.log.add("not-a-root", message, inner)
    below: set[int] = set()
    for index in _descendants(document, [index for index in range(len(gltf.nodes)) if index not in parents]):
        if index in parents and (parents[index] in listed or parents[index] in below):
            below.add(index)
    return [root for root in listed if root not in below]


def _local_transforms(document: Document) -> NDArray[np.float64]:
    """Return the transform of each node of the file in its parent's frame, float64, shape (N, 4, 4)."""
    nodes = document.gltf.nodes
    translations = np.array([node.translation or (0.0, 0.0, 0.0) for node in nodes]).reshape(-1, 3)
    rotations = np.array([node.rotation or (0.0, 0.0, 0.0, 1.0) for node in nodes]).reshape(-1, 4)
    scales = np.array([node.scale or (1.0, 1.0, 1.0) for node in nodes]).reshape(-1, 3)
    transforms = compose(document, translations, rotations, scales, "nodes[{}].rotation")
    for index, node in enumerate(nodes):
        if node.matrix is None:
            continue
        if (node.translation, node.rotation, node.scale) != (None, None, None):
            problem = "has a matrix and translation, rotation or scale as well"
            raise document.error(f"nodes[{index}]", problem)
        matrix = np.array(node.matrix).reshape(4, 4).T
        if np.abs(matrix[3] - (0, 0, 0, 1)).max() > 1e-6:
            raise document.error(f"nodes[{index}].matrix", "is not affine: its last row must be 0, 0, 0, 1")
        transforms[index, :3] = matrix[:3]
    return transforms


def compose(
    document: Document,
    translation: NDArray[np.float64],
    rotation: NDArray[np.float64],
    scale: NDArray[np.float64],
    place: str,
) -> NDArray[np.float64]:
    """Return the transforms, shape (N, 4, 4), that scale, then rotate by quaternions (x, y, z, w), then translate.

    `place` is the JSON path of the rotations, with braces for the number of one.
    """
    with np.errstate(over="ignore", under="ignore"):
        length = np.sqrt((rotation**2).sum(axis=1))
    wrong = np.flatnonzero(~((length > 1e-6) & (length < 1e6)))
    if len(wrong):
        problem = f"a quaternion of length {length[wrong[0]]:g}, it must be 1"
        raise document.error(place.format(wrong[0]), problem)
    uneven = np.abs(length - 1.0) > 1e-3
    if uneven.any():
        document.log.add("rotation-length", "quaternions whose length is not 1 were normalized", int(uneven.sum()))
    x, y, z, w = (rotation / length[:, None]).T
    transforms = np.tile(np.eye(4), (len(length), 1, 1))
    turn = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    transforms[:, :3, :3] = np.moveaxis(np.array(turn), -1, 0) * scale[:, None, :]
    transforms[:, :3, 3] = translation
    return transforms


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
