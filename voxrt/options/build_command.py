"""The command line of ``voxrt build``."""

from __future__ import annotations

from pathlib import Path

from msgspec import NODEFAULT

from voxrt.options import notations
from voxrt.options.build_options import CONTENT, PREVIEW, BuildOptions
from voxrt.options.kinds import FLAG, file, files
from voxrt.options.notations import FrameChoice
from voxrt.options.option import ARGUMENTS, OptionTable, nested, option
from voxrt.options.shared import MEMORY, OUTPUT, RUNNING, ReportOptions


# A table: an option is its kind, its default and its group, then its text.
# fmt: off
class BuildCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt build`` takes."""

    assets: tuple[Path, ...] = option(files("ASSET"), NODEFAULT, ARGUMENTS,
        "A glTF (.gltf, .glb), OBJ, USD (.usd, .usda, .usdc, .usdz), STL or PLY file, or a scene of such files "
        "(.toml).")
    output: Path = option(file("DIR|FILE"), Path(), OUTPUT,
        "Folder for the files, or the file of words: NAME.mem, .coe, .mif, .bin.", flags=("--output", "-o"))
    options: BuildOptions = nested(BuildOptions)
    frames: FrameChoice | None = option(notations.FRAMES, None, CONTENT,
        "Build an animation: one memory whose roots are its frames. START:STOP:COUNT: so many frames, evenly from "
        "second START up to but without STOP, so that a loop closes (glTF, USD). files: each ASSET is a frame, in "
        "the natural order of their names; a folder stands for the assets in it.", is_rare=True)
    board: str | None = option(notations.BOARD, None, MEMORY, "A board, such as pynq-z1: its memory is the budget.")
    check: bool = option(FLAG, False, PREVIEW,
        "Render the view of the preview by the simulated hardware, too, and count the pixels that differ. This is the "
        "default where it takes less than five seconds.", is_rare=True)
    no_check: bool = option(FLAG, False, PREVIEW, "Leave that out.", is_rare=True)
    fractions: Path | None = option(file("FILE"), None, CONTENT,
        "Also write how much of each voxel every object fills: .npz (NumPy) or .vti (ParaView).", is_rare=True)
    profile: bool = option(FLAG, False, RUNNING,
        "Print the time of each stage, with its parts indented below it.", is_rare=True)
    reporting: ReportOptions = nested(ReportOptions)
