"""Render the pictures of the chapter on Blender into ``docs/pictures``: by F12, in Blender's module bpy.

Usage: ``.venv-blender/bin/python docs/make_blender_pictures.py``, in the environment of ``make blender-test``.
"""

from __future__ import annotations

import importlib.util
import math
import sys
from pathlib import Path
from typing import Any

import bpy
from mathutils import Vector

HERE = Path(__file__).resolve().parent
SIZE = (640, 400)


def extension() -> None:
    """Import the extension's package from its folder, and register it."""
    folder = HERE.parent / "blender"
    spec = importlib.util.spec_from_file_location(
        "voxrt_extension", folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["voxrt_extension"] = module
    spec.loader.exec_module(module)
    module.register()


def picture(name: str, **settings: Any) -> None:
    """Render the scene as the settings say, and save the picture."""
    scene = bpy.context.scene
    scene.render.engine = "VOXRT"
    scene.render.resolution_x, scene.render.resolution_y = SIZE
    scene.render.dither_intensity = 0.0
    scene.view_settings.view_transform = "Standard"  # the colours of the memory, as they are
    for key, value in settings.items():
        setattr(scene.voxrt, key, value)
    bpy.ops.render.render()
    result = sys.modules["voxrt_extension.memory"].LATEST.results[scene.name]
    print(f"{name}: {result!r}")  # noqa: T201
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.render.image_settings.compression = 100
    bpy.data.images["Render Result"].save_render(str(HERE / "pictures" / f"{name}.png"), scene=scene)


def paint(name: str, colour: tuple[float, float, float]) -> Any:
    """Make a material of one linear colour."""
    material = bpy.data.materials.new(name)
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*colour, 1.0)
    return material


def moved_to(collection: Any, one: Any) -> Any:
    """Move an object out of the scene into a collection of its own."""
    bpy.context.scene.collection.objects.unlink(one)
    collection.objects.link(one)
    return one


def tree_collection() -> Any:
    """Make a tree: a trunk, and a crown of a subdivided cube."""
    parts = bpy.data.collections.new("tree")
    bpy.ops.mesh.primitive_cylinder_add(radius=0.12, depth=1.2, location=(0, 0, 0.6))
    moved_to(parts, bpy.context.object).data.materials.append(paint("bark", (0.1, 0.05, 0.02)))
    bpy.ops.mesh.primitive_cube_add(size=1.5, location=(0, 0, 1.7))
    crown = moved_to(parts, bpy.context.object)
    crown.data.materials.append(paint("leaves", (0.06, 0.22, 0.03)))
    crown.modifiers.new("round", "SUBSURF").render_levels = 3
    return parts


def village() -> None:
    """Make a scene of modifiers, instances, a curve as text, a sun and a sky."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_cube_add(size=1, location=(0, 0, -0.1), scale=(12, 9, 0.2))
    bpy.context.object.data.materials.append(paint("grass", (0.12, 0.25, 0.05)))
    trees = tree_collection()
    for x, y, turn in ((-4.5, 2.5, 0.3), (-2.6, 3.2, 1.1), (4.6, 3.0, 2.0), (4.9, -1.2, 0.7), (-5, -1.5, 1.6)):
        copy = bpy.data.objects.new("tree", None)
        copy.instance_type, copy.instance_collection = "COLLECTION", trees
        copy.location, copy.rotation_euler.z = (x, y, 0), turn
        scene.collection.objects.link(copy)
    bpy.ops.mesh.primitive_cube_add(size=2, location=(0.8, 1.5, 1))
    house = bpy.context.object
    house.scale.x = 1.6
    house.data.materials.append(paint("plaster", (0.75, 0.68, 0.52)))
    bpy.ops.mesh.primitive_cylinder_add(vertices=3, radius=1.75, depth=3.5, location=(0.8, 1.5, 2.6))
    roof = bpy.context.object
    roof.rotation_euler = (math.pi / 2, 0, math.pi / 2)
    roof.scale.y = 0.75
    roof.data.materials.append(paint("tiles", (0.45, 0.08, 0.04)))
    bpy.ops.mesh.primitive_monkey_add(size=1.6, location=(-2.2, -1.4, 1.4), rotation=(-0.3, 0, 0.2))
    bpy.context.object.data.materials.append(paint("bronze", (0.35, 0.2, 0.06)))
    bpy.context.object.modifiers.new("round", "SUBSURF").render_levels = 2
    bpy.ops.mesh.primitive_cube_add(size=1, location=(-2.2, -1.4, 0.35), scale=(1, 1, 0.7))
    bpy.context.object.data.materials.append(paint("stone", (0.3, 0.3, 0.32)))
    bpy.ops.object.text_add(location=(0.4, -2.4, 0), rotation=(math.pi / 2, 0, 0))
    text = bpy.context.object
    text.data.body, text.data.extrude, text.data.size = "voxrt", 0.12, 1.5
    text.data.materials.append(paint("blue", (0.02, 0.12, 0.4)))
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.rotation_euler = (0.7, 0.2, -0.6)
    scene.collection.objects.link(sun)
    world = bpy.data.worlds.new("world")
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.45, 0.62, 0.8, 1)
    scene.world = world
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location = (-3.5, -12.5, 6.2)
    camera.rotation_euler = (Vector((0, 0.3, 0.9)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = 38
    scene.collection.objects.link(camera)
    scene.camera = camera


def main() -> None:
    """Render all pictures."""
    extension()
    bpy.ops.wm.read_factory_settings()
    picture("blender-cube", depth=6)
    village()
    picture("blender-village", depth=8, samples="2")
    picture("blender-village-baked", depth=8, bake=True, samples="2")
    picture("blender-village-board", depth=8, bake=False, budget="ulx3s-12f", samples="2")


if __name__ == "__main__":
    main()
