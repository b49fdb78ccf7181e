"""Loading MagicaVoxel scenes as coloured voxels, with every instance of every model.

MagicaVoxel's z is up; ours is y. Voxel (x, y, z) of the file goes to (x, z, -y), a rotation, so nothing is mirrored.
"""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from voxrt.voxelize.errors import AssetError, DoesNotFitError, SceneWarning
from voxrt.voxelize.formats.vox.chunks import Group, Shape, Transform, read_chunks
from voxrt.voxelize.materials import EMPTY, Material

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.vox.chunks import Vector, VoxFile

_VOXEL_LIMIT = 1 << 25
_INSTANCE_LIMIT = 1 << 16
_NESTING_LIMIT = 256
_FIRST_FRAME = "only the first frame of what is animated is shown"
_IDENTITY = np.eye(3, dtype=np.int64)


class _Instance(Struct, frozen=True, eq=False):
    model: int
    rows: NDArray[np.int64]
    offset: NDArray[np.int64]


class VoxScene(Struct, frozen=True, eq=False):
    """The voxels of a MagicaVoxel file.

    Attributes
    ----------
    coordinates
        int64, shape (N, 3), y up, in voxels. Where instances overlap, a voxel is there more than once, and the first
        one counts.
    material_ids
        uint8, shape (N,): rows of `materials`.
    materials
        Empty space, then the colours in use, in the order of the file's palette.
    warnings
        What was ignored or replaced.
    """

    coordinates: NDArray[np.int64]
    material_ids: NDArray[np.uint8]
    materials: tuple[Material, ...]
    warnings: tuple[SceneWarning, ...]


def load_vox(path: Path | str, frame: int = 0) -> VoxScene:
    """Load a MagicaVoxel file. `frame` is a number of an old animation: models without a scene graph.

    Raises
    ------
    AssetError
        The file cannot be read, breaks the format, or holds no visible voxel.
    DoesNotFitError
        The scene holds more than 2**25 voxels.
    """
    path = Path(path)
    file = read_chunks(path)
    instances, skipped = _instances(path, file, frame)
    points, colours = _place(path, file, instances)
    used = np.unique(colours)
    materials = tuple(Material(f"colour {i}", _rgb(file, int(i))) for i in used)
    ids = (np.searchsorted(used, colours) + 1).astype(np.uint8)
    return VoxScene(points, ids, (EMPTY, *materials), (*skipped, *_plain_materials(file, used)))


def _instances(path: Path, file: VoxFile, frame: int) -> tuple[list[_Instance], list[SceneWarning]]:
    """Return the instances of the scene graph; without one, the models are frames, of which one is shown."""
    origin = np.zeros(3, dtype=np.int64)
    if not file.nodes:
        shown = [_Instance(min(frame, len(file.models) - 1), _IDENTITY, origin)] if file.models else []
        moving = len(file.models) > 1 and frame == 0
        return shown, [SceneWarning("vox-animation", _FIRST_FRAME, len(file.models) - 1)] if moving else []
    found: list[_Instance] = []
    skipped: Counter[str] = Counter()
    waiting: list[tuple[int, NDArray[np.int64], NDArray[np.int64], tuple[int, ...]]] = [(0, _IDENTITY, origin, ())]
    visited = 0
    while waiting:
        number, rows, offset, above = waiting.pop()
        node = file.nodes.get(number)
        visited += 1
        if node is None or number in above:
            problem = "is not there" if node is None else "holds itself"
            raise AssetError(path, problem, place=f"scene node {number}", fix="the file is damaged; save it again")
        if visited > _INSTANCE_LIMIT or len(above) > _NESTING_LIMIT:
            raise DoesNotFitError(
                f"more than {_INSTANCE_LIMIT} scene nodes, or {_NESTING_LIMIT} in one another; save fewer"
            )
        path_here = (*above, number)
        if isinstance(node, Transform):
            if node.hidden or node.layer in file.hidden_layers:
                skipped["hidden"] += 1
                continue
            skipped["animation"] += node.frames > 1
            local = np.array(node.rows, dtype=np.int64)
            waiting.append((node.child, rows @ local, rows @ np.array(node.offset) + offset, path_here))
        elif isinstance(node, Group):
            waiting.extend((child, rows, offset, path_here) for child in reversed(node.children))
        else:
            skipped["animation"] += len(node.models) > 1
            found.append(_Instance(_first_model(path, number, node, len(file.models)), rows, offset))
    messages = {"hidden": "nodes that the author hid are left out", "animation": _FIRST_FRAME}
    return found, [SceneWarning(f"vox-{kind}", messages[kind], skipped[kind]) for kind in messages if skipped[kind]]


def _first_model(path: Path, number: int, node: Shape, models: int) -> int:
    if not node.models or any(not 0 <= model < models for model in node.models):
        problem = f"shows no model of 0 ... {models - 1}"
        raise AssetError(path, problem, place=f"scene node {number}", fix="the file is damaged; save it again")
    return node.models[0]


def _place(path: Path, file: VoxFile, instances: list[_Instance]) -> tuple[NDArray[np.int64], NDArray[np.uint8]]:
    """Return all voxels: coordinates (int64, shape (N, 3), y up) and colour indices (uint8, shape (N,))."""
    total = sum(len(file.models[instance.model].voxels) for instance in instances)
    if total == 0:
        raise AssetError(path, "holds no visible voxel", fix="show at least one model")
    if total > _VOXEL_LIMIT:
        raise DoesNotFitError(f"{total} voxels, and {_VOXEL_LIMIT} are the most; save fewer instances")
    points, colours = [], []
    for instance in instances:
        model = file.models[instance.model]
        centred = 2 * (model.voxels[:, :3].astype(np.int64) - _pivot(model.size)) + 1  # voxel centres, half voxels
        placed = (centred @ instance.rows.T + 2 * instance.offset) >> 1
        points.append(np.stack([placed[:, 0], placed[:, 2], -1 - placed[:, 1]], axis=1))
        colours.append(model.voxels[:, 3])
    return np.concatenate(points), np.concatenate(colours)


def _pivot(size: Vector) -> NDArray[np.int64]:
    """Return the point of a model that its transform moves to the origin of the instance."""
    return np.array(size, dtype=np.int64) // 2


def _rgb(file: VoxFile, colour: int) -> tuple[int, int, int]:
    red, green, blue = (int(channel) for channel in file.palette[colour])
    return red, green, blue


def _plain_materials(file: VoxFile, used: NDArray[np.uint8]) -> list[SceneWarning]:
    kinds = Counter(file.material_types[int(colour)] for colour in used if int(colour) in file.material_types)
    if not kinds:
        return []
    named = ", ".join(sorted(kind.strip("_") for kind in kinds))
    return [SceneWarning("vox-material", f"{named} materials became plain colours", kinds.total())]
