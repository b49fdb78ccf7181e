"""What the viewport shows, without a screen: the pictures that it draws."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="Blender's module bpy is not here: make blender-test")

import blender_scenes as scenes  # noqa: E402

import voxrt  # noqa: E402
from voxrt.views.viewpoint import authored_camera  # noqa: E402

SIZE = (96, 64)

pytestmark = pytest.mark.usefixtures("extension")


@pytest.fixture
def looking():
    """A viewport that looks through a camera."""
    from voxrt_extension.viewport import Looking

    scenes.monkey(material=scenes.paint("skin", (0.6, 0.3, 0.1)))
    scenes.cube((3, 0, 0), scenes.paint("red", (0.8, 0, 0)))
    camera = scenes.link("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (5, -7, 4), (1.15, 0, 0.6)
    bpy.context.view_layer.update()
    bpy.context.scene.voxrt.depth = 6
    projection = camera.calc_matrix_camera(bpy.context.evaluated_depsgraph_get(), x=SIZE[0], y=SIZE[1])
    return Looking(tuple(map(tuple, camera.matrix_world)), tuple(map(tuple, projection)), SIZE)


class Updates:
    """Calls a viewport at every update of the scene, as Blender calls `view_update`."""

    def __init__(self, viewport):
        self.viewport = viewport

    def __enter__(self):
        bpy.app.handlers.depsgraph_update_post.append(self._update)
        return self

    def __exit__(self, *_):
        bpy.app.handlers.depsgraph_update_post.remove(self._update)

    def _update(self, _, depsgraph):
        self.viewport.update(depsgraph)


def whole_picture(looking):
    """The picture of a whole build of the scene as the viewport's dependency graph has it."""
    from voxrt.voxelize.formats.blend.scene import read_depsgraph
    from voxrt.voxelize.formats.blend.views import projected_viewpoint

    scene = read_depsgraph(bpy.context.evaluated_depsgraph_get(), bpy.data.materials, "whole")
    rom = voxrt.build(scene, depth=6).rom
    viewpoint = projected_viewpoint("viewport", np.array(looking.place), looking.projection, SIZE)
    return voxrt.render(rom, authored_camera(viewpoint, rom.grid, SIZE), size=SIZE).colour


def test_an_edit_shows_at_once_and_is_exact_at_rest(looking, monkeypatch):
    from voxrt_extension import viewport

    shown = viewport.Viewport()
    shown.update(bpy.context.evaluated_depsgraph_get())
    shown.look(looking)
    before = shown.view(looking, coarse=False).frame().colour
    np.testing.assert_array_equal(before, whole_picture(looking))
    with Updates(shown):
        bpy.data.objects["Suzanne"].location.x += 0.4
        bpy.context.view_layer.update()
    assert not shown.rest(bpy.context.evaluated_depsgraph_get())  # it has just moved
    moved = shown.view(looking, coarse=False).frame().colour
    assert (moved != before).any()
    monkeypatch.setattr(viewport, "REST_SECONDS", 0.0)
    assert shown.rest(bpy.context.evaluated_depsgraph_get())
    np.testing.assert_array_equal(shown.view(looking, coarse=False).frame().colour, whole_picture(looking))


def test_fewer_pixels_while_something_moves(looking):
    from voxrt_extension.viewport import Viewport

    shown = Viewport()
    shown.update(bpy.context.evaluated_depsgraph_get())
    assert shown.view(looking, coarse=True).frame().material.shape == (32, 48)
    assert shown.view(looking, coarse=False).frame().material.shape == (64, 96)


class Clock:
    """A clock that goes on by a step whenever it is read."""

    now = step = 0.0

    def monotonic(self):
        self.now += self.step
        return self.now


def test_pictures_that_take_long_have_fewer_pixels_while_something_moves(looking, monkeypatch):
    from voxrt_extension import viewport

    shown = viewport.Viewport()
    shown.update(bpy.context.evaluated_depsgraph_get())
    clock = Clock()
    monkeypatch.setattr(viewport, "time", clock)
    heights = []
    for clock.step in (0.5, 0.5, 0.5, 0.05, 0.001, 0.001, 0.001):
        heights.append(shown.frame(looking, coarse=True).material.shape[0])
        assert shown.frame(looking, coarse=False).material.shape == (64, 96)
    assert heights == [32, 16, 8, 8, 8, 16, 32]


@pytest.mark.parametrize("change", ["a new object", "a material", "a setting"])
def test_other_changes_build_the_whole(looking, change):
    from voxrt_extension.viewport import Viewport

    shown = Viewport()
    shown.update(bpy.context.evaluated_depsgraph_get())
    before = shown.view(looking, coarse=False).frame().colour
    with Updates(shown):
        if change == "a new object":
            scenes.cube((1, -2, 0), name="new")
        elif change == "a material":
            shader = bpy.data.materials["red"].node_tree.nodes["Principled BSDF"]
            shader.inputs["Base Color"].default_value = (0, 0, 1, 1)
        else:
            bpy.context.scene.voxrt.depth = 5
        bpy.context.view_layer.update()
    assert (shown.view(looking, coarse=False).frame().colour != before).any()


def test_views_without_perspective_are_not_rendered(looking):
    from msgspec.structs import replace
    from voxrt_extension.viewport import Viewport

    shown = Viewport()
    shown.update(bpy.context.evaluated_depsgraph_get())
    flat = np.array(looking.projection)
    flat[3] = (0, 0, 0, 1)
    assert shown.view(replace(looking, projection=tuple(map(tuple, flat))), coarse=False) is None
