"""The reader of evaluated scenes, held against Blender's own glTF export, read by our loader."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="Blender's module bpy is not here: make blender-test")

import voxrt  # noqa: E402
from blender import scenes  # noqa: E402
from voxrt.voxelize.formats.blend.rendered import as_rendered  # noqa: E402
from voxrt.voxelize.formats.blend.scene import read_depsgraph  # noqa: E402

# What glTF cannot express, or Blender's exporter leaves out by default: hair particles have no mesh there.
NOT_IN_GLTF = {"particles"}


def read(name="scene", **options):
    return as_rendered(
        bpy.context.scene,
        bpy.context.view_layer,
        lambda depsgraph: read_depsgraph(depsgraph, bpy.data.materials, name, **options),
    )


def shown_colours(scene, bounds, depth=6):
    """The sRGB colour of each voxel, -1 for empty ones."""
    built = voxrt.build(scene, depth=depth, bounds=bounds)
    colours = [material.colour for material in built.rom.materials]
    table = np.array([-1, *(red << 16 | green << 8 | blue for red, green, blue in colours[1:])])
    return table[built.to_dense()]


def bounds_of(scene):
    points = np.concatenate(
        [
            one.mesh.positions[np.unique(one.mesh.triangles)] @ one.transform[:3, :3].T + one.transform[:3, 3]
            for one in scene.objects
        ]
    )
    # Off the corners of what is in it: a face on a grid plane would be decided by the last bit of a float32.
    low, high = points.min(axis=0) - 0.0123, points.max(axis=0) + 0.0171
    return (*low.tolist(), *high.tolist())


@pytest.mark.parametrize("name", [name for name in scenes.SCENES if name not in NOT_IN_GLTF])
def test_voxels_are_those_of_the_gltf_export(name, tmp_path):
    scenes.empty_file()
    scenes.SCENES[name]()
    ours = read()
    # The exporter evaluates as the viewport does.
    for one in bpy.data.objects:
        for modifier in one.modifiers:
            if modifier.type == "SUBSURF":
                modifier.levels = modifier.render_levels
    path = tmp_path / "scene.glb"
    bpy.ops.export_scene.gltf(
        filepath=str(path),
        export_apply=True,
        export_extras=True,
        export_gn_mesh=True,
        use_renderable=True,
        export_skins=False,
        export_morph=False,
    )
    theirs = voxrt.load(path)
    bounds = bounds_of(ours)
    np.testing.assert_array_equal(shown_colours(ours, bounds), shown_colours(theirs, bounds))
