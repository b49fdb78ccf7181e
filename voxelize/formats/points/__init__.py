"""Point clouds: rows of numbers, and what laser scanners give (LAS)."""

from voxrt.voxelize.formats.points.las import load_las
from voxrt.voxelize.formats.points.xyz import load_xyz

__all__ = ["load_las", "load_xyz"]
