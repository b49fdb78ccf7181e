"""The exact model, native."""

from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

class RenderedPixels(TypedDict):
    """A frame: colour (H, W, 3), material (H, W), face (H, W), all uint8, and the octree words that it read."""

    colour: NDArray[np.uint8]
    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    words_read: int

class TracedRays(TypedDict):
    """Rays' hits: material and face uint8 (N,), cell int32 (N, 3), -1 at a miss, and the octree words read."""

    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    cell: NDArray[np.int32]
    words_read: int

def render(
    words: NDArray[np.uint32],
    depth: int,
    materials: NDArray[np.uint8],
    camera: NDArray[np.int32],
    width: int,
    height: int,
    threads: int = 0,
) -> RenderedPixels:
    """Render a frame: materials (256, 3) sRGB, camera (4, 3) position, look, right, up; threads 0 takes every core.

    Raises ValueError for a malformed memory, a frame above 16384 x 16384, or pixel directions not below 2**20.
    """

def trace(
    words: NDArray[np.uint32],
    depth: int,
    origins: NDArray[np.int32],
    directions: NDArray[np.int32],
    threads: int = 0,
) -> TracedRays:
    """Trace rays: origins (N, 3) in 1/16 voxel, directions (N, 3), each component below 2**20 in size.

    Raises ValueError for a malformed memory or a direction out of range.
    """
