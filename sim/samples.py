"""Pictures of several samples per pixel, and their backgrounds."""

from __future__ import annotations

from functools import reduce
from operator import add
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from msgspec.structs import replace

from voxrt.octree import Rom
from voxrt.octree.camera import Triple, average_cut_out, average_samples
from voxrt.sim.frame import RenderCost
from voxrt.voxelize.arguments import instance, whole_array

if TYPE_CHECKING:
    from voxrt.sim.frame import Frame

Background: TypeAlias = Triple | Literal["transparent"]
"""sRGB, 0 … 255 each, or nothing at all."""


def put_background(rom: Rom, background: Background | None) -> Rom:
    """Give a memory with another background; None and ``"transparent"`` leave it.

    TypeError or ValueError for what is no memory, or a colour that is not three numbers of 0 … 255.
    """
    instance("rom", rom, Rom)
    if background is None or background == "transparent":
        return rom
    red, green, blue = whole_array("background", background, (3,), np.int64, low=0, high=255).tolist()
    return replace(rom, materials=(replace(rom.materials[0], colour=(red, green, blue)), *rom.materials[1:]))


def join_samples(frames: list[Frame], background: Background | None) -> Frame:
    """Make one frame of the samples of a picture, at the cost of all; material and face are those of the first."""
    if background == "transparent":
        colour = average_cut_out([one.colour for one in frames], [one.material > 0 for one in frames])
    elif len(frames) == 1:
        return frames[0]
    else:
        colour = average_samples([one.colour for one in frames])
    costs = [one.cost for one in frames]
    caches = [one.cache for one in costs if one.cache is not None]
    cost = RenderCost(
        sum(one.rays for one in costs),
        _total([one.words_read for one in costs]),
        _total([one.cycles for one in costs]),
        sum(one.seconds for one in costs),
        reduce(add, caches) if caches else None,
    )
    return replace(frames[0], colour=colour, cost=cost)


def _total(values: list[int | None]) -> int | None:
    known = [value for value in values if value is not None]
    return sum(known) if known else None
