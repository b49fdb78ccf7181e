"""The textures of a PLY file, where MeshLab, Metashape and others put them.

``comment TextureFile NAME`` names an image, once per image. Coordinates belong to the corners of faces (the list
``texcoord``: u and v of each corner) or to the vertices (``s`` and ``t``, ``u`` and ``v``, ``texture_u`` and
``texture_v``). ``texnumber`` is the number of a face's image. v points upwards.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.formats.image_file import read_image
from voxrt.voxelize.formats.ply.format import ListColumn

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.external_files import ExternalFiles
    from voxrt.voxelize.formats.ply.format import Table
    from voxrt.voxelize.warning_log import WarningLog

_OF_VERTICES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))


def read_textures(
    path: Path, external_files: ExternalFiles, names: tuple[str, ...], log: WarningLog
) -> list[Texture | None]:
    """Return the textures that a file names; None, with a warning, for one that cannot be opened, and none for none."""
    textures: list[Texture | None] = []
    for name in names:
        found = external_files.reported(external_files.find_exported(name), "texture", name, log)
        pixels = None if found is None else read_image(found, path, f"texture {name}", log)
        textures.append(None if pixels is None else Texture(pixels))
    return textures if any(textures) else []


def texture_coordinates(
    tables: dict[str, Table],
    corners: NDArray[np.integer],
    kept: NDArray[np.int64],
    counts: NDArray[np.int64],
    log: WarningLog,
) -> NDArray[np.float64] | None:
    """Return u and v, v downwards, of each corner of the faces: float64, shape (corners, 2); None for none.

    `corners` are the vertices of the faces in use, face after face, and `counts` how many each has. `kept` are the
    numbers of these faces in the file; strips come after them.
    """
    faces = tables.get("face", {})
    wedges = faces.get("texcoord")
    if isinstance(wedges, ListColumn) and "tristrips" not in tables:
        starts = np.cumsum(wedges.counts) - wedges.counts
        fits = wedges.counts[kept] == 2 * counts
        log.add("texture", "faces whose texture coordinates do not match their corners got none", int((~fits).sum()))
        if not fits.any():
            return None
        within = np.arange(len(corners)) - np.repeat(np.cumsum(counts) - counts, counts)
        places = np.where(np.repeat(fits, counts), np.repeat(starts[kept], counts) + 2 * within, 0)
        values = wedges.values.astype(np.float64)
        found = np.stack([values[places], values[places + 1]], axis=1)
        found[~np.repeat(fits, counts)] = 0.0
    else:
        vertices = tables.get("vertex", {})
        pairs = [[vertices.get(name) for name in pair] for pair in _OF_VERTICES]
        pair = next((pair for pair in pairs if all(isinstance(one, np.ndarray) for one in pair)), None)
        if pair is None:
            return None
        found = np.stack([np.asarray(one, dtype=np.float64) for one in pair], axis=1)[corners]
    return np.stack([found[:, 0], 1.0 - found[:, 1]], axis=1)


def surface_appearance(
    textures: list[Texture | None],
    coordinates: NDArray[np.float64] | None,
    images: NDArray[np.int64],
    by_colour: tuple[str, NDArray[np.float64]] | None,
    cut: NDArray[np.int64],
    *,
    opaque_from: float,
) -> SurfaceAppearance | None:
    """Return the appearance of triangles: a texture where there is one, else colours; None for neither.

    `images` is from :func:`image_of_faces`, for the triangles. `by_colour` says what the colours are, and has linear
    colour and alpha of the triangles' corners: float64, shape (T, 3, 4). `cut`, int64, shape (T, 3), are the triangles'
    corners among all corners. Surfaces are cut away where they are less opaque than `opaque_from`.
    """
    rows = np.full(len(cut), -1, dtype=np.int32)
    uv = np.zeros((len(cut), 3, 2))
    colours = np.ones((len(cut), 3, 4), dtype=np.float32)
    entries: list[Appearance] = []
    if coordinates is not None:
        for index, texture in enumerate(textures):
            here = images == index
            if texture is None or not here.any():
                continue
            rows[here] = len(entries)
            name = "texture" if len(textures) == 1 else f"texture {index}"
            cutoff = opaque_from if (texture.pixels[:, :, 3] < 255).any() else 0.0
            entries.append(Appearance(name, texture=texture, cutoff=cutoff))
        uv[rows >= 0] = coordinates[cut[rows >= 0]]
    bare = rows < 0
    if by_colour is not None and bare.any():
        name, linear = by_colour
        rows[bare] = len(entries)
        colours[bare] = linear[bare]
        entries.append(Appearance(name, cutoff=opaque_from if (colours[bare, :, 3] < 1.0).any() else 0.0))
    return SurfaceAppearance(tuple(entries), rows, uv, colours) if entries else None


def image_of_faces(tables: dict[str, Table], faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the number of the texture of each of `faces`, int64, shape (N,); -1 for none."""
    numbers = tables.get("face", {}).get("texnumber")
    if not isinstance(numbers, np.ndarray) or "tristrips" in tables:
        return np.zeros(len(faces), dtype=np.int64)
    found = np.nan_to_num(numbers[faces].astype(np.float64), nan=-1.0)
    return np.clip(found, -1, 1 << 30).astype(np.int64)
