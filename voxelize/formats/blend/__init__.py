"""Scenes of Blender to a :class:`~voxrt.voxelize.scene.Scene`. The modules but ``isolated`` need ``bpy``."""
