"""MagicaVoxel ``.vox`` files: voxels as their author placed and coloured them."""

from voxrt.voxelize.formats.vox.load import VoxScene, load_vox

__all__ = ["VoxScene", "load_vox"]
