"""The picture of the self-test, as docs/board-selftest.md describes it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

WHITE = (255, 255, 255)
BARS = (WHITE, (255, 255, 0), (0, 255, 255), (0, 255, 0), (255, 0, 255), (255, 0, 0), (0, 0, 255), (0, 0, 0))


def selftest_picture(lit: Sequence[bool]) -> NDArray[np.uint8]:
    """Draw the picture: uint8, shape (480, 640, 3), with a square per LED, lit or not."""
    picture = np.zeros((480, 640, 3), dtype=np.uint8)
    for number, colour in enumerate(BARS):
        picture[:320, 80 * number : 80 * number + 80] = colour
    ramp = np.minimum(np.arange(640) // 2, 255)
    for channel in range(3):
        picture[320 + 40 * channel : 360 + 40 * channel, :, channel] = ramp
    for number, on in enumerate(lit):
        picture[440:, 80 * number + 4 : 80 * number + 80] = 255 if on else 32
    picture[[0, -1]] = WHITE
    picture[:, [0, -1]] = WHITE
    return picture
