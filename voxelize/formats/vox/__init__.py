"""MagicaVoxel ``.vox`` files."""

from voxrt.voxelize.formats.vox.load import VoxScene, load_vox

__all__ = ["VoxScene", "load_vox"]
