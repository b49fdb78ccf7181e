"""Colour that varies over a surface: vertex colours, textures and factors, carried beside the triangles to be sampled.

Everything multiplies in linear light; alpha is coverage.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.colour.texture import look_up

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.colour.texture import Texture

_FINEST = 32
_MOST_SAMPLES = 1 << 21
_CHUNK = 1 << 16


@dataclass(frozen=True, eq=False, slots=True)
class Paint:
    """What colours a surface besides its vertices.

    Attributes
    ----------
    name
        The author's name for it.
    factor
        Linear red, green, blue and alpha, multiplied with everything else.
    texture
        Multiplied at the surface's texture coordinates, or None.
    cutoff
        Where alpha is below it there is no surface; 0 for opaque paint.
    mirror
        Reflects instead of showing its own shade, where the hardware has mirrors.
    """

    name: str
    factor: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    texture: Texture | None = None
    cutoff: float = 0.0
    mirror: bool = False


@dataclass(frozen=True, eq=False, slots=True)
class Coat:
    """The paint on the triangles of one mesh, in the order of its triangles.

    Attributes
    ----------
    paints
        The paints in use.
    rows
        int32, shape (T,): each triangle's paint, or -1 where its material alone gives its colour.
    uv
        float64, shape (T, 3, 2): texture coordinates of its corners.
    colours
        float32, shape (T, 3, 4): linear colour and alpha of its corners, white where the vertices have none.
    """

    paints: tuple[Paint, ...]
    rows: NDArray[np.int32]
    uv: NDArray[np.float64]
    colours: NDArray[np.float32]


def sample(coat: Coat, triangles: NDArray[np.intp], weights: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the colour of points on painted triangles.

    Parameters
    ----------
    coat
        The paint of a mesh.
    triangles
        Shape (N,): triangles whose row in the coat is not -1.
    weights
        float64, shape (N, 3): barycentric coordinates of the points.

    Returns
    -------
    colours
        float64, shape (N, 4): linear red, green, blue and alpha.
    """
    found = np.empty((len(triangles), 4))
    rows = coat.rows[triangles]
    for row in np.unique(rows).tolist():
        here = np.flatnonzero(rows == row)
        uv = np.einsum("nk,nkc->nc", weights[here], coat.uv[triangles[here]])
        colours = np.einsum("nk,nkc->nc", weights[here], coat.colours[triangles[here]].astype(np.float64))
        found[here] = shade(coat.paints[row], coat.paints[row].texture, uv, colours)
    return found


def shade(
    paint: Paint, texture: Texture | None, uv: NDArray[np.float64], colours: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the linear colour and alpha of points, float64, shape (N, 4).

    Parameters
    ----------
    paint, texture
        Their paint, and what is looked up for its texture.
    uv
        float64, shape (N, 2): texture coordinates.
    colours
        float64, shape (N, 4) or (4,): the colour and alpha of their vertices, mixed.
    """
    own = np.asarray(colours * paint.factor)
    if texture is None:
        return np.broadcast_to(own, (len(uv), 4))
    found = look_up(texture, uv)
    found *= own
    return found


def remaining(coat: Coat) -> NDArray[np.bool_]:
    """Tell of each triangle whether it is painted and any of it is not cut away: bool, shape (T,).

    Triangles that may be cut away are sampled at the centroids of n² equal parts, n growing with their size in the
    texture.
    """
    solid = np.zeros(len(coat.rows), np.bool_)
    for row, paint in enumerate(coat.paints):
        members = np.flatnonzero(coat.rows == row)
        # Nearest pixels suffice to tell whether there is any surface.
        texture = replace(paint.texture, nearest=True) if paint.texture is not None else None
        least = float(texture.pixels[:, :, 3].min()) / 255 if texture is not None and paint.cutoff > 0 else 1.0
        own = coat.colours[members, :, 3].min(axis=1) * paint.factor[3]
        solid[members] = own * least >= paint.cutoff
        doubtful = members[~solid[members]]
        parts = _parts(coat, texture, doubtful)
        for n in np.unique(parts).tolist():
            weights = centroids(n)
            of_size = doubtful[parts == n]
            for some in np.array_split(of_size, -(-len(of_size) * n * n // _CHUNK)):
                uv, mixed = weights @ coat.uv[some], weights @ coat.colours[some].astype(np.float64)
                found = shade(paint, texture, uv.reshape(-1, 2), mixed.reshape(-1, 4))
                solid[some] = (found[:, 3].reshape(len(some), n * n) >= paint.cutoff).any(axis=1)
    return solid


def _parts(coat: Coat, texture: Texture | None, triangles: NDArray[np.intp]) -> NDArray[np.int32]:
    """Into how many parts a side triangles are cut to be sampled: about one a pixel, a power of two."""
    across = np.full(len(triangles), 2.0)
    if texture is not None:
        height, width = texture.pixels.shape[:2]
        across = np.maximum(across, (np.ptp(coat.uv[triangles], axis=1) * (width, height)).max(axis=1, initial=0.0))
    parts: NDArray[np.int32] = 1 << np.ceil(np.log2(np.clip(across, 1, _FINEST))).astype(np.int32)
    while int((parts.astype(np.int64) ** 2).sum()) > _MOST_SAMPLES and parts.max() > 1:
        parts = np.minimum(parts, parts.max() // 2)
    return parts


def centroids(n: int) -> NDArray[np.float64]:
    """Barycentric coordinates, shape (n², 3), of the centroids of a triangle's n² equal parts."""
    i, j = np.divmod(np.arange(n * n), n)
    upward = np.stack([i, j], axis=1)[i + j < n] + 1 / 3
    downward = np.stack([i, j], axis=1)[i + j < n - 1] + 2 / 3
    two = np.concatenate([upward, downward]) / n
    return np.column_stack([two, 1 - two.sum(axis=1)])
