"""Colour that varies over a surface: vertex colours, textures and factors, carried beside the triangles to be sampled.

Everything multiplies in linear light; alpha is coverage. Where a loader has no better use for it, :func:`mean_colours`
gives each triangle one colour.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from voxrt.voxelize.colour import LINEAR_OF_SRGB8

if TYPE_CHECKING:
    from numpy.typing import NDArray

Wrap: TypeAlias = Literal["repeat", "mirror", "clamp"]

_FINEST = 32
_MOST_SAMPLES = 1 << 21
_MANY_PARTS = 4
_CHUNK = 1 << 16


@dataclass(frozen=True, eq=False, slots=True)
class Texture:
    """An image that colours surfaces.

    Attributes
    ----------
    pixels
        uint8, shape (H, W, 4): sRGB colour and linear alpha. Row 0 stands at v = 0, column 0 at u = 0.
    wrap
        What happens outside 0 … 1, along u and along v.
    nearest
        Samples take the nearest pixel's colour instead of mixing four.
    """

    pixels: NDArray[np.uint8]
    wrap: tuple[Wrap, Wrap] = ("repeat", "repeat")
    nearest: bool = False


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
        found[here] = _shaded(coat.paints[row], uv, colours)
    return found


def mean_colours(coat: Coat) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Average the paint over each triangle, leaving out what is cut away.

    The samples are the centroids of n² equal parts of the triangle, n growing with its size in the texture.

    Returns
    -------
    colours, solid
        float64, shape (T, 3): mean linear colour; and bool, shape (T,): whether any sample is not cut away. Both are
        zero where the coat has no paint.
    """
    count = len(coat.rows)
    colours = np.zeros((count, 3))
    solid = np.zeros(count, np.bool_)
    parts = _parts(coat)
    while int((parts.astype(np.int64) ** 2).sum()) > _MOST_SAMPLES and parts.max() > 1:
        parts = np.minimum(parts, parts.max() // 2)
    for row, paint in enumerate(coat.paints):
        members = np.flatnonzero(coat.rows == row)
        if paint.texture is None and paint.cutoff <= 0:
            colours[members] = coat.colours[members, :, :3].mean(axis=1, dtype=np.float64) * paint.factor[:3]
            solid[members] = True
            continue
        for n in np.unique(parts[members]).tolist():
            weights = _centroids(n)
            of_size = members[parts[members] == n]
            used = paint if n < _MANY_PARTS else _unfiltered(paint)
            for some in np.array_split(of_size, -(-len(of_size) * n * n // _CHUNK)):
                uv, own = weights @ coat.uv[some], weights @ coat.colours[some].astype(np.float64)
                found = _shaded(used, uv.reshape(-1, 2), own.reshape(-1, 4)).reshape(len(some), n * n, 4)
                kept = found[:, :, 3] >= paint.cutoff
                solid[some] = kept.any(axis=1)
                share = kept / np.maximum(kept.sum(axis=1, keepdims=True), 1)
                colours[some] = (share[:, None, :] @ found[:, :, :3])[:, 0]
    return colours, solid


def _shaded(paint: Paint, uv: NDArray[np.float64], colours: NDArray[np.float64]) -> NDArray[np.float64]:
    """Multiply the vertex colours of points, shape (N, 4), with what `paint` adds at `uv`, shape (N, 2)."""
    shaded: NDArray[np.float64] = colours * paint.factor
    if paint.texture is not None:
        shaded *= _look_up(paint.texture, uv)
    return shaded


def _unfiltered(paint: Paint) -> Paint:
    """Return `paint` without filtering, which the mean of many samples does not need."""
    if paint.texture is None:
        return paint
    return replace(paint, texture=replace(paint.texture, nearest=True))


def _parts(coat: Coat) -> NDArray[np.int32]:
    """Into how many parts a side each triangle is cut for its mean: about one a pixel, a power of two; 0 unpainted."""
    parts = np.where(coat.rows < 0, 0, 1).astype(np.int32)
    for row, paint in enumerate(coat.paints):
        here = np.flatnonzero(coat.rows == row)
        # Vertex colours change linearly: the centroid has their mean, and a few samples tell what is cut away.
        across = np.full(len(here), 2.0 if paint.cutoff else 1.0)
        if paint.texture is not None:
            height, width = paint.texture.pixels.shape[:2]
            spread = np.ptp(coat.uv[here], axis=1) * (width, height)
            across = np.maximum(across, spread.max(axis=1, initial=0.0))
        parts[here] = 1 << np.ceil(np.log2(np.clip(across, 1, _FINEST))).astype(np.int32)
    return parts


def _centroids(n: int) -> NDArray[np.float64]:
    """Barycentric coordinates, shape (n², 3), of the centroids of a triangle's n² equal parts."""
    i, j = np.divmod(np.arange(n * n), n)
    upward = np.stack([i, j], axis=1)[i + j < n] + 1 / 3
    downward = np.stack([i, j], axis=1)[i + j < n - 1] + 2 / 3
    two = np.concatenate([upward, downward]) / n
    return np.column_stack([two, 1 - two.sum(axis=1)])


def _look_up(texture: Texture, uv: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the linear colour and alpha, shape (N, 4), of `texture` at `uv`, shape (N, 2)."""
    height, width = texture.pixels.shape[:2]
    x = _wrapped(uv[:, 0], texture.wrap[0]) * width
    y = _wrapped(uv[:, 1], texture.wrap[1]) * height
    if texture.nearest:
        return _texels(texture, np.floor(x).astype(np.int64), np.floor(y).astype(np.int64))
    left, top = np.floor(x - 0.5).astype(np.int64), np.floor(y - 0.5).astype(np.int64)
    right_share, bottom_share = (x - 0.5 - left)[:, None], (y - 0.5 - top)[:, None]
    upper = _texels(texture, left, top) * (1 - right_share) + _texels(texture, left + 1, top) * right_share
    lower = _texels(texture, left, top + 1) * (1 - right_share) + _texels(texture, left + 1, top + 1) * right_share
    mixed: NDArray[np.float64] = upper * (1 - bottom_share) + lower * bottom_share
    return mixed


def _wrapped(coordinate: NDArray[np.float64], wrap: Wrap) -> NDArray[np.float64]:
    """Bring coordinates into 0 … 1, or 0 … 2 for mirrored ones, where they are exact however far out they were."""
    if wrap == "clamp":
        return np.clip(coordinate, 0.0, 1.0)
    return np.mod(coordinate, 1.0 if wrap == "repeat" else 2.0)


def _texels(texture: Texture, x: NDArray[np.int64], y: NDArray[np.int64]) -> NDArray[np.float64]:
    height, width = texture.pixels.shape[:2]
    stored = texture.pixels[_index(y, height, texture.wrap[1]), _index(x, width, texture.wrap[0])]
    linear = LINEAR_OF_SRGB8[stored]
    linear[:, 3] = stored[:, 3] / 255.0
    return linear


def _index(pixel: NDArray[np.int64], size: int, wrap: Wrap) -> NDArray[np.int64]:
    if wrap == "clamp":
        found: NDArray[np.int64] = np.clip(pixel, 0, size - 1)
    elif wrap == "repeat":
        found = np.mod(pixel, size)
    else:
        turned = np.mod(pixel, 2 * size)
        found = np.minimum(turned, 2 * size - 1 - turned)
    return found
