"""Assets to voxels: loaders, the scene, the grid, colliders and the native voxelizer."""

from pkgutil import extend_path

__path__ = extend_path(__path__, __name__)

from voxrt.voxelize.errors import AssetError, DoesNotFitError, SceneWarning
from voxrt.voxelize.grid import Grid, fit_grid
from voxrt.voxelize.load import load
from voxrt.voxelize.paint import Coat, Paint
from voxrt.voxelize.scene import (
    DEFAULT_COLOUR,
    EMPTY,
    MATERIAL_LIMIT,
    BoxCollider,
    Collider,
    HullCollider,
    Material,
    Mesh,
    MeshCollider,
    PointLight,
    Scene,
    SceneObject,
    SphereCollider,
    Tints,
    Viewpoint,
)
from voxrt.voxelize.texture import Texture
from voxrt.voxelize.tint import DEFAULT_COLOURS, tint
from voxrt.voxelize.voxelize import voxelize
from voxrt.voxelize.voxels import ObjectMode, ObjectReport, Voxelization, Voxels

__all__ = [
    "DEFAULT_COLOUR",
    "DEFAULT_COLOURS",
    "EMPTY",
    "MATERIAL_LIMIT",
    "AssetError",
    "BoxCollider",
    "Coat",
    "Collider",
    "DoesNotFitError",
    "Grid",
    "HullCollider",
    "Material",
    "Mesh",
    "MeshCollider",
    "ObjectMode",
    "ObjectReport",
    "Paint",
    "PointLight",
    "Scene",
    "SceneObject",
    "SceneWarning",
    "SphereCollider",
    "Texture",
    "Tints",
    "Viewpoint",
    "Voxelization",
    "Voxels",
    "fit_grid",
    "load",
    "tint",
    "voxelize",
]
