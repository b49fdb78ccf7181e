"""The node listing that the original's authoring script printed, so that scenes made with it are not lost.

One line per node, breadth-first, the root first::

    Node 0: Material ID = None, MID1 = False, First Child Index = 1
    Node 1: Material ID = Red (Instance), MID1 = False
    Node 2: Material ID = None, MID1 = True

A node with a first child has eight, in the order x = 4, y = 2, z = 1. A leaf without material is empty space, or, where
MID1 is true, an object to which nobody gave one. Coordinates stay as they are: no axis is swapped or mirrored.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from voxrt.export.word_file import read_bytes
from voxrt.octree import Octree, Rom, RomError, decode, share
from voxrt.octree.words import leaf
from voxrt.voxelize import DEFAULT_COLOUR, EMPTY, MATERIAL_LIMIT, Material

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

_LINE = re.compile(
    r"\s*Node (\d{1,9}): Material ID = (.+?), MID1 = (True|False)(?:, First Child Index = (\d{1,9}))?\s*"
)
_INSTANCE = " (Instance)"
_LEAF_NODE = -1


def read_listing(path: Path, colours: Mapping[str, tuple[int, int, int]], depth: int | None = None) -> Rom:
    r"""Read a node listing.

    Parameters
    ----------
    path
        The file.
    colours
        sRGB by the author's name of each material, without " (Instance)". Their order gives the ids 1, 2, ….
    depth
        Levels of the world; None takes the least that the listing needs.

    Raises
    ------
    RomError
        A line is none of a listing, a child is missing, or a material has no colour. The message names the line.

    Examples
    --------
    >>> from pathlib import Path
    >>> empty = "Material ID = None, MID1 = False"
    >>> lines = [f"Node 0: {empty}, First Child Index = 1", *(f"Node {n}: {empty}" for n in range(1, 8))]
    >>> path = Path("scene.txt")
    >>> _ = path.write_text("\n".join([*lines, "Node 8: Material ID = Roof (Instance), MID1 = False"]))
    >>> read_listing(path, {"Roof": (214, 84, 56)})
    <Rom 'scene': depth 1, 9 words, 1 material>
    """
    text = read_bytes(path).decode("utf-8", "replace")
    materials = _Materials(path, colours)
    leaves: list[int] = []
    first_children: list[int] = []
    lines: list[int] = []
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip():
            continue
        match = _LINE.fullmatch(line)
        if match is None or int(match[1]) != len(lines):
            raise RomError(f"{path}: line {number}: is not 'Node {len(lines)}: Material ID = ...'; name a node listing")
        child = match[4]
        leaves.append(materials.of_leaf(number, match[2], match[3] == "True") if child is None else 0)
        first_children.append(_LEAF_NODE if child is None else int(child))
        lines.append(number)
    octree = _octree(path, np.array(leaves), np.array(first_children), lines, depth)
    return Rom(path.stem, octree, tuple(materials.table))


class _Materials:
    """The materials of a listing; the default one joins when a leaf needs it."""

    def __init__(self, path: Path, colours: Mapping[str, tuple[int, int, int]]) -> None:
        self._path = path
        self._ids = {name: i for i, name in enumerate(colours, start=1)}
        self._default: int | None = None
        self.table = [EMPTY, *(Material(name, colour) for name, colour in colours.items())]

    def of_leaf(self, line: int, name: str, mid1: bool) -> int:
        if name == "None" and not mid1:
            return 0
        if name == "None":
            if self._default is None:
                self._default = len(self.table)
                self.table.append(Material("default", DEFAULT_COLOUR, authored=False))
            material: int | None = self._default
        else:
            material = self._ids.get(name.removesuffix(_INSTANCE))
        if material is None:
            known = ", ".join(list(self._ids)[:8]) or "none"
            raise RomError(f"{self._path}: line {line}: material {name!r} has no colour; give it one (known: {known})")
        if material > MATERIAL_LIMIT:
            raise RomError(f"{self._path}: line {line}: more than {MATERIAL_LIMIT} materials; give fewer colours")
        return material


def _octree(
    path: Path, leaves: NDArray[np.int64], first_children: NDArray[np.int64], lines: list[int], depth: int | None
) -> Octree:
    """Words in the order of the listing, its nodes in blocks of eight; then shared."""
    parents = first_children != _LEAF_NODE
    wrong = np.flatnonzero(parents & ((first_children % 8 != 1) | (first_children > len(leaves) - 8)))
    if len(wrong) or len(leaves) % 8 != 1:
        where = f"line {lines[wrong[0]]}: eight children are not there" if len(wrong) else "the last nodes are missing"
        raise RomError(f"{path}: {where}; the listing is cut short or damaged")
    words = np.where(parents, first_children, leaf(leaves.astype(np.uint32))).astype(np.uint32)
    # The listing has x = 4, z = 1; a block has x = 1, z = 4.
    order = [0, 4, 2, 6, 1, 5, 3, 7]
    words[1:] = words[1:].reshape(-1, 8)[:, order].ravel()
    places = np.array(lines)
    places[1:] = places[1:].reshape(-1, 8)[:, order].ravel()
    return share(decode(words, "report", depth, source=str(path), lines=places))
