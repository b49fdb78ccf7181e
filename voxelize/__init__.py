"""Assets to voxels: loaders, the scene, the grid, colliders and the native voxelizer.

The scene frame is right-handed, in metres, y up. :func:`load` reads a file into a :class:`Scene`, :func:`fit_grid` fits
a :class:`Grid` to it, :func:`assign_colours` gives textured surfaces materials, :func:`voxelize` returns the voxels.
:mod:`voxrt.voxelize.authoring` makes scenes in Python.
"""

from importlib import import_module
from pkgutil import extend_path
from typing import TYPE_CHECKING

__path__ = extend_path(__path__, __name__)

from voxrt.voxelize.collider_shapes import BoxCollider, Collider, HullCollider, MeshCollider, SphereCollider
from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.corner_normals import CornerNormals
from voxrt.voxelize.errors import AssetError, DoesNotFitError, SceneWarning
from voxrt.voxelize.grid import Grid
from voxrt.voxelize.materials import DEFAULT_COLOUR, EMPTY, MATERIAL_LIMIT, Material
from voxrt.voxelize.mesh import MaterialMap, Mesh
from voxrt.voxelize.scene import PointLight, Scene, SceneObject, Viewpoint

__all__ = [
    "DEFAULT_COLOUR",
    "DEFAULT_COLOURS",
    "EMPTY",
    "MATERIAL_LIMIT",
    "Appearance",
    "AssetError",
    "BlockVoxelizer",
    "BoxCollider",
    "Collider",
    "ColumnBlock",
    "CornerNormals",
    "DoesNotFitError",
    "Grid",
    "HullCollider",
    "Material",
    "MaterialMap",
    "Mesh",
    "MeshCollider",
    "ObjectMode",
    "ObjectReport",
    "PointLight",
    "Scene",
    "SceneFrames",
    "SceneObject",
    "SceneWarning",
    "SphereCollider",
    "SurfaceAppearance",
    "Texture",
    "Viewpoint",
    "Voxelization",
    "VoxelizationReport",
    "Voxels",
    "assign_colours",
    "fit_grid",
    "join_scenes",
    "load",
    "voxelize",
    "voxelize_in_blocks",
]

# What works on scenes is imported when it is first used: a process that only makes a scene does not wait for it.
_HOMES = {
    "voxrt.voxelize.assets": ("load",),
    "voxrt.voxelize.block_voxelizer": ("BlockVoxelizer", "ColumnBlock", "voxelize_in_blocks"),
    "voxrt.voxelize.colour.voxel_colours": ("DEFAULT_COLOURS", "assign_colours"),
    "voxrt.voxelize.grid_fitting": ("fit_grid",),
    "voxrt.voxelize.scene_frames": ("SceneFrames", "join_scenes"),
    "voxrt.voxelize.voxelizer": ("voxelize",),
    "voxrt.voxelize.voxels": ("ObjectMode", "ObjectReport", "Voxelization", "VoxelizationReport", "Voxels"),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

if TYPE_CHECKING:  # type checkers see these names and no others
    from voxrt.voxelize.assets import load
    from voxrt.voxelize.block_voxelizer import BlockVoxelizer, ColumnBlock, voxelize_in_blocks
    from voxrt.voxelize.colour.voxel_colours import DEFAULT_COLOURS, assign_colours
    from voxrt.voxelize.grid_fitting import fit_grid
    from voxrt.voxelize.scene_frames import SceneFrames, join_scenes
    from voxrt.voxelize.voxelizer import voxelize
    from voxrt.voxelize.voxels import ObjectMode, ObjectReport, Voxelization, VoxelizationReport, Voxels
else:

    def __getattr__(name: str) -> object:
        if name in _HOME:
            return getattr(import_module(_HOME[name]), name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
