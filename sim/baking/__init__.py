"""Baked light: the colours that surface voxels have under a sun and a sky."""
