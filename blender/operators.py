"""Operators: build, check by hardware, export, send, bitstreams and animations."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, ClassVar

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty

import voxrt
from voxrt.export.blob import blob_bytes
from voxrt.voxelize.formats.blend.rendered import as_rendered

from .commands import WATCH, RunningCommand, Work
from .engine import ERRORS, final_view
from .memory import LATEST, build_animation, build_scene
from .online import check_online
from .sender import SENDERS, Upload

_FORMATS = [
    (".mem", "Memory (.mem)", "Words for $readmemh, with a manifest"),
    (".blob", "Memory (.blob)", "One file that boards and servers read"),
    (".coe", "Memory (.coe)", "For the block RAMs of Vivado, with a manifest"),
    (".vox", "Voxels (.vox)", "For MagicaVoxel"),
]


class _Operator(bpy.types.Operator):
    """An operator whose errors are one line."""

    bl_options: ClassVar[set[str]] = {"REGISTER"}

    def execute(self, context: Any) -> set[str]:
        """Run it, and report its errors."""
        try:
            self.report({"INFO"}, self.run(context))
        except (*ERRORS, voxrt.OutputError, voxrt.RomError, OSError) as error:
            self.report({"ERROR"}, f"voxrt: {error}")
            return {"CANCELLED"}
        return {"FINISHED"}

    def run(self, context: Any) -> str:
        """Do what the operator does; return what it did in one line."""
        raise NotImplementedError


class VoxrtBuild(_Operator):
    """Build the octree memory of what a render shows"""

    bl_idname = "voxrt.build"
    bl_label = "Build"

    def run(self, context: Any) -> str:  # noqa: D102
        return describe(build_scene(context))


class VoxrtCheck(_Operator):
    """Render the picture by the simulated hardware and by the exact model, and compare them"""

    bl_idname = "voxrt.check"
    bl_label = "Check by hardware"

    def run(self, context: Any) -> str:  # noqa: D102
        check = as_rendered(context.scene, context.view_layer, lambda depsgraph: final_view(depsgraph).check())
        cycles, pixels = check.rtl.cost.cycles or 0, check.wrong.size
        return f"{check.wrong_pixels} of {pixels:,} pixels differ, {cycles / pixels:.2f} cycles per pixel"


class VoxrtExport(_Operator):
    """Write the octree memory, or its voxels"""

    bl_idname = "voxrt.export"
    bl_label = "Export"

    filepath: StringProperty(subtype="FILE_PATH")  # type: ignore[valid-type]
    format: EnumProperty(name="Format", items=_FORMATS)  # type: ignore[valid-type]

    def invoke(self, context: Any, _: Any) -> set[str]:
        """Ask for the file."""
        self.filepath = f"{Path(bpy.data.filepath).stem or context.scene.name}{self.format}"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def run(self, context: Any) -> str:  # noqa: D102
        path = Path(bpy.path.abspath(self.filepath))
        if path.suffix.lower() not in {name for name, *_ in _FORMATS}:
            path = path.with_suffix(self.format)
        made = LATEST.animations.get(context.scene.name) if context.scene.voxrt.use_animation else None
        result = build_scene(context) if made is None else made.result
        files = voxrt.convert(result.blob, path)
        return f"wrote {', '.join(file.name for file in files)}: {describe(result)}"


class VoxrtAnimation(_Operator):
    """Build one memory of all frames of the scene's range, with a root per frame"""

    bl_idname = "voxrt.animation"
    bl_label = "Build animation"

    def run(self, context: Any) -> str:  # noqa: D102
        result = build_animation(context).result
        assert result.animation is not None
        return f"{len(result.animation.frames)} frames, {describe(result)}"


class VoxrtForget(_Operator):
    """Render and export single frames again"""

    bl_idname = "voxrt.forget_animation"
    bl_label = "Forget animation"

    def run(self, context: Any) -> str:  # noqa: D102
        LATEST.animations.pop(context.scene.name, None)
        return "frames are built one by one"


class _LongOperator(_Operator):
    """An operator that begins what takes a while. Blender goes on, and the panel shows what comes of it."""

    def execute(self, context: Any) -> set[str]:
        try:
            work = self.begin(context)
        except (*ERRORS, voxrt.OutputError, OSError) as error:
            self.report({"ERROR"}, f"voxrt: {error}")
            return {"CANCELLED"}
        if work is None:
            return {"FINISHED"}
        if not bpy.app.background:
            WATCH.follow(work)
            return {"FINISHED"}
        succeeded, line = work.outcome()
        self.report({"INFO" if succeeded else "ERROR"}, line)
        return {"FINISHED" if succeeded else "CANCELLED"}

    def begin(self, context: Any) -> Work | None:
        """Begin it; None where there is nothing to do."""
        raise NotImplementedError


class VoxrtSend(_LongOperator):
    """Show the scene on the server or the board whose address is above"""

    bl_idname = "voxrt.send"
    bl_label = "Send"

    changed_only: BoolProperty(options={"HIDDEN", "SKIP_SAVE"})  # type: ignore[valid-type]

    def begin(self, context: Any) -> Upload | None:  # noqa: D102
        settings = context.scene.voxrt
        check_online(settings.address)
        blob = blob_bytes(build_scene(context).blob)
        sender = SENDERS.to(settings.address)
        if self.changed_only and sender.holds(blob):
            return None
        upload = sender.send(blob)
        if not settings.live:
            SENDERS.close()
        return upload


class VoxrtBitstream(_LongOperator):
    """Make the bitstream of a board that shows the scene, turning"""

    bl_idname = "voxrt.bitstream"
    bl_label = "Bitstream"

    board: EnumProperty(  # type: ignore[valid-type]
        name="Board", items=[(name, name, f"{words:,} words") for name, words in voxrt.BOARDS.items()]
    )
    directory: StringProperty(subtype="DIR_PATH")  # type: ignore[valid-type]

    def invoke(self, context: Any, _: Any) -> set[str]:
        """Ask for the folder."""
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def begin(self, context: Any) -> RunningCommand:  # noqa: D102
        folder = tempfile.TemporaryDirectory(prefix="voxrt-")
        file = Path(folder.name, "scene.blob")
        voxrt.convert(build_scene(context).blob, file)
        target = bpy.path.abspath(self.directory)
        return RunningCommand(["bitstream", str(file), "--board", self.board, "-o", target], folder)


def describe(result: voxrt.BuildResult) -> str:
    """Return the size of a memory in one line, and the boards that hold it."""
    words = len(result.octree.words)
    return f"{words:,} words, {result.solid_voxels:,} voxels; fits {', '.join(boards_that_fit(words)) or 'no board'}"


def boards_that_fit(words: int) -> list[str]:
    """Return the boards whose memory holds so many words."""
    return [name for name, most in voxrt.BOARDS.items() if words <= most]


CLASSES: list[type] = [
    VoxrtBuild, VoxrtCheck, VoxrtExport, VoxrtAnimation, VoxrtForget, VoxrtSend, VoxrtBitstream
]  # fmt: skip
"""All operators."""


def register() -> None:
    """Register the operators."""
    for one in CLASSES:
        bpy.utils.register_class(one)


def unregister() -> None:
    """Undo :func:`register`."""
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
