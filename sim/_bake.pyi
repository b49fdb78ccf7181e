# Baked light, native; the headers in src/bake are the manual.
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

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

class Received(NamedTuple):
    received: NDArray[np.int64]
    full: NDArray[np.int64]

def corner_normals(
    positions: NDArray[np.float64], triangles: NDArray[np.int32], least_cosine: float
) -> NDArray[np.float32]: ...
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
