"""The camera's registers."""

from __future__ import annotations

from dataclasses import dataclass

Triple = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class Camera:
    """What the ray generator reads: direction = look + right * (column - W // 2) + up * (H // 2 - row).

    Attributes
    ----------
    position
        Signed, 1/16 voxel, grid frame; may stand outside the world.
    look, right, up
        Signed 16 bit each, grid axes, any common scale. Cameras made for people are right-handed: right = look x up.
    """

    position: Triple
    look: Triple
    right: Triple
    up: Triple
