"""Assets to voxels: loaders, the scene, the grid, colliders and the native voxelizer.

The scene frame is right-handed, in metres, y up. :func:`load` reads a file into a :class:`Scene`, :func:`fit_grid` fits
a :class:`Grid` to it, :func:`assign_colours` gives textured surfaces materials, :func:`voxelize` returns the voxels.
:mod:`voxrt.voxelize.authoring` makes scenes in Python.
"""

from pkgutil import extend_path

__path__ = extend_path(__path__, __name__)

from voxrt.voxelize.assets import load
from voxrt.voxelize.collider_shapes import BoxCollider, Collider, HullCollider, MeshCollider, SphereCollider
from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.colour.voxel_colours import DEFAULT_COLOURS, assign_colours
from voxrt.voxelize.errors import AssetError, DoesNotFitError, SceneWarning
from voxrt.voxelize.grid import Grid
from voxrt.voxelize.grid_fitting import fit_grid
from voxrt.voxelize.materials import DEFAULT_COLOUR, EMPTY, MATERIAL_LIMIT, Material
from voxrt.voxelize.mesh import MaterialMap, Mesh
from voxrt.voxelize.scene import PointLight, Scene, SceneObject, Viewpoint
from voxrt.voxelize.voxelizer import voxelize
from voxrt.voxelize.voxels import ObjectMode, ObjectReport, Voxelization, Voxels

__all__ = [
    "DEFAULT_COLOUR",
    "DEFAULT_COLOURS",
    "EMPTY",
    "MATERIAL_LIMIT",
    "Appearance",
    "AssetError",
    "BoxCollider",
    "Collider",
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
    "SceneObject",
    "SceneWarning",
    "SphereCollider",
    "SurfaceAppearance",
    "Texture",
    "Viewpoint",
    "Voxelization",
    "Voxels",
    "assign_colours",
    "fit_grid",
    "load",
    "voxelize",
]
