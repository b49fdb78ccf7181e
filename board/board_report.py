"""Does a board draw what the exact model draws? A few views of a scene, each compared."""

from __future__ import annotations

import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from voxrt.board.view import FACES, View, refit
from voxrt.octree.camera import look_at
from voxrt.sim import _model

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from voxrt.board.device import Device
    from voxrt.board.scene import Scene
    from voxrt.octree.camera import Camera


@dataclass(frozen=True, slots=True)
class ViewCheck:
    """A view of a scene, as the board has it and as the exact model has it.

    Attributes
    ----------
    number
        Of the view, from 0.
    size
        Columns and rows.
    crc32
        CRC-32 of the board's frame, its bytes red, green, blue by rows; None where the board sends no frames.
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
        The frames of the device are the board's own. Otherwise its registers alone tell what it drew.

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
        colour = frame.colour if sends_frames else None
        found.append(
            ViewCheck(
                number,
                drawn,
                None if colour is None else zlib.crc32(colour.tobytes()),
                zlib.crc32(np.ascontiguousarray(expected.colour).tobytes()),
                registers["hits"],
                int(np.count_nonzero(expected.material)),
            )
        )
        progress("compare views", number + 1, len(cameras))
    return found


def _rows(camera: Camera) -> NDArray[np.int32]:
    return np.array([camera.position, camera.look, camera.right, camera.up], dtype=np.int32)
