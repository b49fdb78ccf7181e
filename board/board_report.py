"""Does a board draw what the exact model draws? A few views of a scene, each compared."""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING

import numpy as np

from voxrt.board.view import FACES, View, refit
from voxrt.octree.camera import look_at
from voxrt.sim import _model
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from voxrt.board.device import Device
    from voxrt.board.scene import Scene
    from voxrt.octree.camera import Camera


class ViewCheck(Value, frozen=True):
    """A view of a scene, as the board has it and as the exact model has it.

    Attributes
    ----------
    number
        Of the view, from 0.
    size
        Columns and rows.
    crc32
        CRC-32 of the board's frame, as `frame_crc32` gives it. None where the board neither sends frames nor has a
        register of it.
    expected_crc32
        That of the model.
    hits
        Rays that the board counted as hits.
    expected_hits
        Pixels of the model that show a solid.
    """

    number: int
    size: tuple[int, int]
    crc32: int | None
    expected_crc32: int
    hits: int
    expected_hits: int

    @property
    def equal(self) -> bool:
        """The board and the model agree in all that the board tells."""
        return self.hits == self.expected_hits and self.crc32 in {None, self.expected_crc32}


def frame_crc32(colour: NDArray[np.uint8]) -> int:
    """Give the CRC-32 of a frame as the ray tracer streams it: green, blue, red per pixel, row by row.

    Parameters
    ----------
    colour
        Red, green, blue: uint8, shape (H, W, 3). W is a multiple of 4: rows are whole words.

    Examples
    --------
    >>> f"{frame_crc32(np.zeros((2, 4, 3), dtype=np.uint8)):08X}"
    'A3C1CA20'
    """
    return zlib.crc32(colour[..., (1, 2, 0)].tobytes())


def cameras_around(depth: int, size: tuple[int, int], count: int) -> list[Camera]:
    """Make `count` cameras on a circle around a world of `depth` levels, which look at its middle from above."""
    side = 2.0**depth
    middle = np.full(3, side / 2)
    angles = 2 * np.pi * np.arange(count) / count
    eyes = np.stack([0.5 + 1.3 * np.cos(angles), 0 * angles + 1.2, 0.5 + 1.3 * np.sin(angles)], axis=1)
    return [look_at(side * eye, middle, size=size) for eye in eyes]


def check_views(
    device: Device,
    scene: Scene,
    cameras: Sequence[Camera],
    size: tuple[int, int],
    progress: Callable[[str, int, int], None],
    *,
    sends_frames: bool,
) -> list[ViewCheck]:
    """Let a board draw views of the scene that it shows, and compare them with the exact model's.

    Parameters
    ----------
    device
        The board. It shows `scene` already.
    scene
        What it shows, a still scene.
    cameras, size
        Of the views.
    progress
        Receives what is under way, and how many of how many steps are done.
    sends_frames
        The frames of the device are the board's own. Otherwise its registers tell what it drew.

    Raises
    ------
    DeviceError
        The board fails.
    """
    model = _model.Memory(scene.words, scene.depth)
    found = []
    for number, camera in enumerate(cameras):
        frame = device.frame(View(camera, size, scene.background))
        device.hold()
        registers = device.registers()
        drawn = registers["size"] & 0xFFF, registers["size"] >> 16
        expected = model.render(
            scene.colours, _rows(refit(camera, size, drawn)), *drawn, brightness=np.array(FACES, dtype=np.uint8)
        )
        found.append(
            ViewCheck(
                number,
                drawn,
                frame_crc32(frame.colour) if sends_frames else registers.get("board.frame_crc"),
                frame_crc32(expected.colour),
                registers["hits"],
                int(np.count_nonzero(expected.material)),
            )
        )
        progress("compare views", number + 1, len(cameras))
    return found


def _rows(camera: Camera) -> NDArray[np.int32]:
    return np.array([camera.position, camera.look, camera.right, camera.up], dtype=np.int32)
