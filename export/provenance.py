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


class BakedLight(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The light that was baked into the materials: show the memory flat.

    Attributes
    ----------
    sun
        The direction towards the sun, scene frame; zeros for no sun.
    sky
        Linear light of the sky: red, green, blue.
    samples
        Rays to the sky per voxel.
    voxels
        Voxels with baked colours.
    colours
        The most baked colours.
    words_before, words
        Words of the memory without and with baked light, before it was fitted to a budget.

    Examples
    --------
    >>> BakedLight((1, 3, 2), (0.4, 0.4, 0.4), 64, 1000, 254, 721, 2049).samples
    64
    """

    sun: tuple[float, float, float]
    sky: tuple[float, float, float]
    samples: int
    voxels: int
    colours: int
    words_before: int
    words: int


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
    baked
        The light that was baked into the materials; None where none was.

    Examples
    --------
    >>> Provenance(Source("house.obj", {})).objects
    ()
    """

    source: Source | None = None
    objects: tuple[ObjectReport, ...] = ()
    warnings: tuple[SceneWarning, ...] = ()
    seconds: dict[str, float] = {}
    baked: BakedLight | None = None
