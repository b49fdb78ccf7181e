"""The panel in the properties of a render: how the scene is built, how large that is, and where it goes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from .commands import WATCH
from .engine import VoxrtEngine
from .memory import LATEST
from .operators import (
    VoxrtAnimation,
    VoxrtBitstream,
    VoxrtBuild,
    VoxrtCheck,
    VoxrtExport,
    VoxrtForget,
    VoxrtSend,
    boards_that_fit,
)

if TYPE_CHECKING:
    import voxrt


class _Panel(bpy.types.Panel):
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context: Any) -> bool:
        """Show it with the engine alone."""
        return bool(context.engine == VoxrtEngine.bl_idname)


class VOXRT_PT_memory(_Panel):  # noqa: N801 - Blender's form of names
    """How the scene is built, and what that takes."""

    bl_label = "Octree memory"

    def draw(self, context: Any) -> None:
        """Draw the settings and the figures."""
        layout, settings = self.layout, context.scene.voxrt
        layout.use_property_split = True
        for name in ("depth", "rule", "fill", "colours", "bake", "budget", "samples"):
            layout.prop(settings, name)
        column = layout.column()
        column.operator(VoxrtBuild.bl_idname)
        for line in figures(LATEST.results.get(context.scene.name)):
            column.label(text=line)
        layout.operator(VoxrtCheck.bl_idname)
        layout.prop(settings, "octants")


class VOXRT_PT_output(_Panel):  # noqa: N801
    """Where the memory goes."""

    bl_label = "Hardware"

    def draw(self, context: Any) -> None:
        """Draw what exports and sends the memory."""
        layout, settings = self.layout, context.scene.voxrt
        layout.operator_menu_enum(VoxrtExport.bl_idname, "format")
        layout.operator_menu_enum(VoxrtBitstream.bl_idname, "board")
        layout.prop(settings, "address")
        layout.operator(VoxrtSend.bl_idname)
        layout.prop(settings, "live")
        if WATCH.line:
            layout.label(text=WATCH.line)
        layout.separator()
        layout.operator(VoxrtAnimation.bl_idname)
        if context.scene.name in LATEST.animations:
            layout.prop(settings, "use_animation")
            layout.operator(VoxrtForget.bl_idname)


def figures(result: voxrt.BuildResult | None) -> list[str]:
    """Return what a panel says of a memory, line by line; nothing without one."""
    if result is None:
        return []
    words = len(result.octree.words)
    lines = [f"{words:,} words, {result.solid_voxels:,} voxels, {len(result.rom.materials) - 1} materials"]
    if result.budget is not None:
        lines.append(f"{result.budget.fit.percent_changed:.1f} % of the surface given up for the budget")
    lines.append(f"Fits {', '.join(boards_that_fit(words)) or 'no board'}")
    return lines + [one.message for one in result.warnings]


_CLASSES = (VOXRT_PT_memory, VOXRT_PT_output)


def register() -> None:
    """Register the panels."""
    for one in _CLASSES:
        bpy.utils.register_class(one)


def unregister() -> None:
    """Undo :func:`register`."""
    for one in reversed(_CLASSES):
        bpy.utils.unregister_class(one)
