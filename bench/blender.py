"""Benchmark of Blender's scenes: reading, building, and the time until an edit shows in the viewport.

Usage: ``.venv-blender/bin/python bench/blender.py [--write] [--depth 9]``, in the environment of ``make blender-test``.
The scene has a million triangles in 1,000 instances of one mesh. An edit moves one of them, some beyond the grid's
border; its picture has at most a quarter of the pixels of a viewport of 960x540, as while one moves things, and then
all of them. Medians of the wall clock; the time of the processor, of all threads together, tells what other work on the
machine does to them. ``--write`` puts the table into ``bench/results/blender.md`` as well.
"""

from __future__ import annotations

import importlib.util
import statistics
import sys
import time
from typing import TYPE_CHECKING, Any

import bpy
from report import ROOT, machine, options_of, publish, table

import voxrt
from voxrt.voxelize.formats.blend.rendered import as_rendered
from voxrt.voxelize.formats.blend.scene import read_depsgraph

if TYPE_CHECKING:
    from collections.abc import Callable

INSTANCES = 1000
SIZE = (960, 540)
EDITS = 20


def extension() -> Any:
    """Import the extension's package from its folder, and register it."""
    folder = ROOT / "blender"
    spec = importlib.util.spec_from_file_location(
        "voxrt_extension", folder / "__init__.py", submodule_search_locations=[str(folder)]
    )
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["voxrt_extension"] = module
    spec.loader.exec_module(module)
    module.register()
    return module


def fill_file() -> list[Any]:
    """Put 1,000 tori of 1,000 triangles each into an empty file, ten along each axis, and a camera."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.mesh.primitive_torus_add(major_segments=25, minor_segments=20, major_radius=1, minor_radius=0.35)
    first = bpy.context.object
    things = [first]
    scene = bpy.context.scene
    for number in range(1, INSTANCES):
        one = bpy.data.objects.new(f"torus {number}", first.data)
        one.location = (number % 10 * 2.8, number // 10 % 10 * 2.8, number // 100 * 2.8)
        one.rotation_euler = (number, number * 0.7, number * 0.3)
        scene.collection.objects.link(one)
        things.append(one)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (13, -40, 14), (1.5708, 0, 0)
    scene.collection.objects.link(camera)
    scene.camera = camera
    bpy.context.view_layer.update()
    return things


def timed(work: Callable[[], Any]) -> tuple[Any, float, float]:
    """Return what work gives, the seconds of the wall clock, and those of the processor."""
    wall, cpu = time.perf_counter(), time.process_time()
    found = work()
    return found, time.perf_counter() - wall, time.process_time() - cpu


def measured_edits(things: list[Any]) -> list[list[tuple[float, float]]]:
    """Return wall and processor seconds of each edit: of its memory, of a coarse picture and of a full one."""
    from voxrt_extension.viewport import Looking, Viewport  # noqa: PLC0415 - imported above

    camera = bpy.context.scene.camera
    projection = camera.calc_matrix_camera(bpy.context.evaluated_depsgraph_get(), x=SIZE[0], y=SIZE[1])
    looking = Looking(tuple(map(tuple, camera.matrix_world)), tuple(map(tuple, projection)), SIZE)
    shown = Viewport()
    shown.update(bpy.context.evaluated_depsgraph_get())
    rows: list[list[tuple[float, float]]] = [[], [], []]

    def update(_: Any, depsgraph: Any) -> None:
        spent = [timed(lambda: shown.update(depsgraph))[1:]]
        spent += [timed(lambda coarse=coarse: shown.frame(looking, coarse=coarse))[1:] for coarse in (True, False)]
        for row, one in zip(rows, spent, strict=True):
            row.append(one)

    bpy.app.handlers.depsgraph_update_post.append(update)
    for number in range(EDITS):
        things[400 + 7 * number].location.x += 0.2
        bpy.context.view_layer.update()
    bpy.app.handlers.depsgraph_update_post.remove(update)
    return rows


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--depth", type=int, default=9)
    options = parser.parse_args()
    extension()
    things = fill_file()
    bpy.context.scene.voxrt.depth = options.depth
    rows = []

    def row(what: str, wall: float, cpu: float) -> None:
        rows.append((what, f"{wall:.3f}", f"{cpu:.3f}"))

    def read() -> Any:
        return as_rendered(
            bpy.context.scene,
            bpy.context.view_layer,
            lambda depsgraph: read_depsgraph(depsgraph, bpy.data.materials, "tori"),
        )

    scene, *spent = timed(read)
    row("read the scene as a render shows it", *spent)
    built, *spent = timed(lambda: voxrt.build(scene, depth=options.depth))
    row(f"build it at depth {options.depth}", *spent)
    edits = measured_edits(things)
    names = (
        "an edit: the memory",
        f"its picture of {SIZE[0] // 2}x{SIZE[1] // 2} or less",
        f"its picture of {SIZE[0]}x{SIZE[1]}",
    )
    for name, spent in zip(names, edits, strict=True):
        row(name, *(statistics.median(one) for one in zip(*spent, strict=True)))
    until = [tuple(map(sum, zip(memory, picture, strict=True))) for memory, picture, _ in zip(*edits, strict=True)]
    row("the slowest edit with its smaller picture", *max(until))
    triangles = sum(len(one.mesh.triangles) for one in scene.objects)
    page = (
        "# Scenes of Blender\n\n"
        f"{len(scene.objects):,} instances, {triangles:,} triangles, {built.solid_voxels:,} voxels, "
        f"{len(built.octree.words):,} words. Blender {bpy.app.version_string}; {machine()}. Seconds:\n\n"
        + table(("", "wall", "processor"), rows, left=1)
    )
    publish("blender.md", page, write=options.write)


if __name__ == "__main__":
    main()
