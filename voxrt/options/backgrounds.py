"""The backgrounds of pictures, as people name them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from voxrt.sim import Background

BACKGROUNDS: dict[str, tuple[int, int, int]] = {"dark": (24, 28, 36), "light": (236, 240, 244)}
"""Named colours, sRGB. ``"transparent"`` is a background too: it suits pages of any colour."""


def read_background(name: str, value: object) -> Background:
    """Return the background that is meant: ``"transparent"``, a name, ``"#rrggbb"``, or three numbers of 0 … 255.

    ValueError, which calls it `name`, if it is none of these.

    Examples
    --------
    >>> read_background("background", "#204060")
    (32, 64, 96)
    """
    if isinstance(value, str):
        if value == "transparent":
            return "transparent"
        if value in BACKGROUNDS:
            return BACKGROUNDS[value]
        if re.fullmatch("#[0-9a-fA-F]{6}", value):
            return int(value[1:3], 16), int(value[3:5], 16), int(value[5:7], 16)
    elif isinstance(value, Sequence) and len(value) == 3:
        red, green, blue = (channel if type(channel) is int and 0 <= channel <= 255 else -1 for channel in value)
        if min(red, green, blue) >= 0:
            return red, green, blue
    raise ValueError(f"{name} {value!r} is not {', '.join(BACKGROUNDS)}, transparent or a colour such as #204060")
