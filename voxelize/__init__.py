"""Assets to voxels: loaders, the scene, the grid, colliders and the native voxelizer.

The scene frame is right-handed, in metres, y up. :func:`load` reads a file into a :class:`Scene`, :func:`fit_grid` fits
a :class:`Grid` to it, :func:`assign_colours` gives textured surfaces materials, :func:`voxelize` returns the voxels.
:mod:`voxrt.voxelize.authoring` makes scenes in Python.
"""

from voxrt.exports import exports_of

__getattr__, __dir__ = exports_of(__name__)
