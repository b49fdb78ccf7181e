"""One object of a scene is edited: the voxels are those of a whole build on the same grid."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="Blender's module bpy is not here: make blender-test")

import blender_scenes as scenes  # noqa: E402

import voxrt  # noqa: E402
from voxrt.octree import to_dense  # noqa: E402
from voxrt.voxelize import voxelize  # noqa: E402
from voxrt.voxelize.formats.blend.scene import SceneReader  # noqa: E402

pytestmark = pytest.mark.usefixtures("extension")


def crowd():
    """Things that overlap, of several materials."""
    things = []
    for number in range(8):
        paint = scenes.paint(f"paint {number}", (number / 8, 0.3, 0.5))
        place = (1.7 * (number % 2) + 0.013, 1.9 * (number // 2 % 2), 2.1 * (number // 4))
        one = scenes.monkey(place, paint) if number % 3 else scenes.cube(place, paint)
        one.name = f"thing {number}"
        things.append(one)
    for corner in (-3, 6):
        scenes.cube((corner, corner, corner), scale=(0.1, 0.1, 0.1))
    return things


def opened(options):
    from voxrt_extension.edited_memory import EditedMemory

    depsgraph = bpy.context.evaluated_depsgraph_get()
    reader = SceneReader(bpy.data.materials, "scene")
    scene = reader.scene(depsgraph, "scene")
    result = voxrt.build(scene, options=options)
    return reader, result, EditedMemory(scene, result, options)


def edited(reader, memory, name):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = reader.again(bpy.data.objects[name].evaluated_get(depsgraph))
    return found is not None and memory.replaced(*found)


def whole(grid, options):
    scene = SceneReader(bpy.data.materials, "scene").scene(bpy.context.evaluated_depsgraph_get(), "scene")
    made = voxelize(scene, grid, fill=options.fill_per_object, rule=options.rule, thin=options.thin)
    return voxrt.octree.build(made.voxels), scene.materials


def shown(tree, materials):
    colours = np.array([-1, *(one.colour[0] << 16 | one.colour[1] << 8 | one.colour[2] for one in materials[1:])])
    return colours[to_dense(tree)]


@pytest.mark.parametrize("options", [{}, {"fill": "surface"}, {"fill": "solid"}])
def test_edits_are_those_of_a_whole_build(options):
    options = voxrt.BuildOptions(depth=6, **options)
    things = crowd()
    reader, result, memory = opened(options)
    edits = [
        lambda: setattr(things[1], "location", (1.2, 0.4, 0.3)),
        lambda: setattr(things[4], "rotation_euler", (0.4, 0.5, 0.6)),
        lambda: setattr(things[0], "scale", (0.5, 0.6, 0.4)),
        lambda: things[3].data.vertices[0].co.__imul__(0.5),
        lambda: things[2].data.materials.__setitem__(0, scenes.paint("new", (0, 1, 0))),
    ]
    for number, edit in zip((1, 4, 0, 3, 2), edits, strict=True):
        edit()
        bpy.context.view_layer.update()
        things[number].data.update()
        assert edited(reader, memory, f"thing {number}")
        memory.commit()
        rom = memory.rom()
        tree, materials = whole(result.rom.grid, options)
        np.testing.assert_array_equal(shown(rom.octree, rom.materials), shown(tree, materials))


def test_what_leaves_the_grid_is_cut_off():
    """As in a whole build on the same grid: partly, wholly, and back again."""
    options = voxrt.BuildOptions(depth=5)
    things = crowd()
    reader, result, memory = opened(options)
    for place in ((6.3, 0.4, 0.3), (50, 0, 0), (-2.9, 6.2, -3.1), (1.2, 0.4, 0.3)):
        things[1].location = place
        bpy.context.view_layer.update()
        assert edited(reader, memory, "thing 1")
        memory.commit()
        rom = memory.rom()
        tree, materials = whole(result.rom.grid, options)
        np.testing.assert_array_equal(shown(rom.octree, rom.materials), shown(tree, materials))


def test_new_colours_without_end_need_a_whole_build():
    things = crowd()
    reader, _, memory = opened(voxrt.BuildOptions(depth=4))
    for number in range(300):
        things[2].data.materials[0] = scenes.paint(f"new {number}", (0, number / 300, 1))
        bpy.context.view_layer.update()
        things[2].data.update()
        before = memory._world.rom().octree.words
        if not edited(reader, memory, "thing 2"):
            break
        memory.commit()
    assert 100 < number < 299
    np.testing.assert_array_equal(memory._world.rom().octree.words, before)


def test_what_needs_a_whole_build():
    """An object that is far away, one with a texture, one that is not there; a rule that looks at neighbours."""
    options = voxrt.BuildOptions(depth=5)
    things = crowd()
    reader, _, memory = opened(options)
    things[1].location = (1e6, 0, 0)
    bpy.context.view_layer.update()
    assert not edited(reader, memory, "thing 1")
    things[1].location = (1.2, 0.4, 0.3)
    things[1].data.materials[0] = scenes.textured()[0]
    bpy.context.view_layer.update()
    assert not edited(reader, memory, "thing 1")
    scenes.cube(name="new")
    assert not edited(reader, memory, "new")
    things[2].location.x += 0.1
    bpy.context.view_layer.update()
    assert edited(reader, memory, "thing 2")
    assert not edited(*opened(voxrt.BuildOptions(depth=5, rule="half"))[::2], "thing 2")
