"""The node hierarchy: which nodes are shown, in authored order, and where they stand.

Source: Khronos, glTF 2.0 specification, section 3.5.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Container

    from numpy.typing import NDArray

    from voxrt.voxelize.gltf.document import Document
    from voxrt.voxelize.gltf.schema import Node


@dataclass(frozen=True, eq=False, slots=True)
class PlacedNode:
    """A node that the scene shows.

    Attributes
    ----------
    index
        Its place in the file's list of nodes.
    transform
        float64, shape (4, 4): node frame to scene frame. May mirror.
    """

    index: int
    transform: NDArray[np.float64]


def place_nodes(document: Document) -> list[PlacedNode]:
    """Return the nodes of the file's scene, parents before children, siblings in authored order.

    The scene is the one the file names, else its first; where the file has none, every root node is shown.

    Raises
    ------
    AssetError
        The hierarchy is not a forest, or a transform is not affine and finite.
    """
    nodes = document.gltf.nodes
    parents = _parents(document)
    placed: list[PlacedNode] = []
    pending = [(root, _frame(document, root, parents)) for root in reversed(_roots(document, parents))]
    while pending:
        index, frame = pending.pop()
        document.charge(1024, f"nodes[{index}]")
        with np.errstate(over="ignore", invalid="ignore"):
            transform = frame @ local_transform(document, nodes[index], f"nodes[{index}]")
        if not np.isfinite(transform).all():
            raise document.error(f"nodes[{index}]", "the transform leaves the range of numbers")
        placed.append(PlacedNode(index, transform))
        pending.extend((child, transform) for child in reversed(nodes[index].children))
    return placed


def _frame(document: Document, root: int, parents: dict[int, int]) -> NDArray[np.float64]:
    """Return the frame in which `root` stands: the scene's, unless it has ancestors that the scene does not list."""
    frame = np.eye(4)
    node = root
    while node in parents:
        node = parents[node]
        with np.errstate(over="ignore", invalid="ignore"):
            frame = local_transform(document, document.gltf.nodes[node], f"nodes[{node}]") @ frame
    return frame


def _parents(document: Document) -> dict[int, int]:
    """Map each node that has a parent to it."""
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
            document.warn("no-scene", "the file has no scene: all its root nodes are shown")
        return [index for index in range(len(gltf.nodes)) if index not in parents]
    number = gltf.scene or 0
    scene = document.item(gltf.scenes, number, "scene", "scene")
    others = len(gltf.scenes) - 1
    if others:
        which = "the default scene" if gltf.scene is not None else "the first scene, as the file names no default,"
        document.warn("other-scenes", f"only {which} is shown: the other scenes of the file were left out", others)
    for at, root in enumerate(scene.nodes):
        document.item(gltf.nodes, root, f"scenes[{number}].nodes[{at}]", "node")
    listed = dict.fromkeys(scene.nodes)
    if len(listed) != len(scene.nodes):
        document.warn("repeated-root", "nodes that the scene lists twice are shown once")
    return [root for root in listed if not _shown_by_ancestor(document, root, listed, parents)]


def _shown_by_ancestor(document: Document, root: int, listed: Container[int], parents: dict[int, int]) -> bool:
    """Tell whether the scene shows `root` already as a descendant of another node that it lists.

    glTF allows roots only, but some exporters list the child of a helper node.
    """
    if root not in parents:
        return False
    document.warn("not-a-root", "nodes that the scene lists although they have a parent are shown where it puts them")
    ancestor = root
    while ancestor in parents:
        ancestor = parents[ancestor]
        if ancestor in listed:
            return True
    return False


def local_transform(document: Document, node: Node, place: str) -> NDArray[np.float64]:
    """Return the transform of `node` in its parent's frame, float64, shape (4, 4)."""
    if node.matrix is not None:
        if (node.translation, node.rotation, node.scale) != (None, None, None):
            raise document.error(place, "has a matrix and translation, rotation or scale as well")
        matrix = np.array(node.matrix).reshape(4, 4).T
        if not np.allclose(matrix[3], (0, 0, 0, 1), rtol=0, atol=1e-6):
            raise document.error(f"{place}.matrix", "is not affine: its last row must be 0, 0, 0, 1")
        matrix[3] = (0, 0, 0, 1)
        return matrix
    translation = np.array(node.translation or (0.0, 0.0, 0.0))
    scale = np.array(node.scale if node.scale is not None else (1.0, 1.0, 1.0))
    return compose(document, translation, np.array(node.rotation or (0.0, 0.0, 0.0, 1.0)), scale, place)


def compose(
    document: Document,
    translation: NDArray[np.float64],
    rotation: NDArray[np.float64],
    scale: NDArray[np.float64],
    place: str,
) -> NDArray[np.float64]:
    """Return the transform that scales, then rotates by the quaternion (x, y, z, w), then translates."""
    with np.errstate(over="ignore", under="ignore"):
        length = float(np.linalg.norm(rotation))
    if not 1e-6 < length < 1e6:
        raise document.error(f"{place}.rotation", f"a quaternion of length {length:g}, it must be 1")
    if abs(length - 1.0) > 1e-3:
        document.warn("rotation-length", "quaternions whose length is not 1 were brought to it")
    x, y, z, w = rotation / length
    transform = np.eye(4)
    transform[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    transform[:3, :3] *= scale
    transform[:3, 3] = translation
    return transform
