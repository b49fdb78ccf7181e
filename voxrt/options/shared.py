"""The options that several commands or functions have, and tables of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from voxrt.options import notations
from voxrt.options.kinds import FLAG, Kind, as_it_is, file, one_of, text, whole
from voxrt.options.option import ARGUMENTS, Option, option

Engine: TypeAlias = Literal["rtl", "model"]
Dialect: TypeAlias = Literal["report", "seed-rtl", "msb", "lod"]
Triple: TypeAlias = tuple[int, int, int]
Colour: TypeAlias = Triple | Literal["transparent"]

PREVIEW_SIZE = (640, 480)
"""Default width and height of a picture, pixels."""

PICTURE, HARDWARE, MEMORY = "Picture", "Hardware", "Memory"
OUTPUT, RUNNING, MESSAGES = "Output", "Running", "Messages"

SCENE = Option(
    file("ROM|ASSET"),
    None,
    "A memory (.mem or another format), or an asset, which is built first.",
    ARGUMENTS,
)
SIZE = Option(notations.PIXELS, PREVIEW_SIZE, "Width and height in pixels.", PICTURE)
SAMPLES = Option(
    notations.SAMPLES,
    1,
    "Rays per pixel on each axis: 1, 2 or 4. More than one smooths the edges.",
    PICTURE,
    details="It takes as many frames as rays per pixel.",
)
BACKGROUND = Option(
    notations.COLOUR,
    None,
    "light, dark, transparent, or a colour such as #204060. The default is the background of the memory.",
    PICTURE,
)
ENGINE = Option(
    one_of(get_args(Engine)),
    "rtl",
    "rtl: the verilated hardware, which counts its clock cycles. model: the exact C++ model, which is faster. Both "
    "give the same pixels.",
    HARDWARE,
)
CONFIG = Option(text("NAME"), None, "The configuration of the hardware.", HARDWARE)
DEPTH = Option(whole(1, 16), None, "Levels of the octree, for an asset or for a memory without a manifest.", MEMORY)
DIALECT = Option(
    one_of(get_args(Dialect)), None, "How the memory encodes materials, for a memory without a manifest.", MEMORY
)
SCHEDULER = Option(text("ADDRESS"), None, "", RUNNING)
WORKERS = Option(whole(1, 1024), None, "", RUNNING)
ALLOW_OUTSIDE = Option(FLAG, False, "Also open files that the asset names outside of its own folder.", RUNNING)
ANYTHING = Kind("", str, as_it_is)


@dataclass(frozen=True, kw_only=True)
class MessageOptions:
    """How much a command says."""

    verbose: bool = option(
        FLAG,
        False,
        "Print every warning, and the time of each stage as it ends.",
        MESSAGES,
        flags=("--verbose", "-v"),
    )
    quiet: bool = option(
        FLAG, False, "Print nothing but answers, warnings and errors.", MESSAGES, flags=("--quiet", "-q")
    )
    debug: bool = option(FLAG, False, "Show the traceback of an error.", MESSAGES, is_rare=True)


@dataclass(frozen=True, kw_only=True)
class ReportOptions(MessageOptions):
    """How a command prints its results."""

    json: bool = option(FLAG, False, "Print the result as JSON on standard output.", MESSAGES)
