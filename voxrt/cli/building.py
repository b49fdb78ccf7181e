"""What ``voxrt build`` does, once its command line is read."""

from __future__ import annotations

from importlib import import_module
from time import perf_counter
from typing import TYPE_CHECKING

import voxrt
from voxrt.cli.budget_messages import budget_loss, budget_text
from voxrt.cli.errors import UsageError
from voxrt.cli.messages import frames_row, picture_cost, summarize, tabulate, warn
from voxrt.cli.process_age import process_age
from voxrt.cli.progress import build_bar

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.cli.arguments import FrameChoice
    from voxrt.options.build_options import BuildOptions

_NAMED = 32  # so many materials still read as a list


def build_all(
    assets: tuple[Path, ...],
    output: Path,
    options: BuildOptions,
    *,
    frames: FrameChoice | None = None,
    profile: bool = False,
    json: bool = False,
) -> None:
    """Build assets one after another, or the animation of all, and say what was made."""
    reports = []
    import_module("voxrt.building.pipeline")  # a part of the start
    waited = process_age()
    for asset in assets if frames is None else assets[:1]:
        begun = perf_counter()
        result = _build(asset, assets, frames, output, options)
        seconds = {"start": waited, **result.seconds}
        seconds["rest"] = max(0.0, perf_counter() - begun - sum(result.seconds.values()))
        waited = 0.0
        warn(result.warnings)
        if result.budget is not None and (loss := budget_loss(result.budget)):
            warn((voxrt.SceneWarning("budget", loss),))
        if json:
            from voxrt.cli.results import build_report  # noqa: PLC0415 - most builds print a summary

            reports.append(build_report(result, seconds))
        else:
            summarize(f"{asset.name}:", _rows(result))
        if profile:
            _print_profile(seconds, result.parts)
    if json:
        from voxrt.cli.results import print_json  # noqa: PLC0415 - as above

        print_json(reports[0] if len(reports) == 1 else reports)


def check_frames(assets: tuple[Path, ...], frames: FrameChoice, others: dict[str, object]) -> None:
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
            from voxrt.sources.frames import natural_order  # noqa: PLC0415 - NumPy comes with it

            made = sorted(assets, key=natural_order)
        times = None if frames == "files" else voxrt.frame_times(*frames)
        return voxrt.build_animation(made, output, options, times=times, progress=bar.begin, estimated=bar.estimate)


def check_company(assets: tuple[Path, ...], output: Path, preview: str | None) -> None:
    """Refuse several assets that would write the same files."""
    if len(assets) == 1:
        return
    if preview:
        raise UsageError(f"--preview {preview} is one picture for {len(assets)} assets; leave the file out")
    if output.suffix.lower() in voxrt.export.WORD_SUFFIXES and not output.is_dir():
        raise UsageError(f"-o {output} is one file for {len(assets)} assets; name a folder")
    from voxrt.sources.source import as_text  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

    names: dict[str, Path] = {}
    for asset in assets:
        if not asset.is_file():
            raise voxrt.AssetError(asset, "no such file", fix="check the path; nothing was built")
        name = as_text(asset.stem)
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
        *([("budget", budget_text(result.budget))] if result.budget else []),
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
