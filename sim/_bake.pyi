# Baked light, native; the headers in src/bake are the manual.
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

_Material: TypeAlias = tuple[str, tuple[int, int, int], bool, bool]

INSTRUCTION_SETS: tuple[str, ...]

class Surface(NamedTuple):
    brick_codes: NDArray[np.uint64]
    cells: NDArray[np.uint8]
    octant_codes: NDArray[np.uint64]
    octant_levels: NDArray[np.uint8]
    octant_materials: NDArray[np.uint8]
    voxels: NDArray[np.uint64]
    origins: NDArray[np.int32]
    normals: NDArray[np.int16]

class Directions(NamedTuple):
    steps: NDArray[np.int32]
    units: NDArray[np.int16]
    weights: NDArray[np.int32]

class LitVoxels(NamedTuple):
    rows: NDArray[np.uint64]
    sun: NDArray[np.float64]
    sky: NDArray[np.float64]
    colours: NDArray[np.uint8]

class Received(NamedTuple):
    received: NDArray[np.int64]
    full: NDArray[np.int64]

def sun_direction(sun: tuple[float, float, float]) -> Directions: ...
def sky_directions(samples: int) -> Directions: ...
def place_triangles(
    meshes: Sequence[tuple[NDArray[np.float64], NDArray[np.int32], NDArray[np.float64], NDArray[np.int32]]],
    objects: Sequence[tuple[int, NDArray[np.float64]]],
    origin: tuple[float, float, float],
    voxel_size: float,
) -> tuple[NDArray[np.float64], NDArray[np.float32]]: ...
def measure_light(
    words: NDArray[np.uint32],
    depth: int,
    brick_codes: NDArray[np.uint64],
    voxels: NDArray[np.uint64],
    origins: NDArray[np.int32],
    normals: NDArray[np.int16],
    towards_sun: tuple[float, float, float],
    sky_light: tuple[float, float, float],
    samples: int,
    threads: int,
) -> tuple[NDArray[np.uint64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]: ...
def light_voxels(
    points: NDArray[np.uint64],
    cells: NDArray[np.uint8],
    sun: NDArray[np.int64],
    sky: NDArray[np.int64],
    open_sky: NDArray[np.int64],
    materials: Sequence[_Material],
    towards_sun: tuple[float, float, float],
    sky_light: tuple[float, float, float],
) -> LitVoxels: ...
def bake_memory(
    depth: int,
    codes: NDArray[np.uint64],
    cells: NDArray[np.uint8],
    octant_codes: NDArray[np.uint64],
    octant_levels: NDArray[np.uint8],
    octant_materials: NDArray[np.uint8],
    rows: NDArray[np.uint64],
    colours: NDArray[np.uint8],
    materials: Sequence[_Material],
    count: int,
    threads: int,
) -> tuple[NDArray[np.uint32], list[_Material]]: ...
def measure_surface(
    words: NDArray[np.uint32], depth: int, corners: NDArray[np.float64], normals: NDArray[np.float32], threads: int
) -> Surface: ...
def receive_light(
    words: NDArray[np.uint32],
    depth: int,
    voxels: NDArray[np.int32],
    normals: NDArray[np.int16],
    steps: NDArray[np.int32],
    units: NDArray[np.int16],
    weights: NDArray[np.int32],
    threads: int,
    method: str = "automatic",
    instructions: str = "",
) -> Received: ...
