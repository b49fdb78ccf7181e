"""The render engine "voxrt": F12, and the viewport while one edits."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

import bpy
import numpy as np

import voxrt
from voxrt.views.viewpoint import ViewpointError, authored_camera
from voxrt.voxelize.formats.blend.views import read_viewpoint
from voxrt.voxelize.warning_log import WarningLog

from .memory import LATEST, build_depsgraph
from .pictures import View, combined, material_index
from .viewport import REST_SECONDS, Looking, Viewport, draw

ERRORS = (voxrt.AssetError, voxrt.DoesNotFitError, voxrt.SimulatorError, ViewpointError, ValueError)
"""What a scene can do wrong: one line each."""

_MATERIAL_PASSES = ("Material Index", "IndexMA")  # its name in Blender 5, and before


class VoxrtEngine(bpy.types.RenderEngine):
    """Renders the octree memory of a scene by the exact model of the hardware."""

    bl_idname = "VOXRT"
    bl_label = "voxrt"
    bl_use_preview = False
    bl_use_eevee_viewport = True  # materials are shown by EEVEE until the view is "Rendered"
    bl_use_shading_nodes_custom = False

    def render(self, depsgraph: Any) -> None:
        """Render a picture with its passes."""
        try:
            view = final_view(depsgraph, self)
            frame = view.frame()
        except ERRORS as error:
            self.report({"ERROR"}, f"voxrt: {error}")
            return
        if self.test_break():
            return
        width, height = view.size
        result = self.begin_result(0, 0, width, height)
        passes = {one.name: one for one in result.layers[0].passes}
        _fill(passes["Combined"], combined(frame))
        if "Depth" in passes:
            _fill(passes["Depth"], view.depth())
        for name in _MATERIAL_PASSES:
            if name in passes:
                _fill(passes[name], material_index(frame))
        self.end_result(result)
        self.update_stats("", f"{len(view.result.octree.words):,} words, depth {view.result.octree.depth}")

    def __init__(self, *arguments: Any, **keywords: Any) -> None:
        super().__init__(*arguments, **keywords)
        self._viewport = Viewport()
        self._problem = ""

    def view_update(self, _: Any, depsgraph: Any) -> None:
        """Take over what changed in the scene."""
        try:
            self._viewport.update(depsgraph)
            self._problem = ""
        except ERRORS as error:
            self._problem = str(error)

    def view_draw(self, context: Any, depsgraph: Any) -> None:
        """Draw the viewport: fewer pixels while something moves, exact at rest."""
        looking = Looking.of(context.region, context.region_data)
        self._viewport.look(looking)
        try:
            exact = self._viewport.rest(depsgraph)
            frame = self._viewport.frame(looking, coarse=not exact)
        except ERRORS as error:
            self._problem, exact, frame = str(error), True, None
        if frame is None:
            self.update_stats("voxrt", self._problem or "views without perspective are not rendered")
            return
        self.bind_display_space_shader(depsgraph.scene)
        draw(combined(frame), looking.size)
        self.unbind_display_space_shader()
        self.update_stats("voxrt", "exact" if exact else "")
        if not exact:
            bpy.app.timers.register(self._draw_again, first_interval=REST_SECONDS)

    def _draw_again(self) -> None:
        with suppress(ReferenceError):  # the viewport may have been closed
            self.tag_redraw()

    def update_render_passes(self, scene: Any = None, renderlayer: Any = None) -> None:
        """Tell the compositor which passes there are."""
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        if renderlayer.use_pass_z:
            self.register_pass(scene, renderlayer, "Depth", 1, "Z", "VALUE")
        if renderlayer.use_pass_material_index:
            name = _MATERIAL_PASSES[0 if bpy.app.version >= (5, 0, 0) else 1]
            self.register_pass(scene, renderlayer, name, 1, "X", "VALUE")


def final_view(depsgraph: Any, engine: Any = None) -> View:
    """Return the view of a render: the memory of what it shows, at the scene's camera, size and frame.

    A memory of the animation is taken where there is one for this frame. `engine` hears of the stages. Raise AssetError
    for a camera that cannot be used, and what :func:`~.memory.build_depsgraph` raises.
    """
    scene = depsgraph.scene
    size = render_size(scene.render)
    log = WarningLog()
    name = scene.original.name
    if scene.camera is None:
        raise voxrt.AssetError(name, "the scene has no camera", fix="add one")
    viewpoint = read_viewpoint(depsgraph, scene.camera, log)
    if viewpoint is None:
        problem = "; ".join(one.message for one in log.warnings())
        raise voxrt.AssetError(name, problem, place=scene.camera.name, fix="make its lens a perspective one")
    samples = int(scene.voxrt.samples)
    made = LATEST.animations.get(name) if scene.voxrt.use_animation else None
    root = None if made is None else made.root(scene.frame_current)
    if made is not None and root is not None:
        result = made.result
    else:
        if engine is not None:
            engine.update_stats("", "building the octree memory")
        result, root = build_depsgraph(depsgraph), 0
    assert result.rom.grid is not None
    camera = authored_camera(viewpoint, result.rom.grid, size)
    return View(result, camera, size, samples, scene.render.film_transparent, root)


def render_size(render: Any) -> tuple[int, int]:
    """Return the columns and rows of a render."""
    share = render.resolution_percentage
    return max(1, render.resolution_x * share // 100), max(1, render.resolution_y * share // 100)


def _fill(one: Any, pixels: np.ndarray) -> None:
    one.rect.foreach_set(np.ascontiguousarray(pixels.reshape(-1), np.float32))


def _shared_panels() -> list[Any]:
    """Return Blender's own panels that suit every engine: size, output, camera, world, materials."""
    unsuited = {"VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes"}
    return [
        panel
        for panel in bpy.types.Panel.__subclasses__()
        if "BLENDER_RENDER" in getattr(panel, "COMPAT_ENGINES", ()) and panel.__name__ not in unsuited
    ]


def register() -> None:
    """Register the engine, and show the panels that suit it."""
    bpy.utils.register_class(VoxrtEngine)
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.add(VoxrtEngine.bl_idname)


def unregister() -> None:
    """Undo :func:`register`."""
    for panel in _shared_panels():
        panel.COMPAT_ENGINES.discard(VoxrtEngine.bl_idname)
    bpy.utils.unregister_class(VoxrtEngine)
