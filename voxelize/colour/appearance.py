"""Surface appearance: textures, vertex colours and colour factors of triangles, as their file describes them.

Colours multiply in linear light. Alpha is coverage.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import force_setattr

from voxrt.voxelize import _native, arguments
from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Appearance(Value, frozen=True, eq=False):
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
        force_setattr(self, "factor", (float(red), float(green), float(blue), float(alpha)))
        if self.texture is not None:
            arguments.instance("Appearance.texture", self.texture, Texture)
        force_setattr(self, "cutoff", arguments.real("Appearance.cutoff", self.cutoff))
        force_setattr(self, "mirror", arguments.flag("Appearance.mirror", self.mirror))


class SurfaceAppearance(Value, frozen=True, eq=False):
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
        force_setattr(self, "entries", entries)
        force_setattr(self, "rows", rows)
        # Texture look-up takes any coordinates; those that are not finite read the texture's corner.
        uv = arguments.real_array("SurfaceAppearance.uv", self.uv, (len(rows), 3, 2), finite=False)
        force_setattr(self, "uv", uv)
        colours = arguments.real_array("SurfaceAppearance.colours", self.colours, (len(rows), 3, 4))
        force_setattr(self, "colours", colours)

    def __repr__(self) -> str:
        return f"SurfaceAppearance(triangles={len(self.rows)}, entries={len(self.entries)})"

    def arrays(self) -> _native.SurfaceArrays:
        """Return the appearance as native code takes it."""
        entries = [
            (one.name, one.factor, one.texture.arrays() if one.texture else None, one.cutoff, one.mirror)
            for one in self.entries
        ]
        rows, uv, colours = (np.ascontiguousarray(one) for one in (self.rows, self.uv, self.colours))
        return entries, rows, uv, colours


def sample(
    surface: SurfaceAppearance, triangles: NDArray[np.intp], weights: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the colour of points on triangles: float64, shape (N, 4), linear red, green, blue and alpha.

    `triangles`, shape (N,), are triangles whose row is not -1. `weights`, float64, shape (N, 3), are the barycentric
    coordinates of the points.
    """
    return _native.sample_surface(
        surface.arrays(), np.ascontiguousarray(triangles, np.int64), np.ascontiguousarray(weights, np.float64)
    )
