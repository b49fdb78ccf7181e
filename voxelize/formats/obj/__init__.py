"""Wavefront OBJ with its MTL material libraries.

An OBJ file is read as arrays of bytes: one pass finds the lines, one parse reads the numbers of all vertices, another
those of all faces. The time depends on the file's size and hardly on its number of lines.
"""

from voxrt.voxelize.formats.obj.load import load_obj

__all__ = ["load_obj"]
