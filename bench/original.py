"""The original's ray tracer in software, ``original.cpp``: compile it and render with it.

It takes cameras that it can stand alone: in the world, on whole voxels, along an axis.
"""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Self

import numpy as np

from voxrt.octree import material_at
from voxrt.sim import Camera

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree import Rom

SOURCE = Path(__file__).resolve().with_name("original.cpp")

COLOURS = np.arange(256)[:, None] * np.array((40, 80, 120)) % 256
"""The colours that it gives materials."""


class Original:
    """A compiled program; use it as a context.

    Parameters
    ----------
    as_published
        Handle coordinates as the report's program does; else its algorithm at its best.
    """

    def __init__(self, *, as_published: bool) -> None:
        self._folder = tempfile.TemporaryDirectory()
        self._program = Path(self._folder.name) / "original"
        flags = ["-DAS_PUBLISHED"] if as_published else []
        compiler = os.environ.get("CXX", "c++")
        subprocess.run([compiler, "-O2", "-std=c++20", *flags, SOURCE, "-o", self._program], check=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._folder.cleanup()

    def render(self, rom: Rom, camera: Camera, size: tuple[int, int]) -> tuple[float, NDArray[np.uint8]]:
        """Give the processor's seconds of a frame, and the frame, uint8 (H, W, 3)."""
        memory, picture = self._program.with_suffix(".mem"), self._program.with_suffix(".rgb")
        memory.write_text("".join(f"{word:08X}\n" for word in rom.octree.words))
        position = [value // 16 for value in camera.position]
        numbers = [rom.octree.depth, *size, *position, *camera.look, *camera.right, *camera.up]
        command = [self._program, memory, *map(str, numbers), picture]
        answer = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        pixels = np.frombuffer(picture.read_bytes(), np.uint8)
        return float(answer.split()[0]), pixels.reshape(size[1], size[0], 3)


def level_camera(rom: Rom, width: int) -> Camera:
    """Put a camera at the front of the world, in the first free voxel from its middle upwards, looking in."""
    side = rom.octree.size
    middle, front = side // 2, side - 1
    free = [y for y in range(middle, side) if material_at(rom.octree, (middle, y, front)) == 0]
    if not free:
        raise SystemExit(f"{rom.name}: no free voxel at its front for the camera to stand in")
    return Camera((16 * middle, 16 * free[0], 16 * front), (0, 0, -width // 2), (1, 0, 0), (0, 1, 0))
