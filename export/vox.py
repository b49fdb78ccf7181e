"""Memories as MagicaVoxel scenes and back.

MagicaVoxel's z is up; ours is y. A voxel (x, y, z) of the memory is voxel (x, -z, y) of the file: a rotation, so
nothing is mirrored. Files hold models of at most 256 voxels per side, placed by a scene graph.
The format: https://github.com/ephtracy/voxel-model (MagicaVoxel-file-format-vox.txt, -extension.txt).
"""

from __future__ import annotations

import struct
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from voxrt.export.atomic import write_atomically
from voxrt.octree import MAX_DEPTH, Rom, from_points, solid_bounds, to_dense
from voxrt.voxelize import DoesNotFitError
from voxrt.voxelize.formats.vox import load_vox

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from voxrt.voxelize import SceneWarning

_MODEL = 256  # the most voxels per side of a model
_WORLD = 2048  # and of a scene
_VERSION = 150


def read_vox(path: Path | str) -> tuple[Rom, tuple[SceneWarning, ...]]:
    """Read a MagicaVoxel file.

    The world is the smallest cube that holds every visible instance; its lowest corner is that of their bounds. Where
    instances overlap, the first in the file wins. Materials are the colours in use, in the order of the palette.

    Returns
    -------
    rom
        The memory.
    warnings
        What the file says and was not honoured as it stands.

    Raises
    ------
    AssetError
        The file cannot be read, breaks the format, or holds no visible voxel.
    DoesNotFitError
        The scene is wider than 2**16 voxels, or holds more than 2**25.

    Examples
    --------
    >>> import voxrt
    >>> from pathlib import Path
    >>> write_vox(Path("house.vox"), voxrt.build("examples/house.obj", depth=4).rom)
    >>> read_vox("house.vox")[0]
    <Rom 'house': depth 4, 721 words, 5 materials>
    """
    path = Path(path)
    try:
        scene = load_vox(path)
    except DoesNotFitError as error:
        raise DoesNotFitError(f"{path}: {error}") from None
    low = scene.coordinates.min(axis=0)
    span = int((scene.coordinates.max(axis=0) - low).max()) + 1
    depth = max(1, (span - 1).bit_length())
    if depth > MAX_DEPTH:
        raise DoesNotFitError(
            f"{path}: {span} voxels from end to end do not fit depth {MAX_DEPTH}; move the parts closer"
        )
    tree = from_points(scene.coordinates - low, scene.material_ids, depth)
    return Rom(path.stem, tree, scene.materials), scene.warnings


def write_vox(path: Path, rom: Rom, high: tuple[int, int, int] | None = None) -> None:
    """Write the solid voxels of a memory as a MagicaVoxel scene; a material's id is its place in the palette.

    Parameters
    ----------
    path
        The file.
    rom
        The memory and its materials.
    high
        Only voxels below this; None for all.

    Raises
    ------
    DoesNotFitError
        The solid voxels reach over more than 2048, the largest scene of MagicaVoxel.
    OSError
        The file cannot be written.

    Examples
    --------
    >>> import voxrt
    >>> from pathlib import Path
    >>> write_vox(Path("house.vox"), voxrt.build("examples/house.obj", depth=4).rom)
    """
    models = list(_models(rom, high))
    nodes = [_transform(0, 1), _chunk(b"nGRP", struct.pack("<iii", 1, 0, len(models)) + _numbers(models))]
    content = []
    for number, (voxels, place) in enumerate(models):
        size = voxels[:, :3].max(axis=0).astype(int) + 1
        content.append(_chunk(b"SIZE", struct.pack("<3i", *size)))
        content.append(_chunk(b"XYZI", struct.pack("<i", len(voxels)) + voxels.tobytes()))
        middle = " ".join(str(int(a)) for a in place + size // 2)
        nodes.append(_transform(2 + 2 * number, 3 + 2 * number, {"_t": middle}))
        nodes.append(_chunk(b"nSHP", struct.pack("<iiiii", 3 + 2 * number, 0, 1, number, 0)))
    palette = np.full((256, 4), 255, np.uint8)
    palette[: len(rom.materials) - 1, :3] = [material.colour for material in rom.materials[1:]] or np.zeros((0, 3))
    children = b"".join((*content, *nodes, _chunk(b"RGBA", palette.tobytes())))
    main = b"MAIN" + struct.pack("<ii", 0, len(children)) + children
    write_atomically(path, b"VOX " + struct.pack("<i", _VERSION) + main)


def _models(rom: Rom, high: tuple[int, int, int] | None) -> Iterator[tuple[NDArray[np.uint8], NDArray[np.int64]]]:
    """Give each model's voxels (x, y, z, material; shape (N, 4)) and the place of its lowest corner, file axes."""
    bounds = solid_bounds(rom.octree)
    if bounds is None:
        return
    low, end = np.array(bounds)
    end = end if high is None else np.minimum(end, high)
    if (end - low).max() > _WORLD:
        raise DoesNotFitError(
            f"{rom.name}: {(end - low).max()} voxels from end to end do not fit MagicaVoxel's {_WORLD}; show a part"
        )
    steps = [range(a, b, _MODEL) for a, b in zip(low.tolist(), end.tolist(), strict=True)]
    for corner in product(steps[0], steps[1], steps[2]):
        last = np.minimum(np.add(corner, _MODEL), end).tolist()
        dense = to_dense(rom.octree, corner, (last[0], last[1], last[2]))
        x, y, z = np.nonzero(dense)
        if not len(x):
            continue
        across = last[2] - corner[2] - 1 - z  # file y runs against our z
        voxels = np.stack([x, across, y, dense[x, y, z]], axis=1)
        least = voxels[:, :3].min(axis=0)
        voxels[:, :3] -= least
        yield voxels.astype(np.uint8), np.array([corner[0], -last[2] + 1, corner[1]]) + least


def _numbers(models: list[tuple[NDArray[np.uint8], NDArray[np.int64]]]) -> bytes:
    return struct.pack(f"<{len(models)}i", *range(2, 2 + 2 * len(models), 2))


def _transform(node: int, child: int, frame: dict[str, str] | None = None) -> bytes:
    attributes = b"".join(_text(key) + _text(value) for key, value in (frame or {}).items())
    head = struct.pack("<iiiiii", node, 0, child, -1, -1, 1)
    return _chunk(b"nTRN", head + struct.pack("<i", len(frame or {})) + attributes)


def _text(text: str) -> bytes:
    return struct.pack("<i", len(text)) + text.encode("ascii")


def _chunk(name: bytes, content: bytes) -> bytes:
    return name + struct.pack("<ii", len(content), 0) + content
