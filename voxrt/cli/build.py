"""``voxrt build``."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Annotated, Any, Literal

from cyclopts import Parameter

import voxrt
from voxrt.build_options import BuildOptions, Dialect, Engine, Fill, Geometry, Pow2, UpAxis
from voxrt.cli.arguments import (
    Backdrop,
    Direction,
    FrameChoice,
    Pixels,
    Reporting,
    UsageError,
    board_name,
    choice,
    corners,
    frame_choice,
    levels,
    metres,
    metres_per_unit,
    png,
    processes,
    samples,
    seconds,
    shades,
    size_in_bytes,
    sky_light,
    words,
)
from voxrt.cli.arguments import background as read_colour
from voxrt.cli.messages import frames_row, picture_cost, summarize, tabulate, warn
from voxrt.cli.option_help import OPTION_HELP
from voxrt.cli.process_age import process_age
from voxrt.cli.progress import build_bar

_NAMED = 32  # so many materials still read as a list

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
    time: Annotated[float | None, _option("time", converter=seconds, metavar="SECONDS")] = BuildOptions.time,
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
    _check_company(assets, output, preview) if frames is None else _check_frames(assets, frames, told)
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
    reports = []
    waited = process_age()
    for asset in assets if frames is None else assets[:1]:
        begun = perf_counter()
        result = _build(asset, assets, frames, output, options)
        seconds = {"start": waited, **result.seconds}
        seconds["rest"] = max(0.0, perf_counter() - begun - sum(result.seconds.values()))
        waited = 0.0
        warn(result.warnings)
        if result.budget is not None and (loss := _loss(result.budget)):
            warn((voxrt.SceneWarning("budget", loss),))
        if reporting.json:
            from voxrt.cli.results import build_report  # noqa: PLC0415 - most builds print a summary

            reports.append(build_report(result, seconds))
        else:
            summarize(f"{asset.name}:", _rows(result))
        if profile:
            _print_profile(seconds, result.parts)
    if reporting.json:
        from voxrt.cli.results import print_json  # noqa: PLC0415 - as above

        print_json(reports[0] if len(reports) == 1 else reports)


def _check_frames(assets: tuple[Path, ...], frames: FrameChoice, others: dict[str, object]) -> None:
    """Refuse what does not go together with the frames of an animation."""
    for name, value in others.items():
        if value is not None:
            raise UsageError(f"{name} is not for the frames of an animation; leave it out")
    if frames != "files" and len(assets) > 1:
        raise UsageError(
            f"--frames with times is of one asset, and there are {len(assets)}; name one, or --frames files"
        )


def _build(
    asset: Path, assets: tuple[Path, ...], frames: FrameChoice | None, output: Path, options: BuildOptions
) -> voxrt.BuildResult:
    """Build an asset, or the animation of one or all."""
    with build_bar() as bar:
        if frames is None:
            return voxrt.build(asset, output, options, progress=bar.begin, estimated=bar.estimate, clustered=bar.tiles)
        made: Path | list[Path] = asset
        if frames == "files" and (len(assets) > 1 or not asset.is_dir()):
            from voxrt.animation_takes import natural_order  # noqa: PLC0415 - NumPy comes with it

            made = sorted(assets, key=natural_order)
        times = None if frames == "files" else voxrt.frame_times(*frames)
        return voxrt.build_animation(made, output, options, times=times, progress=bar.begin, estimated=bar.estimate)


def _check_company(assets: tuple[Path, ...], output: Path, preview: str | None) -> None:
    """Refuse several assets that would write the same files."""
    if len(assets) == 1:
        return
    if preview:
        raise UsageError(f"--preview {preview} is one picture for {len(assets)} assets; leave the file out")
    if output.suffix.lower() in voxrt.export.WORD_SUFFIXES and not output.is_dir():
        raise UsageError(f"-o {output} is one file for {len(assets)} assets; name a folder")
    from voxrt.asset_source import asset_name  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

    names: dict[str, Path] = {}
    for asset in assets:
        if not asset.is_file():
            raise voxrt.AssetError(asset, "no such file", fix="check the path; nothing was built")
        name = asset_name(asset)
        if name.casefold() in names:
            raise UsageError(
                f"{names[name.casefold()]} and {asset} would both be written to {output / name}.mem; build them one "
                "by one, each with an -o of its own"
            )
        names[name.casefold()] = asset


def _print_profile(seconds: dict[str, float], parts: dict[str, dict[str, float]]) -> None:
    total = sum(seconds.values())
    rows = [
        row
        for stage, took in seconds.items()
        for row in [(stage, took), *((f"  {part}", took) for part, took in parts.get(stage, {}).items())]
    ]
    percents = [(name, f"{1e3 * took:.1f}", f"{100 * took / total:.0f}") for name, took in rows]
    tabulate(("stage", "ms", "%"), [*percents, ("all", f"{1e3 * total:.1f}", "100")])


def _rows(result: voxrt.BuildResult) -> list[tuple[str, str]]:
    rom, total = result.rom, sum(result.seconds.values())
    size, shown = len(rom.octree.words), rom.materials[1:]
    voxel = f", {rom.grid.voxel_size:.4g} m each" if rom.grid else ""
    names = ", ".join(material.name for material in shown) if len(shown) <= _NAMED else "voxrt info lists them"
    stages = ", ".join(f"{stage} {took:.2f}" for stage, took in result.seconds.items() if took >= 0.005)
    return [
        ("grid", f"{1 << rom.octree.depth} voxels per side (depth {rom.octree.depth}){voxel}"),
        ("solid", f"{result.solid_voxels:,} voxels"),
        ("memory", f"{size:,} words, {size * 4 / 1024:,.1f} KiB"),
        *([("frames", frames_row(result.animation, size))] if result.animation else []),
        *([("interior", _interior(result.interior, rom))] if result.interior else []),
        *([("baked", _baked(result.bake))] if result.bake else []),
        *([("budget", _budget(result.budget))] if result.budget else []),
        ("materials", f"{len(rom.materials) - 1}" + (f": {names}" if shown else "")),
        *([("preview", picture_cost(result.preview.frame, result.preview.engine))] if result.preview else []),
        ("seconds", f"{total:.2f}" + (f": {stages}" if stages else "")),
        *(("wrote", str(path)) for path in result.outputs.values()),
    ]


def _interior(interior: voxrt.InteriorFit, rom: voxrt.Rom) -> str:
    made = "of any material" if interior.material is None else f"of {rom.materials[interior.material].name}"
    return f"{interior.hidden:,} hidden voxels are {made}; the memory took {interior.words_before:,} words before"


def _baked(bake: voxrt.Bake) -> str:
    return (
        f"{bake.voxels:,} voxels, {bake.samples} rays to the sky each; {bake.words:,} words, "
        f"{bake.words / bake.words_before:.1f} times the {bake.words_before:,} without baked light"
    )


def _loss(budget: voxrt.BudgetFit) -> str:
    """Say what a memory that does not fit gives up, and which depth does; nothing if it gives up little."""
    if budget.lossless is None:
        return ""
    depth, words = budget.lossless
    return (
        f"{budget.words:,} words give up {budget.fit.percent_changed:.0f} % of the surface; "
        f"--depth {depth} fits without loss, in {words:,} words"
    )


def _budget(budget: voxrt.BudgetFit) -> str:
    fit = budget.fit
    if not (fit.changed or fit.appeared or fit.recoloured):
        return f"{budget.words:,} words are enough, nothing is given up"
    return (
        f"{budget.words:,} of {fit.words_shared:,} words: {fit.percent_changed:.2f} % of the surface changed, "
        f"PSNR {budget.psnr:.1f} dB, SSIM {budget.ssim:.3f}"
    )
