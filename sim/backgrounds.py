"""Named backgrounds of pictures. The command line reads them before NumPy is imported."""

from __future__ import annotations

BACKGROUNDS: dict[str, tuple[int, int, int]] = {"dark": (24, 28, 36), "light": (236, 240, 244)}
"""sRGB, 0 … 255 each, by name."""


def background_of(first: tuple[int, int, int]) -> tuple[int, int, int]:
    """Return the background that suits a scene: `first`, the colour of its entry 0, or a light one if it names none.

    >>> background_of((24, 28, 36)), background_of((0, 0, 255))
    ((236, 240, 244), (0, 0, 255))
    """
    from voxrt.voxelize import EMPTY  # noqa: PLC0415 - see above

    return BACKGROUNDS["light"] if first == EMPTY.colour else first
