"""Readers of asset files: one folder per format, each ends in a :class:`~voxrt.voxelize.scene.Scene`."""
