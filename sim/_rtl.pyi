# The verilated ray tracer; src/rtl/module.cpp documents it.
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

CONFIGS: list[str]

class RenderResult(TypedDict):
    colour: NDArray[np.uint8]
    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    cycles: int
    words_read: int
    errors: list[str]

class Tracer:
    def __init__(self, config: str) -> None: ...
    @property
    def memory_words(self) -> int: ...
    @property
    def max_depth(self) -> int: ...
    @property
    def position_limit(self) -> int: ...
    @property
    def light_limit(self) -> int: ...
    @property
    def features(self) -> list[str]: ...
    def load(self, words: NDArray[np.uint32], *, through_port: bool = False) -> None: ...
    def read_back(self, count: int) -> NDArray[np.uint32]: ...
    def render(
        self,
        camera: NDArray[np.int32],
        width: int,
        height: int,
        depth: int,
        materials: NDArray[np.uint8],
        *,
        flat: bool = False,
        light: NDArray[np.int32] | None = None,
        ambient: int = 0,
        bounces: int = 0,
        mirrors: NDArray[np.uint8] | None = None,
        root: int = 0,
        stall_seed: int = 0,
    ) -> RenderResult: ...
