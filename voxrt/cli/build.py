"""``voxrt build``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from cyclopts import Parameter

from voxrt.cli.arguments import (
    Backdrop,
    Direction,
    FrameChoice,
    Pixels,
    Reporting,
    board_name,
    choice,
    corners,
    frame_choice,
    levels,
    number,
    png,
    processes,
    samples,
    shades,
    size_in_bytes,
    sky_light,
    words,
)
from voxrt.cli.arguments import background as read_colour
from voxrt.cli.building import build_all, check_company, check_frames
from voxrt.cli.errors import UsageError
from voxrt.cli.lengths import metres, metres_per_unit
from voxrt.cli.option_help import OPTION_HELP
from voxrt.options.build_options import BuildOptions, Dialect, Engine, Fill, Geometry, Pow2, UpAxis

_ASSET = (
    "A glTF (.gltf, .glb), OBJ, USD (.usd, .usda, .usdc, .usdz), STL or PLY file, or a scene of such files (.toml)."
)

_FRAMES = (
    "Build an animation: one memory whose roots are its frames. START:STOP:COUNT: so many frames, evenly from second "
    "START up to but without STOP, so that a loop closes (glTF, USD). files: each ASSET is a frame, in the natural "
    "order of their names; a folder stands for the assets in it."
)


def _option(name: str, *names: str, **said: Any) -> Parameter:  # noqa: ANN401 - whatever cyclopts takes
    """Make the parameter of an option of :class:`BuildOptions`, whose documentation is its help."""
    return Parameter(names or None, help=OPTION_HELP[name], **said)


def build(
    assets: Annotated[tuple[Path, ...], Parameter(name="ASSET", help=_ASSET)],
    /,
    *,
    output: Annotated[
        Path,
        Parameter(
            ("--output", "-o"),
            metavar="DIR|FILE",
            help="Folder for the files, or the file of words itself: NAME.mem, .coe, .mif or .bin.",
        ),
    ] = Path(),
    depth: Annotated[int | None, _option("depth", converter=levels, metavar="N")] = BuildOptions.depth,
    voxel_size: Annotated[
        float | None, _option("voxel_size", converter=metres, metavar="LENGTH")
    ] = BuildOptions.voxel_size,
    fill: Annotated[Fill, _option("fill", converter=choice)] = BuildOptions.fill,
    interior: Annotated[str, _option("interior", metavar="keep|any|MATERIAL")] = str(BuildOptions.interior),
    geometry: Annotated[Geometry, _option("geometry", converter=choice)] = BuildOptions.geometry,
    pow2: Annotated[Pow2, _option("pow2", converter=choice)] = BuildOptions.pow2,
    up: Annotated[UpAxis | None, _option("up", converter=choice)] = BuildOptions.up,
    unit: Annotated[
        float | None, _option("unit", converter=metres_per_unit, metavar="mm|cm|m|in|ft|METRES")
    ] = BuildOptions.unit,
    time: Annotated[float | None, _option("time", converter=number, metavar="SECONDS")] = BuildOptions.time,
    animation: Annotated[str | None, _option("animation", metavar="NAME")] = BuildOptions.animation,
    frames: Annotated[
        FrameChoice | None,
        Parameter(converter=frame_choice, n_tokens=1, metavar="START:STOP:COUNT|files", help=_FRAMES),
    ] = None,
    variants: Annotated[tuple[str, ...], _option("variants", "--variant", metavar="NAME", show_default=False)] = (),
    ignore: Annotated[tuple[str, ...], _option("ignore", metavar="NAME", show_default=False)] = (),
    bounds: Annotated[
        tuple[float, float, float, float, float, float] | None,
        _option("bounds", converter=corners, n_tokens=1, metavar="X,Y,Z,X,Y,Z", allow_leading_hyphen=True),
    ] = BuildOptions.bounds,
    allow_empty: Annotated[bool, _option("allow_empty", show_default=False)] = BuildOptions.allow_empty,
    allow_outside: Annotated[bool, _option("allow_outside", show_default=False)] = BuildOptions.allow_outside,
    colours: Annotated[int, _option("colours", converter=shades, metavar="K")] = BuildOptions.colours,
    bake: Annotated[bool, _option("bake", show_default=False)] = BuildOptions.bake,
    sun: Annotated[Direction, _option("sun")] = BuildOptions.sun,
    sky: Annotated[float | str, _option("sky", converter=sky_light, metavar="STRENGTH|COLOUR")] = BuildOptions.sky,
    bake_samples: Annotated[int, _option("bake_samples", converter=samples, metavar="N")] = BuildOptions.bake_samples,
    budget: Annotated[int | None, _option("budget", converter=words, metavar="WORDS")] = None,
    board: Annotated[
        str | None,
        Parameter(
            converter=board_name, metavar="NAME", help="Name of a board, such as pynq-z1. Its memory is the budget."
        ),
    ] = None,
    preview: Annotated[str | None, _option("preview", metavar="[FILE]")] = None,
    size: Annotated[Pixels, _option("size")] = BuildOptions.size,
    camera: Annotated[str | None, _option("camera", metavar="NAME")] = BuildOptions.camera,
    samples: Annotated[Literal[1, 2, 4], _option("samples")] = 1,
    background: Annotated[
        Backdrop, _option("background", converter=read_colour, n_tokens=1, metavar="COLOUR", show_default=False)
    ] = None,
    engine: Annotated[Engine, _option("engine", converter=choice)] = BuildOptions.engine,
    dialect: Annotated[Dialect, _option("dialect", converter=choice)] = BuildOptions.dialect,
    memory: Annotated[int | None, _option("memory", converter=size_in_bytes, metavar="SIZE")] = BuildOptions.memory,
    lod: Annotated[bool, _option("lod", show_default=False)] = BuildOptions.lod,
    scheduler: Annotated[str | None, _option("scheduler", metavar="ADDRESS")] = BuildOptions.scheduler,
    workers: Annotated[int | None, _option("workers", converter=processes, metavar="N")] = BuildOptions.workers,
    strict: Annotated[bool, _option("strict", show_default=False)] = BuildOptions.strict,
    profile: Annotated[
        bool,
        Parameter(show_default=False, help="Print the time of each stage, with its parts indented below it."),
    ] = False,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Build the octree memory of an asset: NAME.mem, its manifest NAME.json and a preview picture."""
    if depth is not None and voxel_size is not None:
        raise UsageError("--depth and --voxel-size exclude each other; give one of them")
    if not bake and (sun, sky, bake_samples) != (BuildOptions.sun, BuildOptions.sky, BuildOptions.bake_samples):
        raise UsageError("--sun, --sky and --bake-samples are of baked light: give --bake as well")
    if lod and dialect not in ("report", "lod"):
        raise UsageError(f"--lod has its own dialect, and {dialect} has no mean materials; leave one of them out")
    if scheduler is not None and workers is not None:
        raise UsageError("--scheduler and --workers exclude each other; give one of them")
    if budget is not None and board is not None:
        raise UsageError("--budget and --board exclude each other; give one of them")
    told: dict[str, object] = {
        "--time": time,
        "--bake": bake or None,
        "--budget": budget,
        "--board": board,
        "--scheduler": scheduler,
        "--workers": workers,
    }
    if frames is not None:
        check_frames(assets, frames, told)
    else:
        check_company(assets, output, preview)
    options = BuildOptions(
        depth=depth,
        voxel_size=voxel_size,
        fill=fill,
        interior=interior,
        geometry=geometry,
        pow2=pow2,
        up=up,
        unit=unit,
        time=time,
        animation=animation,
        variants=variants,
        ignore=ignore,
        bounds=bounds,
        allow_empty=allow_empty,
        allow_outside=allow_outside,
        colours=colours,
        bake=bake,
        sun=sun,
        sky=sky,
        bake_samples=bake_samples,
        budget=board or budget,
        dialect=dialect,
        lod=lod,
        preview=png(Path(preview)) if preview else preview is not None,
        size=size,
        camera=camera,
        samples=samples,
        background=background,
        engine=engine,
        memory=memory,
        scheduler=scheduler,
        workers=workers,
        strict=strict,
    )
    build_all(assets, output, options, frames=frames, profile=profile, json=reporting.json)
