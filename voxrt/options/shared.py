"""The options that several commands or functions have, and tables of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias, get_args

from voxrt.options import notations
from voxrt.options.kinds import FLAG, INTEGER, Kind, as_it_is, file, one_of, text, whole
from voxrt.options.option import ARGUMENTS, Option, option

Engine: TypeAlias = Literal["rtl", "model"]
Dialect: TypeAlias = Literal["report", "seed-rtl", "msb", "lod"]
Triple: TypeAlias = tuple[int, int, int]
Colour: TypeAlias = Triple | Literal["transparent"]

PREVIEW_SIZE = (640, 480)
"""Default width and height of a picture, pixels."""

PICTURE, CAMERA, LIGHT, HARDWARE, MEMORY = "Picture", "Camera", "Light and shading", "Hardware", "Memory"
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


@dataclass(frozen=True, kw_only=True)
class CameraOptions:
    """The camera. What is not given is chosen to show the whole scene."""

    position: Triple | None = option(
        notations.PLACE,
        None,
        "Position of the camera in voxels, in steps of 1/16. The default shows the whole scene.",
        CAMERA,
        details="It may lie outside the scene.",
    )
    look: Triple | None = option(
        notations.REGISTER,
        None,
        "Register: direction of the centre of the picture. The default looks at the scene.",
        CAMERA,
        details="Without {right} and {up}, its length does not matter.",
    )
    right: Triple | None = option(
        notations.REGISTER,
        None,
        "Register: step of the direction from a pixel to its right neighbour. The default is look x up.",
        CAMERA,
        is_rare=True,
    )
    up: Triple | None = option(
        notations.REGISTER,
        None,
        "Register: step of the direction from a pixel to the one above it. The default is upright.",
        CAMERA,
        is_rare=True,
    )


@dataclass(frozen=True, kw_only=True)
class LightOptions:
    """The light of a picture. What is not given is that of the memory."""

    light: Triple | None = option(
        notations.PLACE,
        None,
        "Position of a light that casts shadows, in voxels. The default is the light of the memory, if it has one.",
        LIGHT,
        details="Steps are of 1/16 voxel.",
    )
    ambient: int | None = option(
        INTEGER, None, "The brightness of shadows, 0 to 255. The default is 90.", LIGHT, is_rare=True
    )
    bounces: int | None = option(
        INTEGER,
        None,
        "The most reflections of a ray by mirrors, 0 to 15. With 0, mirrors are like other materials. The default is "
        "that of the memory, or 0.",
        LIGHT,
        is_rare=True,
    )
    shading: Literal["faces", "report", "flat"] | None = option(
        one_of(("faces", "report", "flat")),
        None,
        "What brightness depends on: the side of a block, an angle, or nothing. The default is that of the memory, or "
        "faces.",
        LIGHT,
        details="faces: each side of a block has its own; the top is the brightest. report: the angle to the camera "
        "or to the light, as in the report on the original hardware. flat: materials show their own colour.",
    )
