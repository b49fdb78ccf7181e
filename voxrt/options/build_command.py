"""The command line of ``voxrt build``."""

from __future__ import annotations

from dataclasses import MISSING, dataclass
from pathlib import Path

from voxrt.options import notations
from voxrt.options.build_options import CONTENT, BuildOptions
from voxrt.options.kinds import FLAG, file, files
from voxrt.options.notations import FrameChoice
from voxrt.options.option import ARGUMENTS, nested, option
from voxrt.options.shared import MEMORY, OUTPUT, RUNNING, ReportOptions


@dataclass(frozen=True, kw_only=True)
class BuildCommand:
    """What ``voxrt build`` takes."""

    assets: tuple[Path, ...] = option(
        files("ASSET"),
        MISSING,
        "A glTF (.gltf, .glb), OBJ, USD (.usd, .usda, .usdc, .usdz), STL or PLY file, or a scene of such files "
        "(.toml).",
        ARGUMENTS,
    )
    output: Path = option(
        file("DIR|FILE"),
        Path(),
        "Folder for the files, or the file of words itself: NAME.mem, .coe, .mif or .bin.",
        OUTPUT,
        flags=("--output", "-o"),
    )
    options: BuildOptions = nested(BuildOptions)
    frames: FrameChoice | None = option(
        notations.FRAMES,
        None,
        "Build an animation: one memory whose roots are its frames. START:STOP:COUNT: so many frames, evenly from "
        "second START up to but without STOP, so that a loop closes (glTF, USD). files: each ASSET is a frame, in "
        "the natural order of their names; a folder stands for the assets in it.",
        CONTENT,
        is_rare=True,
    )
    board: str | None = option(
        notations.BOARD_MEMORY, None, "A board, such as pynq-z1: its memory is the budget.", MEMORY
    )
    profile: bool = option(
        FLAG, False, "Print the time of each stage, with its parts indented below it.", RUNNING, is_rare=True
    )
    reporting: ReportOptions = nested(ReportOptions)
