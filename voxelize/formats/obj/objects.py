"""Which faces form one object."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.obj.statements import Statements


def split_objects(
    stem: str, statements: Statements, triangles: NDArray[np.int32], faces: NDArray[np.int64]
) -> Iterator[tuple[str, NDArray[np.int64]]]:
    """Split a file's triangles into objects, in order of their first faces.

    Each ``o`` starts an object. Each ``g`` names a set, which a later ``g`` of the same name continues. `stem` names
    objects without a name. `triangles`, int32, shape (T, 3), are rows of the positions, and `faces`, int64, shape (T,),
    the face of each. Yield unique names, and the triangles of each (int64, ascending).
    """
    if statements.objects:
        part, names = _parts(statements.objects, statements.face_lines[faces])
    else:
        part, names = _parts(statements.groups, statements.face_lines[faces])
        part = _by_name(part, names)
        part = _by_shared_vertices(part, len(names), triangles, len(statements.positions))
    order = np.argsort(part, kind="stable")
    present, begins = np.unique(part[order], return_index=True)
    ends = np.append(begins[1:], len(order))
    used: set[str] = set()
    for index, begin, end in sorted(
        zip(present.tolist(), begins.tolist(), ends.tolist(), strict=True), key=lambda piece: order[piece[1]]
    ):
        name, number = names[index] or stem, 2
        while name in used:
            name, number = f"{names[index] or stem} ({number})", number + 1
        used.add(name)
        yield name, order[begin:end]


def _parts(statements: tuple[tuple[int, str], ...], lines: NDArray[np.int64]) -> tuple[NDArray[np.int64], list[str]]:
    """Return the last statement before each line (0 for none), and the names of the statements."""
    starts = np.array([line for line, _ in statements], dtype=np.int64)
    return np.searchsorted(starts, lines), ["", *(name for _, name in statements)]


def _by_name(part: NDArray[np.int64], names: list[str]) -> NDArray[np.int64]:
    first: dict[str, int] = {}
    return np.array([first.setdefault(name, index) for index, name in enumerate(names)])[part]


def _by_shared_vertices(
    part: NDArray[np.int64], parts: int, triangles: NDArray[np.int32], vertices: int
) -> NDArray[np.int64]:
    """Merge parts that share a vertex, by a disjoint-set forest with path halving."""
    if not part.any() or (part == part[0]).all():
        return part
    corners = triangles.ravel()
    owners = np.repeat(part, 3)
    lowest = np.full(vertices, parts, dtype=np.int64)
    np.minimum.at(lowest, corners, owners)
    differs = lowest[corners] != owners
    pairs = np.unique(np.stack([lowest[corners[differs]], owners[differs]], axis=1), axis=0)
    parent = list(range(parts))

    def root(item: int) -> int:
        while parent[item] != item:
            parent[item] = parent[parent[item]]
            item = parent[item]
        return item

    for one, other in pairs.tolist():
        low, high = sorted((root(one), root(other)))
        parent[high] = low
    return np.array([root(item) for item in range(parts)])[part]


def compact(
    positions: NDArray[np.float64], triangles: NDArray[np.int32]
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Return the vertices that `triangles` use, in the file's order, and the triangles as rows of those."""
    low, high = int(triangles.min()), int(triangles.max()) + 1
    used = np.zeros(high - low, dtype=bool)
    used[triangles - low] = True
    if used.all():
        return positions[low:high], triangles - np.int32(low)
    row = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return positions[low:high][used], row[triangles - low]
