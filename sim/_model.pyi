# The exact model, native; src/model/bindings/module.cpp documents it.
from collections.abc import Sequence
from typing import Literal, NamedTuple, TypeAlias, overload

import numpy as np
from numpy.typing import NDArray

from voxrt.octree._native import World

_Triple: TypeAlias = tuple[int, int, int]
_Surface: TypeAlias = tuple[int, int, bool, _Triple]
_Light: TypeAlias = Literal["none", "lit", "turned away", "shadowed"]
_Reading: TypeAlias = tuple[int, int, int, _Triple, int, int]

INSTRUCTION_SETS: tuple[str, ...]

class RenderedPixels(NamedTuple):
    colour: NDArray[np.uint8]
    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    words_read: int

class TracedRays(NamedTuple):
    material: NDArray[np.uint8]
    face: NDArray[np.uint8]
    cell: NDArray[np.int32]
    words_read: int

class Stop:
    def __init__(self) -> None: ...
    def set(self) -> None: ...

class Memory:
    @overload
    def __init__(self, words: NDArray[np.uint32], depth: int, root: int = 0) -> None: ...
    @overload
    def __init__(self, memory: Memory, depth: int, root: int) -> None: ...
    def render(
        self,
        materials: NDArray[np.uint8],
        camera: NDArray[np.int32],
        width: int,
        height: int,
        threads: int = 0,
        instructions: str = "",
        *,
        flat: bool = False,
        brightness: NDArray[np.uint8] | None = None,
        light: NDArray[np.int32] | None = None,
        ambient: int = 0,
        bounces: int = 0,
        mirrors: NDArray[np.uint8] | None = None,
        means: NDArray[np.uint8] | None = None,
        lod_scale: int = 0,
        seconds: float = ...,
        stop: Stop | None = None,
    ) -> RenderedPixels: ...
    def trace(self, origins: NDArray[np.int32], directions: NDArray[np.int32], threads: int = 0) -> TracedRays: ...
    def follow(
        self, origin: NDArray[np.int32], direction: NDArray[np.int32]
    ) -> tuple[int, int, _Triple, list[_Reading]]: ...
    def explain(
        self,
        materials: NDArray[np.uint8],
        origin: NDArray[np.int32],
        direction: NDArray[np.int32],
        *,
        flat: bool = False,
        brightness: NDArray[np.uint8] | None = None,
        light: NDArray[np.int32] | None = None,
        ambient: int = 0,
        bounces: int = 0,
        mirrors: NDArray[np.uint8] | None = None,
    ) -> tuple[_Triple, list[_Surface], _Surface | None, _Light, int, int, bool]: ...

class Band(NamedTuple):
    camera: NDArray[np.int32]
    width: int
    rows: int

class BeamSearch:
    def __init__(self, cameras: NDArray[np.int32], clock_hz: float, buffer_lines: int) -> None: ...
    @property
    def ended(self) -> bool: ...
    @property
    def done(self) -> int: ...
    @property
    def total(self) -> int: ...
    @property
    def left(self) -> int: ...
    def band(self, ahead: int = 0) -> Band: ...
    def give(self, cycles: float) -> None: ...
    def fit(self) -> tuple[int, float, float, float]: ...

def orbit(points: NDArray[np.float64], width: int, height: int, count: int) -> NDArray[np.int32]: ...
def beam_lead(rows: Sequence[float], line: float, scale: int, buffer_lines: int) -> float: ...

class FitViews:
    def __init__(self, memory: Memory, materials: NDArray[np.uint8], flat: bool, threads: int = 0) -> None: ...
    def likeness(self, fitted: Memory) -> tuple[float, float]: ...
    def cameras(self) -> NDArray[np.int32]: ...

def pick(world: World, origin: Sequence[int], direction: Sequence[int]) -> tuple[int, int, _Triple]: ...
def choose_fit(fits: Sequence[tuple[float, float, float]]) -> int: ...
def peak_signal_to_noise(picture: NDArray[np.uint8], other: NDArray[np.uint8]) -> float: ...
def structural_similarity(picture: NDArray[np.uint8], other: NDArray[np.uint8]) -> float: ...
