"""Where a memory comes from: what its manifest says of the build, carried from file to file."""

from __future__ import annotations

import msgspec

from voxrt.voxelize import ObjectReport, SceneWarning  # noqa: TC001 - msgspec resolves the annotations of this module


class Source(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the memory was built from: the name of the file, and the options of the build.

    Examples
    --------
    >>> Source("house.obj", {"fill": "solid"}).file
    'house.obj'
    """

    file: str
    settings: dict[str, str | int | float | bool | None]


class Provenance(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What a manifest says of the build.

    Attributes
    ----------
    source
        What the memory was built from; None where that is not known.
    objects
        How each object was voxelized, in authored order.
    warnings
        What the asset said and the build did not honour as it stands.
    seconds
        Wall seconds per stage.

    Examples
    --------
    >>> Provenance(Source("house.obj", {})).objects
    ()
    """

    source: Source | None = None
    objects: tuple[ObjectReport, ...] = ()
    warnings: tuple[SceneWarning, ...] = ()
    seconds: dict[str, float] = {}
