"""Memories of scenes: what a dependency graph shows, built as its scene's settings say."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import bpy

import voxrt
from voxrt.voxelize.formats.blend.rendered import as_rendered
from voxrt.voxelize.formats.blend.scene import read_depsgraph
from voxrt.voxelize.formats.blend.views import read_daylight

from .settings import build_options


@dataclass(frozen=True, slots=True)
class Animation:
    """The memory of an animation, and the frames that it holds."""

    result: voxrt.BuildResult
    first: int
    step: int

    def root(self, frame: int) -> int | None:
        """Return the root of a frame of Blender; None where the memory has no such frame."""
        assert self.result.animation is not None
        number, rest = divmod(frame - self.first, self.step)
        roots = self.result.animation.roots
        return roots[number] if rest == 0 and 0 <= number < len(roots) else None


class Latest:
    """What was built last, by the name of the scene: panels show it, and exports write it."""

    def __init__(self) -> None:
        self.results: dict[str, voxrt.BuildResult] = {}
        self.animations: dict[str, Animation] = {}


LATEST = Latest()


def scene_name(scene: Any) -> str:
    """Return what the memory of a scene is called: the file's name, else the scene's."""
    return Path(bpy.data.filepath).stem or str(scene.name)


def build_depsgraph(depsgraph: Any) -> voxrt.BuildResult:
    """Build the memory of what a dependency graph shows.

    Raise AssetError or DoesNotFitError, as :func:`voxrt.build` does.
    """
    scene = depsgraph.scene.original
    read = read_depsgraph(depsgraph, bpy.data.materials, scene_name(scene))
    result = voxrt.build(read, options=build_options(scene, read_daylight(depsgraph)))
    LATEST.results[scene.name] = result
    return result


def build_scene(context: Any) -> voxrt.BuildResult:
    """Build the memory of what a render of the context's scene shows."""
    return as_rendered(context.scene, context.view_layer, build_depsgraph)


def build_animation(context: Any) -> Animation:
    """Build one memory of all frames of the scene's range; the scene stays at its frame."""
    scene = context.scene
    before = scene.frame_current
    scenes = []
    try:
        for frame in range(scene.frame_start, scene.frame_end + 1, scene.frame_step):
            scene.frame_set(frame)
            name = f"{scene_name(scene)}_{frame}"
            read = partial(read_depsgraph, named=bpy.data.materials, name=name)
            scenes.append(as_rendered(scene, context.view_layer, read))
        light = as_rendered(scene, context.view_layer, read_daylight)
    finally:
        scene.frame_set(before)
    result = voxrt.build_animation(scenes, options=build_options(scene, light))
    made = Animation(result, scene.frame_start, scene.frame_step)
    LATEST.animations[scene.name] = made
    return made
