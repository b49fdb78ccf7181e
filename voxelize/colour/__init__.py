"""Colours of surfaces: sRGB and linear light, textures, palettes, the material of each voxel."""
