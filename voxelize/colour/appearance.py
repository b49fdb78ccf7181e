"""Surface appearance: textures, vertex colours and colour factors of triangles, as their file describes them.

Colours multiply in linear light. Alpha is coverage.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize import arguments
from voxrt.voxelize.colour.texture import Texture, look_up

if TYPE_CHECKING:
    from numpy.typing import NDArray

_FINEST = 32
_MOST_SAMPLES = 1 << 21
_CHUNK = 1 << 16


@dataclass(frozen=True, eq=False, slots=True)
class Appearance:
    """What a material of a file says about a surface: a colour factor, a texture, an alpha cutoff.

    Attributes
    ----------
    name
        The author's name for it.
    factor
        Linear red, green, blue and alpha, multiplied with the texture and the vertex colours.
    texture
        Looked up at the surface's texture coordinates; None for none.
    cutoff
        The surface is cut away where its alpha is below this; 0 for opaque surfaces.
    mirror
        Whether it reflects. Hardware without mirrors shows the colour.

    Raises
    ------
    TypeError, ValueError
        A value of the wrong kind, or a number that is not finite.

    Examples
    --------
    >>> Appearance("glass", (0.2, 0.4, 0.2, 1)).factor
    (0.2, 0.4, 0.2, 1.0)
    """

    name: str
    factor: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    texture: Texture | None = None
    cutoff: float = 0.0
    mirror: bool = False

    def __post_init__(self) -> None:
        arguments.text("Appearance.name", self.name)
        red, green, blue, alpha = arguments.real_array("Appearance.factor", self.factor, (4,)).tolist()
        object.__setattr__(self, "factor", (float(red), float(green), float(blue), float(alpha)))
        if self.texture is not None:
            arguments.instance("Appearance.texture", self.texture, Texture)
        object.__setattr__(self, "cutoff", arguments.real("Appearance.cutoff", self.cutoff))
        object.__setattr__(self, "mirror", arguments.flag("Appearance.mirror", self.mirror))


@dataclass(frozen=True, eq=False, slots=True)
class SurfaceAppearance:
    """The appearance of the triangles of one mesh, in the order of its triangles.

    Attributes
    ----------
    entries
        The appearances in use.
    rows
        int32, shape (T,): each triangle's entry, or -1 where its material alone gives its colour.
    uv
        float64, shape (T, 3, 2): texture coordinates of its corners.
    colours
        float32 or float64, shape (T, 3, 4): linear colour and alpha of its corners; white where the file gives none.

    Raises
    ------
    TypeError, ValueError
        An array of another kind, shape or range.

    Examples
    --------
    A triangle that is red, green and blue at its corners:

    >>> corners = [[[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1]]]
    >>> surface = SurfaceAppearance([Appearance("rainbow")], [0], np.zeros((1, 3, 2)), corners)
    >>> sample(surface, np.array([0]), np.array([[0.5, 0.5, 0.0]]))
    array([[0.5, 0.5, 0. , 1. ]])
    """

    entries: tuple[Appearance, ...]
    rows: NDArray[np.int32]
    uv: NDArray[np.floating]
    colours: NDArray[np.floating]

    def __post_init__(self) -> None:
        entries = tuple(self.entries)
        for index, one in enumerate(entries):
            arguments.instance(f"SurfaceAppearance.entries[{index}]", one, Appearance)
        rows = arguments.whole_array(
            "SurfaceAppearance.rows", self.rows, ("T",), np.int32, low=-1, high=len(entries) - 1
        )
        object.__setattr__(self, "entries", entries)
        object.__setattr__(self, "rows", rows)
        # Texture look-up takes any coordinates; those that are not finite read the texture's corner.
        uv = arguments.real_array("SurfaceAppearance.uv", self.uv, (len(rows), 3, 2), finite=False)
        object.__setattr__(self, "uv", uv)
        colours = arguments.real_array("SurfaceAppearance.colours", self.colours, (len(rows), 3, 4))
        object.__setattr__(self, "colours", colours)

    def __repr__(self) -> str:
        return f"SurfaceAppearance(triangles={len(self.rows)}, entries={len(self.entries)})"


def sample(
    surface: SurfaceAppearance, triangles: NDArray[np.intp], weights: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the colour of points on triangles.

    Parameters
    ----------
    surface
        The appearance of a mesh.
    triangles
        intp, shape (N,): triangles whose row is not -1.
    weights
        float64, shape (N, 3): barycentric coordinates of the points.

    Returns
    -------
    colours
        float64, shape (N, 4): linear red, green, blue and alpha.
    """
    found = np.empty((len(triangles), 4))
    rows = surface.rows[triangles]
    for row in np.unique(rows).tolist():
        here = np.flatnonzero(rows == row)
        uv = np.einsum("nk,nkc->nc", weights[here], surface.uv[triangles[here]])
        colours = np.einsum("nk,nkc->nc", weights[here], surface.colours[triangles[here]].astype(np.float64))
        found[here] = shade(surface.entries[row], surface.entries[row].texture, uv, colours)
    return found


