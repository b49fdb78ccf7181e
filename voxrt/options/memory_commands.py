"""The command lines of what reads and writes memories: convert, edit, info and diff."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from msgspec import NODEFAULT

from voxrt.options.kinds import INTEGER, file, one_of, texts, whole
from voxrt.options.option import ARGUMENTS, OptionTable, nested, option
from voxrt.options.shared import CONFIG, DEPTH, DIALECT, HARDWARE, MEMORY, OUTPUT, SCENE, SIZE, Dialect, ReportOptions


# A table: an option is its kind, its default and its group, then its text.
# fmt: off
class ConvertCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt convert`` takes."""

    source: Path = option(file("FROM"), NODEFAULT, ARGUMENTS,
        "A memory: .mem, .coe, .mif or .bin (with or without a manifest beside it), .blob, .vox "
        "(MagicaVoxel), or .txt (a node listing of the original's authoring script). Or an asset, which is built "
        "first.")
    target: Path = option(file("TO"), NODEFAULT, ARGUMENTS,
        "The file to write. Whole memories: .mem, .coe, .mif or .bin, each with a manifest beside it, or .blob. "
        "For other programs: .vox (MagicaVoxel), .npz (NumPy), .ply, .glb (glTF), .vtu (ParaView, PyVista) or "
        ".html.")
    depth: int | None = DEPTH.field(help="Levels of the octree, for an asset or if FROM does not state them.")
    from_dialect: Dialect | None = DIALECT.field(help="How FROM encodes materials, if it does not state that.")
    dialect: Dialect = DIALECT.field(help="How TO encodes materials.", default="report")
    material: tuple[str, ...] = option(texts("NAME=RRGGBB"), (), MEMORY,
        "Name and colour of a material of a node listing. Give the option once per material, in the order of their "
        "ids.")
    form: Literal["file", "core"] = option(one_of(("file", "core")), "file", OUTPUT,
        "file: one file, in the format that its suffix says. core: TO is a folder for what a core holds that shows "
        "the scene: rows of its block RAMs for $readmemh, boot.hex with the writes that start a frame, and scene.h "
        "for C.")
    config: str | None = CONFIG.field(
        help="With {form} core: the configuration of the hardware. The default is tiny, or lit if the scene has a "
        "light or mirrors.")
    size: tuple[int, int] | None = SIZE.field(default=None, group=HARDWARE,
        help="With {form} core: width and height of the frame in pixels. The default is 640x480.")
    reporting: ReportOptions = nested(ReportOptions)


class EditCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt edit`` takes."""

    source: Path = option(file("ROM|ASSET"), NODEFAULT, ARGUMENTS,
        "A memory in any format, or an asset, which is built first.")
    script: Path = option(file("EDITS.jsonl"), NODEFAULT, OUTPUT,
        "The edits: a file with an operation per line, as JSON.")
    output: Path = option(file("FILE"), NODEFAULT, OUTPUT,
        "The file to write, in a format that voxrt convert writes. It may be the memory that is read.",
        flags=("--output", "-o"))
    depth: int | None = DEPTH.field()
    dialect: Dialect | None = DIALECT.field(
        help="How the file encodes materials. The default is report, or lod if the memory has mean materials.")
    undo_steps: int = option(whole(0, 1_000_000), 100, MEMORY,
        "How many edits an operation undo can go back.", is_rare=True)
    reporting: ReportOptions = nested(ReportOptions)


class InfoCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt info`` takes."""

    scene: Path = SCENE.field(default=NODEFAULT,
        help="A memory (.mem or another format), with its manifest beside it or without; or an asset, which is "
        "built first.")
    depth: int | None = DEPTH.field()
    dialect: Dialect | None = DIALECT.field()
    reporting: ReportOptions = nested(ReportOptions)


class DiffCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt diff`` takes."""

    first: Path = option(file("FIRST"), NODEFAULT, ARGUMENTS,
        "A memory in any format, or an asset, which is built first.")
    second: Path | None = option(file("SECOND"), None, ARGUMENTS,
        "Another, of the same depth; left out, two frames of FIRST are compared.")
    frame: int | None = option(INTEGER, None, MEMORY, "Frame of FIRST, counted from 0. The default is 0.", metavar="K")
    to_frame: int | None = option(INTEGER, None, MEMORY,
        "Frame of SECOND, or without one, of FIRST. The default is 0, or the one after {frame}.", metavar="K")
    depth: int | None = DEPTH.field(
        help="Levels of the octree, for an asset or for a memory without a manifest. An asset has those of the "
        "other file if that is a memory.")
    reporting: ReportOptions = nested(ReportOptions)
