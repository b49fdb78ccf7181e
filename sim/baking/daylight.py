"""A sun and a sky; ``src/bake/light/daylight.h`` has the directions from which their light is sampled."""

from __future__ import annotations

from msgspec import Struct
from msgspec.structs import force_setattr

from voxrt.voxelize.arguments import vector, whole
from voxrt.voxelize.colour.srgb import linear_from_hex

SUN = (1.0, 3.0, 2.0)
"""The default direction towards the sun: above the front, on the side of the default camera."""

SKY = 0.4
"""The default light of the sky on an open surface that faces up. The sun's on one that faces it is 0.65."""

SAMPLES = 64
"""The default number of directions in the half space above a surface."""

_SUN_LIGHT = 0.65
_MOST_SAMPLES = 4096
_BRIGHTEST = 16.0


class Daylight(Struct, frozen=True):
    """A distant sun and a sky that shines evenly.

    Attributes
    ----------
    sun
        The direction towards the sun, scene frame, of any length; zeros for no sun. On a surface that faces it, its
        light is 0.65.
    sky
        Linear light (red, green, blue) of the sky on an open surface that faces up. From below the horizon comes half
        as much, as from bright ground.
    samples
        Directions of the sky in the half space above a surface, on average.

    Raises
    ------
    TypeError, ValueError
        A value of the wrong kind or out of range.

    Examples
    --------
    >>> Daylight(sky=(0.5, 0.5, 0.6)).samples
    64
    """

    sun: tuple[float, float, float] = SUN
    sky: tuple[float, float, float] = (SKY, SKY, SKY)
    samples: int = SAMPLES

    def __post_init__(self) -> None:
        force_setattr(self, "sun", vector("sun", self.sun))
        sky = vector("sky", self.sky)
        for channel in sky:
            if not 0 <= channel <= _BRIGHTEST:
                raise ValueError(f"sky must be light of 0 … {_BRIGHTEST:g}, not {channel:g}")
        force_setattr(self, "sky", sky)
        force_setattr(self, "samples", whole("samples", self.samples, 1, _MOST_SAMPLES))

    @property
    def sun_light(self) -> float:
        """The sun's light on a surface that faces it."""
        return _SUN_LIGHT if any(self.sun) else 0.0


def sky_light(value: float | str) -> tuple[float, float, float]:
    """Return the sky's light from a strength, or from a colour like ``#9db4d0``.

    Examples
    --------
    >>> sky_light(0.5), sky_light("#ff0000")
    ((0.5, 0.5, 0.5), (1.0, 0.0, 0.0))
    """
    return linear_from_hex("sky", value) if isinstance(value, str) else (value, value, value)