def shade(
    appearance: Appearance, texture: Texture | None, uv: NDArray[np.float64], colours: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the linear colour and alpha of points, float64, shape (N, 4).

    Parameters
    ----------
    appearance, texture
        The appearance of the surface, and the texture to look up: its own, or a reduced copy.
    uv
        float64, shape (N, 2): texture coordinates.
    colours
        float64, shape (N, 4) or (4,): linear colour and alpha, interpolated between the vertices.
    """
    own = np.asarray(colours * appearance.factor)
    if texture is None:
        return np.broadcast_to(own, (len(uv), 4))
    found = look_up(texture, uv)
    found *= own
    return found


def visible_triangles(surface: SurfaceAppearance) -> NDArray[np.bool_]:
    """Tell which triangles have an appearance and are not fully transparent: bool, shape (T,).

    Triangles that may be cut away are sampled at the centroids of n² equal parts. n grows with the triangle's size in
    the texture.
    """
    solid = np.zeros(len(surface.rows), np.bool_)
    for row, appearance in enumerate(surface.entries):
        members = np.flatnonzero(surface.rows == row)
        # Nearest pixels suffice to find whether any surface is left.
        texture = replace(appearance.texture, nearest=True) if appearance.texture is not None else None
        least = float(texture.pixels[:, :, 3].min()) / 255 if texture is not None and appearance.cutoff > 0 else 1.0
        own = surface.colours[members, :, 3].min(axis=1) * appearance.factor[3]
        solid[members] = own * least >= appearance.cutoff
        undecided = members[~solid[members]]
        parts = _parts(surface, texture, undecided)
        for n in np.unique(parts).tolist():
            weights = centroids(n)
            of_size = undecided[parts == n]
            for some in np.array_split(of_size, -(-len(of_size) * n * n // _CHUNK)):
                uv, mixed = (
                    weights @ surface.uv[some],
                    weights @ surface.colours[some].astype(np.float64),
                )
                found = shade(appearance, texture, uv.reshape(-1, 2), mixed.reshape(-1, 4))
                solid[some] = (found[:, 3].reshape(len(some), n * n) >= appearance.cutoff).any(axis=1)
    return solid


def _parts(surface: SurfaceAppearance, texture: Texture | None, triangles: NDArray[np.intp]) -> NDArray[np.int32]:
    """Return the number of parts per side to sample of each triangle: about one per pixel, a power of two."""
    across = np.full(len(triangles), 2.0)
    if texture is not None:
        height, width = texture.pixels.shape[:2]
        across = np.maximum(across, (np.ptp(surface.uv[triangles], axis=1) * (width, height)).max(axis=1, initial=0.0))
    parts: NDArray[np.int32] = 1 << np.ceil(np.log2(np.clip(across, 1, _FINEST))).astype(np.int32)
    while int((parts.astype(np.int64) ** 2).sum()) > _MOST_SAMPLES and parts.max() > 1:
        parts = np.minimum(parts, parts.max() // 2)
    return parts


def centroids(n: int) -> NDArray[np.float64]:
    """Return the centroids of a triangle's n² equal parts: barycentric coordinates, float64, shape (n², 3)."""
    i, j = np.divmod(np.arange(n * n), n)
    upward = np.stack([i, j], axis=1)[i + j < n] + 1 / 3
    downward = np.stack([i, j], axis=1)[i + j < n - 1] + 2 / 3
    two = np.concatenate([upward, downward]) / n
    return np.column_stack([two, 1 - two.sum(axis=1)])
