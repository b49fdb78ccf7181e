"""The command lines of what shows memories: render, compare, view and trace."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from msgspec import NODEFAULT

from voxrt.options import notations
from voxrt.options.kinds import FLAG, INTEGER, Kind, as_it_is, file, one_of, real, whole
from voxrt.options.option import ARGUMENTS, OptionTable, nested, option
from voxrt.options.shared import (
    ALLOW_OUTSIDE,
    BACKGROUND,
    CONFIG,
    DEPTH,
    DIALECT,
    ENGINE,
    HARDWARE,
    OUTPUT,
    PICTURE,
    SAMPLES,
    SCENE,
    SCHEDULER,
    SIZE,
    WORKERS,
    Colour,
    Dialect,
    Engine,
    MessageOptions,
    ReportOptions,
)
from voxrt.options.view_options import CameraOptions, LightOptions

_CLOCKS = Kind("CLOCKS", INTEGER.read, as_it_is)
_OCTANTS, _PATH, _DETAIL = "Octants", "A path of cameras", "Level of detail"


# A table: an option is its kind, its default and its group, then its text.
# fmt: off
class RenderCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt render`` takes."""

    scene: Path = SCENE.field(default=NODEFAULT,
        details="The manifest of a .mem, the .json beside it, states materials, depth and dialect.")
    output: Path | None = option(notations.PICTURES, None, OUTPUT,
        "The picture, a .png; or a .gif, .webp or .mp4 of all frames of an animation or of a turntable. The default is "
        "NAME.png in this folder, or NAME.gif with {turntable}.",
        flags=("--output", "-o"))
    size: tuple[int, int] = SIZE.field()
    samples: Literal[1, 2, 4] = SAMPLES.field()
    background: Colour | None = BACKGROUND.field(details="A transparent picture suits pages of any colour.")
    frame: int | None = option(INTEGER, None, PICTURE,
        "Frame of an animation, counted from 0, for a .png. The camera is that of all frames. The default is 0.",
        metavar="K", is_rare=True)
    turntable: bool = option(FLAG, False, PICTURE,
        "Turn the camera once around the scene: 72 pictures in one file.")
    sight: CameraOptions = nested(CameraOptions)
    lighting: LightOptions = nested(LightOptions)
    engine: Engine | None = ENGINE.field(
        details="The default is rtl where {config}, {check}, {latency}, {interval} or {jitter} is given, else model.")
    config: str | None = CONFIG.field(
        help="The configuration of the hardware. The default is tiny, or lit for light or mirrors, or cached1 for "
        "{lod}.",
        details="It says what lanes, what memory and which features of the shader there are.")
    check: bool = option(FLAG, False, HARDWARE,
        "Render with both engines and count the pixels that differ. Any difference is an error.")
    latency: int | None = option(_CLOCKS, None, HARDWARE,
        "The latency of the external memory of a configuration with caches, such as cached16: clocks from an "
        "address to the first word. The default is 50.", is_rare=True)
    interval: int | None = option(_CLOCKS, None, HARDWARE,
        "The interval of the external memory: clocks from one line of 32 bytes to the next. The default is 3.",
        is_rare=True)
    jitter: int | None = option(_CLOCKS, None, HARDWARE,
        "The jitter of the external memory: up to so many clocks more for each line, at random. The default is 0.",
        is_rare=True)
    lod: bool = option(FLAG, False, _DETAIL,
        "Rays stop at cells that are not wider than a pixel and show the mean material of what is in them.",
        details="A memory that was built without {lod} gets its mean materials first.")
    lod_cell: float | None = option(real("PIXELS", above=0, below=1024), None, _DETAIL,
        "With {lod}: the width of the widest cell that rays stop at, in pixels. With 0.5 pictures are closest to "
        "smooth ones, with 2 they take the fewest cycles. The default is 1.", is_rare=True)
    depth: int | None = DEPTH.field()
    dialect: Dialect | None = DIALECT.field(is_rare=True)
    cameras: Path | None = option(file("FILE"), None, _PATH,
        "Render a picture for each camera of a JSON file, NAME-0000.png and so on.",
        details="The file is a list of objects with position, look, right and up, three numbers each, as the "
        "options of these names.")
    scheduler: str | None = SCHEDULER.field(group=_PATH, is_rare=True,
        help="With {cameras}: render on the cluster of this Dask scheduler, such as tcp://host:8786.")
    workers: int | None = WORKERS.field(group=_PATH, is_rare=True,
        help="With {cameras}: render by so many processes of this machine.")
    reporting: ReportOptions = nested(ReportOptions)


class CompareCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt compare`` takes."""

    rom: Path = option(file("ROM"), NODEFAULT, ARGUMENTS, "A .mem file with its manifest.")
    asset: Path = option(file("ASSET"), NODEFAULT, ARGUMENTS, "What it was built from.")
    output: Path | None = option(notations.PICTURE, None, OUTPUT,
        "A .png of pictures side by side: the meshes, the memory by the exact model and, with {check}, by the "
        "simulated hardware, and the difference.", flags=("--output", "-o"))
    curve: Path | None = option(notations.PICTURE, None, OUTPUT,
        "A .png that plots the similarity against depth and words. The asset is built at each depth up to the "
        "memory's.")
    check: bool = option(FLAG, False, HARDWARE,
        "Render with the simulated hardware, too, and count the pixels that differ from the exact model.")
    size: tuple[int, int] = SIZE.field()
    allow_outside: bool = ALLOW_OUTSIDE.field()
    reporting: ReportOptions = nested(ReportOptions)


class ViewCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt view`` takes."""

    scene: Path = SCENE.field(default=NODEFAULT)
    other: Path | None = SCENE.field(help="A second memory or asset, shown beside the first and turned with it.")
    by: Literal["material", "level", "owner"] = option(one_of(("material", "level", "owner")), "material", _OCTANTS,
        "What the colours show. The owners of voxels, which are the objects of the scene, are known only for "
        "assets.")
    clip: Literal["x", "y", "z"] | None = option(one_of("xyz"), None, _OCTANTS,
        "Leave out the half of the scene that is nearer to the camera along this axis. Octants stay whole.")
    slice: tuple[tuple[int, int], ...] = option(notations.CUTS, (), _OCTANTS,
        "Cut the octants at a plane, such as x=40, and leave out what is nearer to the camera. One plane per axis.")
    level_limit: int | None = option(whole(0, 16), None, _OCTANTS,
        "Make octants of 2**N voxels per side uniform first, so that there are fewer octants.")
    overlay: bool = option(FLAG, False, _OCTANTS, "Draw the triangles of the asset over its octants.")
    ray: tuple[int, int] | None = option(notations.PIXEL, None, PICTURE,
        "Show the picture of the camera, and the path of this pixel's ray through the octants: column and row of "
        "640x480. In the window, a click chooses another pixel.")
    size: tuple[int, int] | None = SIZE.field(default=None,
        help="Width and height in pixels. The default is 1024x768, or 1280x720 with {ray} or a second scene.")
    depth: int | None = DEPTH.field()
    screenshot: Path | None = option(notations.PICTURE, None, OUTPUT, "Write this .png instead of opening a window.")
    turntable: Path | None = option(file("FILE"), None, OUTPUT,
        "Write this .gif, .webp or .mp4 instead of opening a window. It shows the octants from all sides. voxrt render "
        "--turntable shows the scene, and is faster.")
    output: Path | None = option(file("FILE"), None, OUTPUT,
        "Write this file instead of opening a window: .vox (MagicaVoxel), .npz (NumPy), .ply, .glb (glTF), .vtu "
        "(ParaView, PyVista), or .html (a page that needs no other file).", flags=("--output", "-o"))
    reporting: MessageOptions = nested(MessageOptions)


class TraceCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt trace`` takes."""

    scene: Path = SCENE.field(default=NODEFAULT)
    pixel: tuple[int, int] = option(notations.PIXEL, NODEFAULT, PICTURE,
        "Column and row of the pixel in the picture of voxrt render, from the upper left.")
    size: tuple[int, int] = SIZE.field(help="Width and height of that picture in pixels.")
    wave: Path | None = option(notations.WAVE, None, OUTPUT,
        "Write the signals of the simulated hardware while it traces this ray, a .vcd or .fst. A view file for GTKWave "
        "(.gtkw) and one for Surfer (.sucl) stand beside it.", details="A .fst needs the package pylibfst.")
    depth: int | None = DEPTH.field()
    sight: CameraOptions = nested(CameraOptions)
    lighting: LightOptions = nested(LightOptions)
    reporting: ReportOptions = nested(ReportOptions)
