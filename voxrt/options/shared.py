"""The options that several commands or functions have, and tables of them."""

from __future__ import annotations

from typing import Literal, TypeAlias, get_args

from voxrt.options import notations
from voxrt.options.kinds import FLAG, Kind, as_it_is, file, one_of, text, whole
from voxrt.options.option import ARGUMENTS, Option, OptionTable, option

Engine: TypeAlias = Literal["rtl", "model"]
Dialect: TypeAlias = Literal["report", "seed-rtl", "msb", "lod"]
Triple: TypeAlias = tuple[int, int, int]
Colour: TypeAlias = Triple | Literal["transparent"]

PREVIEW_SIZE = (640, 480)
"""Default width and height of a picture, pixels."""

PICTURE, HARDWARE, MEMORY = "Picture", "Hardware", "Memory"
OUTPUT, RUNNING, MESSAGES = "Output", "Running", "Messages"

# A table: an option is its kind, its default and its group, then its text.
# fmt: off
SCENE = Option(file("ROM|ASSET"), None, ARGUMENTS,
    "A memory (.mem or another format), or an asset, which is built first.")
SIZE = Option(notations.PIXELS, PREVIEW_SIZE, PICTURE, "Width and height in pixels.")
SAMPLES = Option(notations.SAMPLES, 1, PICTURE,
    "Rays per pixel on each axis: 1, 2 or 4. More than one smooths the edges.",
    details="It takes as many frames as rays per pixel.")
BACKGROUND = Option(notations.COLOUR, None, PICTURE,
    "light, dark, transparent, or a colour such as #204060. The default is the background of the memory.")
ENGINE = Option(one_of(get_args(Engine)), None, HARDWARE,
    "model: the exact C++ model, which is fast. rtl: the verilated hardware, which counts its clock cycles. Both give "
    "the same pixels.")
CONFIG = Option(text("NAME"), None, HARDWARE, "The configuration of the hardware.")
DEPTH = Option(whole(1, 16), None, MEMORY, "Levels of the octree, for an asset or for a memory without a manifest.")
DIALECT = Option(one_of(get_args(Dialect)), None, MEMORY,
    "How the memory encodes materials, for a memory without a manifest.")
SCHEDULER = Option(text("ADDRESS"), None, RUNNING, "")
WORKERS = Option(whole(1, 1024), None, RUNNING, "")
ALLOW_OUTSIDE = Option(FLAG, False, RUNNING, "Also open files that the asset names outside of its own folder.")
ANYTHING = Kind("", str, as_it_is)


class MessageOptions(OptionTable, frozen=True, kw_only=True):
    """How much a command says."""

    verbose: bool = option(FLAG, False, MESSAGES,
        "Print every warning, and the time of each stage as it ends.", flags=("--verbose", "-v"))
    quiet: bool = option(FLAG, False, MESSAGES,
        "Print nothing but answers, warnings and errors.", flags=("--quiet", "-q"))
    debug: bool = option(FLAG, False, MESSAGES, "Show the traceback of an error.", is_rare=True)


class ReportOptions(MessageOptions, frozen=True, kw_only=True):
    """How a command prints its results."""

    json: bool = option(FLAG, False, MESSAGES, "Print the result as JSON on standard output.")
