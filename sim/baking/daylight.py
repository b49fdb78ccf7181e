"""A sun and a sky, and the directions from which their light is sampled."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count
from typing import TYPE_CHECKING

import numpy as np

from voxrt.voxelize.arguments import vector, whole
from voxrt.voxelize.colour.srgb import linear_from_hex

if TYPE_CHECKING:
    from numpy.typing import NDArray

SUN = (1.0, 3.0, 2.0)
"""The default direction towards the sun: above the front, on the side of the default camera."""

SKY = 0.4
"""The default light of the sky on an open surface that faces up. The sun's on one that faces it is 0.65."""

SAMPLES = 64
"""The default number of directions in the half space above a surface."""

_SUN_LIGHT = 0.65
_GROUND = 0.5  # of the sky's light, from below the horizon
_MOST_SAMPLES = 4096
_BRIGHTEST = 16.0
_SUN_STEPS = 1000
_LEAST_STEPS, _MOST_STEPS = 4, 16
_UNIT = 1 << 14
_FULL_WEIGHT = 1 << 16


@dataclass(frozen=True, slots=True)
class Daylight:
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
        object.__setattr__(self, "sun", vector("sun", self.sun))
        sky = vector("sky", self.sky)
        for channel in sky:
            if not 0 <= channel <= _BRIGHTEST:
                raise ValueError(f"sky must be light of 0 … {_BRIGHTEST:g}, not {channel:g}")
        object.__setattr__(self, "sky", sky)
        object.__setattr__(self, "samples", whole("samples", self.samples, 1, _MOST_SAMPLES))

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


@dataclass(frozen=True, eq=False, slots=True)
class Directions:
    """Directions towards light, as the native code takes them.

    Attributes
    ----------
    steps
        int32, shape (K, 3): integers along each direction.
    units
        int16, shape (K, 3): the same directions with length 2**14, rounded.
    weights
        int32, shape (K,): radiance, 2**16 for 1.
    """

    steps: NDArray[np.int32]
    units: NDArray[np.int16]
    weights: NDArray[np.int32]


def sun_direction(daylight: Daylight) -> Directions:
    """Return the direction towards the sun, rounded to integers below 2**10; no row for no sun."""
    sun = np.array(daylight.sun)
    length = float(np.linalg.norm(sun))
    steps = np.rint(_SUN_STEPS * sun / length)[None] if length > 0 else np.zeros((0, 3))
    return _directions(steps, np.full(len(steps), _FULL_WEIGHT))


def sky_directions(samples: int) -> Directions:
    """Return 2 * samples directions, all around and nearly evenly spread.

    They are those of a spherical Fibonacci lattice (Swinbank and Purser, "Fibonacci grids", 2006), each replaced by the
    nearest direction of small integers, all different. Along these, rays from voxel centres meet voxel centres.

    Examples
    --------
    >>> sky_directions(64).steps.shape
    (128, 3)
    """
    number = np.arange(2 * samples) + 0.5
    height = 1 - number / samples
    turn = np.pi * (1 + 5**0.5) * number
    across = np.sqrt(1 - height**2)
    wanted = np.stack([across * np.cos(turn), height, across * np.sin(turn)], axis=1)
    for most in count(_LEAST_STEPS):
        steps = _nearest(wanted, _primitive(most))
        if most == _MOST_STEPS or len(np.unique(steps, axis=0)) == len(steps):
            break
    sky = np.where(steps[:, 1] > 0, 1.0, np.where(steps[:, 1] < 0, _GROUND, (1 + _GROUND) / 2))
    return _directions(steps, np.rint(_FULL_WEIGHT * sky))


def _primitive(most: int) -> NDArray[np.float64]:
    """Return all triples of integers up to `most` without a common factor, but those along x alone."""
    side = np.arange(-most, most + 1)
    found = np.stack(np.meshgrid(side, side, side, indexing="ij"), axis=-1).reshape(-1, 3)
    primitive = (np.gcd.reduce(found, axis=1) == 1) & (found[:, 1:] != 0).any(axis=1)
    kept: NDArray[np.float64] = found[primitive].astype(np.float64)
    return kept


def _nearest(wanted: NDArray[np.float64], steps: NDArray[np.float64]) -> NDArray[np.float64]:
    units = steps / np.linalg.norm(steps, axis=1, keepdims=True)
    # Rounded, so that ties fall alike on every machine.
    rows = [np.round(some @ units.T, 9).argmax(axis=1) for some in np.array_split(wanted, 16)]
    nearest: NDArray[np.float64] = steps[np.concatenate(rows)]
    return nearest


def _directions(steps: NDArray[np.float64], weights: NDArray[np.float64]) -> Directions:
    lengths = np.linalg.norm(steps, axis=1, keepdims=True)
    units = np.rint(_UNIT * steps / np.maximum(lengths, 1))
    return Directions(steps.astype(np.int32), units.astype(np.int16), weights.astype(np.int32))
