"""Scenes written by people: in Python (:mod:`~voxrt.voxelize.authoring.author`) and as ``scene.toml``."""
