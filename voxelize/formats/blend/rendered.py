"""The scene as a render shows it.

Only a render engine gets the dependency graph of a render, in which modifiers, subdivision and visibility are those of
renders. An engine that draws nothing is registered for the time of one call.
"""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

import bpy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

T = TypeVar("T")

_NAME = "VOXRT_READER"
_SETTINGS = {
    "engine": _NAME,
    "use_compositing": False,
    "use_sequencer": False,
    "use_multiview": False,
    "use_border": False,
}


def as_rendered(scene: Any, view_layer: Any, read: Callable[[Any], T]) -> T:
    """Return what `read` makes of the dependency graph of a render of a scene's view layer.

    The scene needs no camera. Its settings are the same afterwards. Raise what `read` raises.
    """
    found: list[T] = []
    raised: list[BaseException] = []

    def take(depsgraph: Any) -> None:
        if found or raised:
            return
        try:
            found.append(read(depsgraph))
        except BaseException as error:  # noqa: BLE001 - Blender would print it, and go on
            raised.append(error)

    engine = type(_NAME, (bpy.types.RenderEngine,), {
        "bl_idname": _NAME, "bl_label": "voxrt reader", "render": lambda _, depsgraph: take(depsgraph)
    })  # fmt: skip
    with _set_up(scene, view_layer):
        bpy.utils.register_class(engine)
        try:
            scene.render.engine = _NAME
            bpy.ops.render.render(scene=scene.name, layer=view_layer.name)
        finally:
            bpy.utils.unregister_class(engine)
    if raised:
        raise raised[0]
    if not found:
        raise RuntimeError("Blender rendered nothing")
    return found[0]


@contextmanager
def _set_up(scene: Any, view_layer: Any) -> Iterator[None]:
    """Let a scene be rendered for the time of a block: without what comes after the render, and with a camera."""
    render, before, used, camera = scene.render, {}, view_layer.use, None
    for name, value in _SETTINGS.items():
        before[name] = getattr(render, name)
        if name != "engine":
            setattr(render, name, value)
    view_layer.use = True
    if scene.camera is None:
        camera = bpy.data.objects.new(_NAME, bpy.data.cameras.new(_NAME))
        scene.camera = camera
    try:
        yield
    finally:
        for name, value in before.items():
            setattr(render, name, value)
        view_layer.use = used
        if camera is not None:
            lens = camera.data
            bpy.data.objects.remove(camera)
            bpy.data.cameras.remove(lens)
