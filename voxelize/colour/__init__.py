"""Colours of surfaces: sRGB and linear light, textures, surface appearance, palettes, colours per voxel."""
