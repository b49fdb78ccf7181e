"""STL, binary and ASCII."""

from voxrt.voxelize.formats.stl.load import load_stl

__all__ = ["load_stl"]
