"""What a scene says about its memory: the options of a build, as properties of Blender's scene."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
from bpy.props import BoolProperty, EnumProperty, IntProperty, PointerProperty, StringProperty

import voxrt

from .sender import SENDERS

if TYPE_CHECKING:
    from voxrt.voxelize.formats.blend.views import Daylight


def _choices(*names: str) -> list[tuple[str, str, str]]:
    return [(name, name, "") for name in names]


def _budgets() -> list[tuple[str, str, str]]:
    boards = [(name, name, f"{words:,} words") for name, words in voxrt.BOARDS.items()]
    return [("none", "none", "As many words as the scene takes"), *boards]


def _changed(settings: Any, _: Any) -> None:
    """Let viewports know that the scene is built in another way."""
    settings.id_data.update_tag()


def _live_changed(settings: Any, _: Any) -> None:
    """Leave the line of a board to others."""
    if not settings.live:
        SENDERS.close()


class VoxrtSettings(bpy.types.PropertyGroup):
    """The settings of the panel."""

    depth: IntProperty(  # type: ignore[valid-type]
        name="Depth", default=7, min=1, max=12, update=_changed, description="Levels of the octree"
    )
    rule: EnumProperty(  # type: ignore[valid-type]
        name="Rule", items=_choices("touch", "centre", "half"), update=_changed, description="Which voxels solids fill"
    )
    fill: EnumProperty(  # type: ignore[valid-type]
        name="Fill",
        items=_choices("auto", "solid", "surface", "together"),
        update=_changed,
        description="What becomes of the inside",
    )
    colours: IntProperty(  # type: ignore[valid-type]
        name="Colours",
        default=32,
        min=1,
        max=254,
        update=_changed,
        description="Materials made of textures and colour attributes",
    )
    bake: BoolProperty(  # type: ignore[valid-type]
        name="Bake light",
        update=_changed,
        description="Give every voxel the colour that it has under the sun and the sky",
    )
    budget: EnumProperty(  # type: ignore[valid-type]
        name="Budget", items=_budgets(), update=_changed, description="The board that must hold the memory"
    )
    samples: EnumProperty(  # type: ignore[valid-type]
        name="Samples", items=_choices("1", "2", "4"), description="Rays per pixel on each axis of a render"
    )
    address: StringProperty(  # type: ignore[valid-type]
        name="Send to",
        default="http://127.0.0.1:8080",
        description="A running voxrt serve, or a board: serial:PORT, tcp://HOST:PORT",
    )
    live: BoolProperty(  # type: ignore[valid-type]
        name="Live", update=_live_changed, description="Send every change of the scene"
    )
    octants: BoolProperty(name="Octants", description="Draw the cells of the octree in viewports")  # type: ignore[valid-type]
    use_animation: BoolProperty(  # type: ignore[valid-type]
        name="Render from its memory", default=True, description="Render the frames of the animation that was built"
    )


def build_options(scene: Any, daylight: Daylight) -> voxrt.BuildOptions:
    """Return the options of a scene's build: its settings, and its own sun and sky for baked light."""
    chosen = scene.voxrt
    light: dict[str, Any] = {}
    if chosen.bake:
        light = {"sun": daylight.sun or (0.0, 0.0, 0.0)}
        if daylight.sky_text is not None:
            light["sky"] = daylight.sky_text
    return voxrt.BuildOptions(
        depth=chosen.depth,
        rule=chosen.rule,
        fill=chosen.fill,
        colours=chosen.colours,
        bake=chosen.bake,
        budget=None if chosen.budget == "none" else chosen.budget,
        **light,
    )


def register() -> None:
    """Register the settings, as `voxrt` of every scene."""
    bpy.utils.register_class(VoxrtSettings)
    bpy.types.Scene.voxrt = PointerProperty(type=VoxrtSettings)


def unregister() -> None:
    """Undo :func:`register`."""
    del bpy.types.Scene.voxrt
    bpy.utils.unregister_class(VoxrtSettings)
