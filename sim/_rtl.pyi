"""The verilated ray tracer, configuration by configuration."""

from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

CONFIGS: list[str]
"""Names of the configurations that were built."""

class RenderResult(TypedDict):
    """A frame, row 0 at the top.

    Attributes
    ----------
    colour
        uint8, shape (height, width, 3), sRGB.
    material, face
        uint8, shape (height, width); face 3 where none was crossed.
    cycles
        Clocks from the start to the last pixel accepted.
    words_read
        Octree words read.
    errors
        Sticky errors of the frame: "direction overflow", "bad pointer", "step limit".
    """

    colour: NDArray[np.uint8]
    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    cycles: int
    words_read: int
    errors: list[str]

class Tracer:
    """One instance of the ray tracer with its own memory. One call at a time (RuntimeError otherwise).

    Parameters
    ----------
    config
        One of :data:`CONFIGS`; ValueError otherwise.
    """

    def __init__(self, config: str) -> None: ...
    @property
    def memory_words(self) -> int:
        """How many words the simulated memory holds."""
    @property
    def max_depth(self) -> int:
        """The deepest octree the configuration can trace."""
    @property
    def position_limit(self) -> int:
        """Camera positions are in -position_limit ... position_limit - 1, 1/16 voxel."""
    def load(self, words: NDArray[np.uint32], *, through_port: bool = False) -> None:
        """Load an octree memory.

        Parameters
        ----------
        words
            uint32, 1-D, report dialect; ValueError when they do not fit.
        through_port
            Through the design's load port, one word a clock, and not straight into the simulated memory. The outcome
            is the same.
        """
    def render(
        self,
        camera: NDArray[np.int32],
        width: int,
        height: int,
        depth: int,
        materials: NDArray[np.uint8],
        *,
        stall_seed: int = 0,
    ) -> RenderResult:
        """Render a frame, clock by clock. Releases the GIL; Ctrl-C ends it.

        Parameters
        ----------
        camera
            int32, shape (4, 3), grid axes: position (1/16 voxel), look, right, up (signed 16 bit each).
        width, height
            1 … 4095.
        depth
            Levels of the memory below its root, 1 … :attr:`max_depth`.
        materials
            uint8, shape (256, 3), sRGB; row 0 is the background.
        stall_seed
            Other than 0: the picture's consumer stalls in a pattern that depends on this.

        Raises
        ------
        ValueError
            A value is out of the configuration's range.
        """
