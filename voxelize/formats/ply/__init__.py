"""PLY, ASCII and binary of both byte orders."""

from voxrt.voxelize.formats.ply.load import load_ply

__all__ = ["load_ply"]
