# The manual of these functions is the headers in src/.
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

_Corner: TypeAlias = tuple[int, int, int]

class Verdict(NamedTuple):
    fault: str
    address: int
    least_depth: int

class Bounds(NamedTuple):
    low: _Corner
    high: _Corner

class Difference(NamedTuple):
    appeared: int
    vanished: int
    recoloured: int
    bounds: Bounds | None

class Regions(NamedTuple):
    low: NDArray[np.int64]
    high: NDArray[np.int64]
    appeared: NDArray[np.uint64]
    vanished: NDArray[np.uint64]
    recoloured: NDArray[np.uint64]

class SurfaceChange(NamedTuple):
    surface: int
    changed: int

class Leaves(NamedTuple):
    corners: NDArray[np.int32]
    levels: NDArray[np.uint8]
    materials: NDArray[np.uint8]

def build(
    depth: int,
    brick_codes: NDArray[np.uint64],
    brick_masks: NDArray[np.uint64],
    brick_materials: NDArray[np.uint8],
    brick_rows: NDArray[np.int32],
    cells: NDArray[np.uint8],
    octant_codes: NDArray[np.uint64],
    octant_levels: NDArray[np.uint8],
    octant_materials: NDArray[np.uint8],
    threads: int,
) -> NDArray[np.uint32]: ...
def build_dense(cells: NDArray[np.uint8], depth: int) -> NDArray[np.uint32]: ...
def build_points(codes: NDArray[np.uint64], materials: NDArray[np.uint8], depth: int) -> NDArray[np.uint32]: ...
def validate(words: NDArray[np.uint32], depth: int) -> Verdict: ...
def materials_at(words: NDArray[np.uint32], depth: int, points: NDArray[np.int64]) -> NDArray[np.uint8]: ...
def leaf_counts(words: NDArray[np.uint32], depth: int) -> NDArray[np.uint64]: ...
def count_in_box(words: NDArray[np.uint32], depth: int, low: _Corner, high: _Corner) -> NDArray[np.uint64]: ...
def solid_bounds(words: NDArray[np.uint32], depth: int) -> Bounds | None: ...
def fill_region(words: NDArray[np.uint32], depth: int, low: _Corner, region: NDArray[np.uint8]) -> None: ...
def diff(first: NDArray[np.uint32], second: NDArray[np.uint32], depth: int) -> Difference: ...
def differing_regions(first: NDArray[np.uint32], second: NDArray[np.uint32], depth: int) -> Regions: ...
def coarsen(words: NDArray[np.uint32], depth: int, level: int) -> NDArray[np.uint32]: ...
def fit_bricks(
    words: NDArray[np.uint32],
    hidden: NDArray[np.uint32],
    depth: int,
    finest: int,
    same_axis: NDArray[np.uint32],
    other_axis: NDArray[np.uint32],
    occlusion: NDArray[np.uint32],
    limit: int,
) -> list[NDArray[np.uint32]]: ...
def mem_text(words: NDArray[np.uint32], threads: int = 0) -> bytes: ...
def mem_text_crc32(words: NDArray[np.uint32], before: int = 0, threads: int = 0) -> int: ...
def read_mem_text(text: bytes) -> NDArray[np.uint32] | None: ...
def surface_change(first: NDArray[np.uint32], second: NDArray[np.uint32], depth: int) -> SurfaceChange: ...
def hidden_voxels(words: NDArray[np.uint32], depth: int) -> NDArray[np.uint32]: ...
def fill_hidden(
    words: NDArray[np.uint32], hidden: NDArray[np.uint32], depth: int, material: int
) -> NDArray[np.uint32]: ...
def share_hidden(words: NDArray[np.uint32], hidden: NDArray[np.uint32], depth: int) -> NDArray[np.uint32]: ...

class Assembly:
    def __init__(self, depth: int) -> None: ...
    def add(self, words: NDArray[np.uint32]) -> None: ...
    def words(self) -> NDArray[np.uint32]: ...

class DiskAssembly:
    def __init__(self, depth: int, folder: bytes, cache_bytes: int) -> None: ...
    def add(self, words: NDArray[np.uint32]) -> None: ...
    def write(self, path: bytes) -> int: ...

class LeafWalk:
    def __init__(
        self, words: NDArray[np.uint32], depth: int, low: _Corner, high: _Corner, solid_only: bool
    ) -> None: ...
    def next(self, limit: int) -> Leaves: ...
