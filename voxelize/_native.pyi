# The manual of these functions is their docstrings, in src/bindings.
from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

INSTRUCTION_SETS: tuple[str, ...]
OBJECT_MODES: tuple[str, ...]

Corner: TypeAlias = tuple[float, float, float]
Cloud: TypeAlias = tuple[NDArray[np.floating], NDArray[np.int32], NDArray[np.float64]]

MaterialFields: TypeAlias = tuple[str, tuple[int, int, int], bool, bool]
TextureArrays: TypeAlias = tuple[NDArray[np.uint8], int, int, bool]
AppearanceFields: TypeAlias = tuple[str, tuple[float, float, float, float], TextureArrays | None, float, bool]
SurfaceArrays: TypeAlias = tuple[
    Sequence[AppearanceFields], NDArray[np.int32], NDArray[np.floating], NDArray[np.floating]
]
FileMeshArrays: TypeAlias = tuple[NDArray[np.floating], NDArray[np.int32], NDArray[np.uint8], SurfaceArrays | None]
VariedMeshArrays: TypeAlias = tuple[NDArray[np.floating], NDArray[np.int32], NDArray[np.uint8], SurfaceArrays]
RasterArrays: TypeAlias = tuple[NDArray[np.int32], NDArray[np.float32], NDArray[np.uint8], NDArray[np.uint8]]

class OutOfRangeError(ValueError): ...
class UnfitSceneError(ValueError): ...
class TooManyMaterialsError(ValueError): ...

class MaterialTable:
    def __init__(self, name: str, colour: tuple[int, int, int]) -> None: ...
    def add(self, name: str, colour: tuple[int, int, int], mirror: bool, authored: bool) -> int: ...
    def entries(self) -> list[MaterialFields]: ...

class MeshArrays(NamedTuple):
    positions: NDArray[np.float64]
    triangles: NDArray[np.int32]
    materials: NDArray[np.uint8]
    raster_sizes: NDArray[np.int32]
    raster_coordinates: NDArray[np.float32]
    raster_materials: NDArray[np.uint8]

class Voxelized(NamedTuple):
    brick_codes: NDArray[np.uint64]
    brick_masks: NDArray[np.uint64]
    brick_materials: NDArray[np.uint8]
    brick_rows: NDArray[np.int32]
    cells: NDArray[np.uint8]
    octant_codes: NDArray[np.uint64]
    octant_levels: NDArray[np.uint8]
    octant_materials: NDArray[np.uint8]
    object_voxels: NDArray[np.int64]
    object_modes: NDArray[np.uint8]
    object_notes: NDArray[np.int64]
    seconds: dict[str, float]

class SceneParts:
    def __init__(
        self,
        depth: int,
        meshes: list[MeshArrays],
        kinds: NDArray[np.uint8],
        mesh_of: NDArray[np.int32],
        frames: NDArray[np.float64],
        materials: NDArray[np.uint8],
        objects_of: NDArray[np.int32],
        rules: NDArray[np.uint8],
        fills: NDArray[np.uint8],
    ) -> None: ...

def voxelize(parts: SceneParts, thin: str, threads: int, instructions: str = "") -> Voxelized: ...

class VoxelVolumes(NamedTuple):
    objects: NDArray[np.uint32]
    voxels: NDArray[np.int32]
    volumes: NDArray[np.float64]
    whole: NDArray[np.int64]
    known: NDArray[np.uint8]

def find_volumes(parts: SceneParts, threads: int, instructions: str = "") -> VoxelVolumes: ...

class VoxelBlock(NamedTuple):
    brick_codes: NDArray[np.uint64]
    brick_masks: NDArray[np.uint64]
    brick_materials: NDArray[np.uint8]
    brick_rows: NDArray[np.int32]
    cells: NDArray[np.uint8]
    octant_codes: NDArray[np.uint64]
    octant_levels: NDArray[np.uint8]
    octant_materials: NDArray[np.uint8]
    object_tallies: NDArray[np.int64]

class BlockVoxelizer:
    def __init__(self, parts: SceneParts, thin: str, threads: int, wanted: NDArray[np.uint8]) -> None: ...
    def use_threads(self, threads: int) -> None: ...
    def blocks(self, block_side: int) -> NDArray[np.int32]: ...
    def objects_of(self, x: int, y: int, block_side: int) -> NDArray[np.uint8]: ...
    def block(self, x: int, y: int, block_side: int) -> VoxelBlock: ...
    def report(self, tallies: NDArray[np.int64]) -> Voxelized: ...

def convex_hull(positions: NDArray[np.float64], frame: NDArray[np.float64]) -> NDArray[np.int32]: ...
def scene_bounds(clouds: Sequence[Cloud], hidden: int) -> tuple[Corner, Corner]: ...
def projected_areas(cloud: Cloud) -> tuple[list[float], Corner, Corner]: ...
def areas_by_place(clouds: Sequence[Cloud], bins: int) -> tuple[NDArray[np.float64], float]: ...
def fit_grid(low: Corner, high: Corner, depth: int) -> tuple[Corner, float]: ...
def longest_side(low: Corner, high: Corner) -> float: ...
def placed_vertices(positions: NDArray[np.float64], triangles: NDArray[np.int32]) -> NDArray[np.float64]: ...
def object_warnings(
    voxels: NDArray[np.int64],
    modes: NDArray[np.uint8],
    notes: NDArray[np.int64],
    names: Sequence[str],
    reported: Sequence[bool],
) -> list[tuple[str, str, int]]: ...
def sample_surface(
    surface: SurfaceArrays, triangles: NDArray[np.int64], weights: NDArray[np.float64]
) -> NDArray[np.float64]: ...
def visible_triangles(surface: SurfaceArrays) -> NDArray[np.uint8]: ...
def halved_image(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]: ...
def assign_materials(
    meshes: Sequence[FileMeshArrays], table: MaterialTable
) -> list[tuple[NDArray[np.uint8], NDArray[np.int32], int]]: ...
def assign_colours(
    meshes: Sequence[VariedMeshArrays],
    objects: Sequence[tuple[int, NDArray[np.float64]]],
    materials: Sequence[MaterialFields],
    used: Sequence[bool],
    voxel_size: float,
    colours: int,
) -> tuple[list[MaterialFields], list[RasterArrays]]: ...
def quantize(
    colours: NDArray[np.uint8], weights: NDArray[np.float64], count: int
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]: ...
def srgb_from_linear(linear: NDArray[np.float64]) -> NDArray[np.uint8]: ...
def linear_of_srgb() -> NDArray[np.float64]: ...
