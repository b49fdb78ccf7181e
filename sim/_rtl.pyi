# The verilated ray tracer; src/rtl/module.cpp and src/rtl/core_module.cpp document it.
from collections.abc import Callable
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

CONFIGS: list[str]
COMPLETE: bool
WAVE: bool
FEATURES: dict[str, list[str]]
CORES: list[str]

class RenderResult(TypedDict):
    colour: NDArray[np.uint8]
    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    cycles: int
    words_read: int
    word_requests: int
    line_requests: int
    lines_read: int
    errors: list[str]

class Tracer:
    def __init__(self, config: str, *, recorded: bool = False) -> None: ...
    @property
    def memory_words(self) -> int: ...
    @property
    def cached(self) -> bool: ...
    @property
    def max_depth(self) -> int: ...
    @property
    def position_limit(self) -> int: ...
    @property
    def light_limit(self) -> int: ...
    def take_wave(self) -> str: ...
    def load(self, words: NDArray[np.uint32], *, lod_words: bool = False, through_port: bool = False) -> None: ...
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
        brightness: NDArray[np.uint8] | None = None,
        light: NDArray[np.int32] | None = None,
        ambient: int = 0,
        bounces: int = 0,
        mirrors: NDArray[np.uint8] | None = None,
        lod_scale: int = 0,
        root: int = 0,
        stall_seed: int = 0,
        latency: int = 50,
        interval: int = 3,
        jitter: int = 0,
        dram_seed: int = 0,
        progress: Callable[[int], object] | None = None,
    ) -> RenderResult: ...

class Core:
    def __init__(self, config: str, *, recorded: bool = False) -> None: ...
    @property
    def memory_words(self) -> int: ...
    @property
    def cached(self) -> bool: ...
    def read(self, address: int) -> int: ...
    def write(self, address: int, value: int) -> None: ...
    def read_memory(self, address: int, count: int) -> NDArray[np.uint32]: ...
    def write_memory(self, address: int, words: NDArray[np.uint32]) -> None: ...
    def map_external(self, address: int, words: NDArray[np.uint32]) -> None: ...
    def expect(self, width: int, height: int, *, stall_seed: int = 0) -> None: ...
    def run(self, clocks: int) -> bool: ...
    def frame(self) -> NDArray[np.uint8]: ...
