"""glTF 2.0 and GLB to a :class:`~voxrt.voxelize.scene.Scene`: a reader of our own over NumPy accessors."""

from voxrt.voxelize.formats.gltf.load import load_gltf

__all__ = ["load_gltf"]
