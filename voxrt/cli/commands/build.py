"""``voxrt build``."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING

from msgspec.structs import replace

import voxrt
from voxrt.building.pipeline import build
from voxrt.building.view import check_preview
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import (
    budget_loss,
    budget_text,
    check_text,
    frames_row,
    picture_cost,
    summarize,
    tabulate,
    warn,
)
from voxrt.cli.terminal.process_age import process_age
from voxrt.cli.terminal.progress import build_bar
from voxrt.plans.estimate import hardware_seconds

if TYPE_CHECKING:
    from os import PathLike
    from pathlib import Path

    from voxrt.cli.terminal.progress import BuildBar
    from voxrt.options.build_command import BuildCommand
    from voxrt.sim import EngineCheck

_QUICK = 5.0  # seconds that a check may take which nobody asked for
_NAMED = 32  # so many materials still read as a list


def run(command: BuildCommand) -> None:
    """Build the octree memory of an asset: NAME.mem, its manifest NAME.json and a preview picture."""
    options = command.options
    if command.board is not None:
        if options.budget is not None:
            raise UsageError("--budget and --board exclude each other; give one of them")
        options = replace(options, budget=command.board)
    if command.check and command.no_check:
        raise UsageError("--check and --no-check exclude each other; give one of them")
    if (command.check or command.no_check) and not options.preview:
        raise UsageError("--check and --no-check are of a preview: give --preview as well")
    if command.frames is None:
        _check_company(command.assets, command.output, options.preview)
    else:
        _check_frames(command)
    _build_all(replace(command, options=options))


def _build_all(command: BuildCommand) -> None:
    """Build assets one after another, or the animation of all, and say what was made."""
    reports = []
    if command.fractions is not None:
        from voxrt.building.fractions import check_fractions_file  # noqa: PLC0415 - most builds write none

        check_fractions_file(command.fractions, command.options.depth)
        if len(command.assets) > 1:
            raise UsageError("--fractions is of one asset; build them one by one")
    waited = process_age()
    for asset in command.assets if command.frames is None else command.assets[:1]:
        begun = perf_counter()
        result, check = _build(asset, command)
        seconds = {"start": waited, **result.seconds}
        seconds["rest"] = max(0.0, perf_counter() - begun - sum(result.seconds.values()))
        waited = 0.0
        warn(result.warnings)
        by_touch = command.options.rule == "touch"
        if result.budget is not None and (loss := budget_loss(result.budget, by_touch=by_touch)):
            warn((voxrt.SceneWarning("budget", loss),))
        if command.fractions is not None:
            _write_fractions(result, command)
        if command.reporting.json:
            from voxrt.cli.results.build_results import build_report  # noqa: PLC0415 - most builds print a summary

            reports.append(build_report(result, seconds, check))
        else:
            summarize(f"{asset.name}:", _rows(result, check))
        if command.profile:
            _print_profile(seconds, result.parts)
        if check is not None and check.wrong_pixels:
            raise voxrt.SimulatorError(
                f"{asset}: {check.wrong_pixels} pixels differ between the hardware and its model; "
                "please report it with the file"
            )
    if command.reporting.json:
        from voxrt.cli.results.build_results import print_json  # noqa: PLC0415 - as above

        print_json(reports[0] if len(reports) == 1 else reports)


def _write_fractions(result: voxrt.BuildResult, command: BuildCommand) -> None:
    from voxrt.building.fractions import write_fractions  # noqa: PLC0415 - most builds write none
    from voxrt.voxelize import volume_fractions  # noqa: PLC0415

    assert command.fractions is not None
    assert result.rom.grid is not None
    options = command.options
    found = volume_fractions(
        result.scene, result.rom.grid, geometry=options.geometry, pow2=options.pow2, threads=options.threads
    )
    if found.without:
        message = "have no volume, since their surfaces are open or they are round: " + ", ".join(found.without[:20])
        warn((voxrt.SceneWarning("no-volume", f"objects {message}", len(found.without)),))
    write_fractions(found, result.scene, command.fractions)
    result.outputs["fractions"] = command.fractions


def _check_frames(command: BuildCommand) -> None:
    """Refuse what does not go together with the frames of an animation."""
    options = command.options
    excluded = {
        "--time": options.time,
        "--bake": options.bake or None,
        "--board": command.board,
        "--budget": options.budget,
        "--fractions": command.fractions,
        "--scheduler": options.scheduler,
        "--workers": options.workers,
    }
    for name, value in excluded.items():
        if value is not None:
            raise UsageError(f"{name} is not for the frames of an animation; leave it out")
    if command.frames != "files" and len(command.assets) > 1:
        raise UsageError(
            f"--frames with times is of one asset, and there are {len(command.assets)}; name one, or --frames files"
        )


def _build(asset: Path, command: BuildCommand) -> tuple[voxrt.BuildResult, EngineCheck | None]:
    """Build an asset, or the animation of one or all; then check its preview."""
    with build_bar() as bar:
        result = _built(asset, command, bar)
        begun = perf_counter()
        check = _check(result, command, bar)
        if check is not None:
            result.seconds["check"] = perf_counter() - begun
        return result, check


def _built(asset: Path, command: BuildCommand, bar: BuildBar) -> voxrt.BuildResult:
    assets, frames, output, options = command.assets, command.frames, command.output, command.options
    if frames is None:
        return build(
            asset, output, options, progress=bar.begin, estimated=bar.estimate, clustered=bar.tiles, rendered=bar.rows
        )
    made: Path | list[Path] = asset
    if frames == "files" and (len(assets) > 1 or not asset.is_dir()):
        from voxrt.sources.frames import natural_order  # noqa: PLC0415 - NumPy comes with it

        made = sorted(assets, key=natural_order)
    times = None if frames == "files" else voxrt.frame_times(*frames)
    return voxrt.build_animation(
        made, output, options, times=times, progress=bar.begin, estimated=bar.estimate, rendered=bar.rows
    )


def _check(result: voxrt.BuildResult, command: BuildCommand, bar: BuildBar) -> EngineCheck | None:
    """Compare the preview with the simulated hardware, if that is asked for, or is quick and possible."""
    if result.preview is None or command.no_check:
        return None
    if not command.check and (command.options.engine == "rtl" or hardware_seconds(command.options.size) > _QUICK):
        return None
    bar.begin("check")
    try:
        return check_preview(result, bar.rows)
    except voxrt.SimulatorError:
        if command.check:
            raise
        return None


def _check_company(assets: tuple[Path, ...], output: Path, preview: str | PathLike[str] | bool) -> None:
    """Refuse several assets that would write the same files."""
    if len(assets) == 1:
        return
    if not isinstance(preview, bool):
        raise UsageError(f"--preview {preview} is one picture for {len(assets)} assets; leave the file out")
    if output.suffix.lower() in voxrt.export.WORD_SUFFIXES and not output.is_dir():
        raise UsageError(f"-o {output} is one file for {len(assets)} assets; name a folder")
    from voxrt.voxelize.formats.external_files import as_text  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

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


def _rows(result: voxrt.BuildResult, check: EngineCheck | None) -> list[tuple[str, str]]:
    rom, total = result.rom, sum(result.seconds.values())
    size, materials = len(rom.octree.words), rom.materials[1:]
    voxel = f", {rom.grid.voxel_size:.4g} m each" if rom.grid else ""
    names = ", ".join(material.name for material in materials) if len(materials) <= _NAMED else "voxrt info lists them"
    stages = ", ".join(f"{stage} {took:.2f}" for stage, took in result.seconds.items() if took >= 0.005)
    return [
        ("grid", f"{1 << rom.octree.depth} voxels per side (depth {rom.octree.depth}){voxel}"),
        ("solid", f"{result.solid_voxels:,} voxels"),
        ("memory", f"{size:,} words, {size * 4 / 1024:,.1f} KiB"),
        *([("frames", frames_row(result.animation, size))] if result.animation else []),
        *([("interior", _interior(result.interior, rom))] if result.interior else []),
        *([("baked", _baked(result.bake))] if result.bake else []),
        *([("budget", budget_text(result.budget))] if result.budget else []),
        ("materials", f"{len(materials)}" + (f": {names}" if materials else "")),
        *([("preview", picture_cost(result.preview.frame, result.preview.engine))] if result.preview else []),
        *([("checked", check_text(check))] if check else []),
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
