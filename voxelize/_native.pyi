# The manual of these functions is their docstrings, in src/module.cpp.
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Arrays: TypeAlias = tuple[
    NDArray[np.uint64],
    NDArray[np.uint64],
    NDArray[np.uint8],
    NDArray[np.int32],
    NDArray[np.uint8],
    NDArray[np.uint64],
    NDArray[np.uint8],
    NDArray[np.uint8],
    NDArray[np.int64],
    NDArray[np.uint8],
    NDArray[np.int64],
    dict[str, float],
]

class OutOfReachError(ValueError): ...

def voxelize(
    depth: int,
    meshes: list[
        tuple[
            NDArray[np.float64],
            NDArray[np.int32],
            NDArray[np.uint8],
            NDArray[np.int32],
            NDArray[np.float32],
            NDArray[np.uint8],
        ]
    ],
    kinds: NDArray[np.uint8],
    mesh_of: NDArray[np.int32],
    frames: NDArray[np.float64],
    materials: NDArray[np.uint8],
    objects_of: NDArray[np.int32],
    objects: int,
    fill: bool,
    threads: int,
) -> Arrays: ...
def convex_hull(positions: NDArray[np.float64], frame: NDArray[np.float64]) -> NDArray[np.int32]: ...
