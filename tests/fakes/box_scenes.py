"""Scenes of boxes for devices, and the pictures that they must show: those of the exact model."""

from __future__ import annotations

import numpy as np
from oracles import worlds
from oracles.cuts import memory_of

from voxrt.board.scene import Scene
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import View, frame_world
from voxrt.octree.words import EMPTY


def ignore(_stage, _done, _total):
    """Take no notice of progress."""


def scene_of(words, depth, seed=1):
    """A scene in colours of its own."""
    colours = np.random.default_rng(seed).integers(40, 256, (256, 3), dtype=np.uint8)
    return Scene(f"world {seed}", depth, words, colours, np.zeros(256, dtype=bool))


def boxes(seed, depth=4, words=0):
    """Four boxes; blocks that nothing points to make the memory `words` long."""
    used = memory_of(worlds.boxes(depth, 4, seed))
    rest = max(0, words - len(used)) // 8 * 8
    return scene_of(np.concatenate([used, np.full(rest, EMPTY, dtype=np.uint32)]), depth, seed)


def view_of(scene, size):
    return View(frame_world(scene.depth, size), size, scene.background)


def picture_of(scene, view):
    """The picture of the exact model, which holds nothing but this scene."""
    model = ModelDevice()
    SceneMemory(model).load(scene, ignore)
    return model.frame(view).colour
