"""``voxrt bitstream``."""

from __future__ import annotations

import tempfile
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

import voxrt
from voxrt.cli.inputs.lighting import supported
from voxrt.cli.results.bitstream_results import bitstream_result, selftest_result
from voxrt.cli.results.build_results import print_json
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import budget_loss, budget_text, summarize, warn
from voxrt.cli.terminal.progress import build_bar, stage_bar, transfer_bar
from voxrt.export.outputs import check_folder, check_output_folder, writing
from voxrt.options.notations import find_board

if TYPE_CHECKING:
    from voxrt.boards.bitstream import PlacedBoard
    from voxrt.cli.results.bitstream_results import BitstreamResult, PlacedResult
    from voxrt.export import Blob
    from voxrt.options.board_commands import BitstreamCommand

_SUFFIXES = (".bit", ".fs")


def run(options: BitstreamCommand) -> None:
    """Make the bitstream of a board that shows a scene, turning, on its monitor, or that of its self-test."""
    if options.seed is not None and not options.rebuild:
        raise UsageError("--seed is of the placement, which --rebuild makes; give both")
    if options.selftest:
        if options.source is not None or options.depth is not None:
            raise UsageError("--selftest shows no scene; leave out the asset and --depth")
        _make_selftest(options)
    elif options.source is None:
        raise UsageError("neither an asset, a memory nor --selftest says what the board shows; give one of them")
    else:
        _make_scene(options, options.source)


def _make_selftest(options: BitstreamCommand) -> None:
    from voxrt.boards.bitstream import find_loader, load_bitstream, pack  # noqa: PLC0415 - NumPy comes with it

    _check_output(options.output)
    if options.load:
        find_loader()
    placed = _place(_find_board(options.board), options.seed, rebuild=options.rebuild, selftest=True)
    file = _bits_file(options.output, placed, f"{placed.name}-selftest")
    _write_bits(file, pack(placed, placed.config))
    result = selftest_result(placed, file)
    summarize(
        f"self-test of {placed.name}:",
        [*board_rows(result, ""), ("wrote", result.bitstream), ("then", "voxrt board check serial:PORT")],
    )
    if options.load:
        load_bitstream(placed, file)
        summarize(f"{file.name}:", [("loaded", placed.title)])
    if options.reporting.json:
        print_json(result)


def _make_scene(options: BitstreamCommand, source: Path) -> None:
    from voxrt.boards.beam import SCREEN, SMALL, fit_beam, fit_frames  # noqa: PLC0415
    from voxrt.boards.bitstream import find_loader, load_bitstream, make_bitstream  # noqa: PLC0415 - NumPy comes with it
    from voxrt.boards.board_scenes import board_scene  # noqa: PLC0415
    from voxrt.views.viewpoint import orbit  # noqa: PLC0415

    _check_output(options.output)
    if options.load:
        find_loader()
    placed = _place(_find_board(options.board), options.seed, rebuild=options.rebuild)
    design = placed.design
    blob, budget = read_memory(source, options.depth, placed)
    features = {name for name in ("light", "mirrors") if design.core[name.capitalize()]}
    lighting = supported(blob.lighting or voxrt.Lighting(), features)
    fit, size = (fit_frames, SMALL) if design.frame_buffer else (fit_beam, SCREEN)
    with transfer_bar() as progress:
        count = partial(progress, "count cycles")
        beam = fit(blob.rom, orbit(blob.rom, size, roots=blob.roots), lighting, design.tracer, progress=count)
    bits = make_bitstream(placed, board_scene(blob), orbit(blob.rom, beam.size, roots=blob.roots), lighting, beam)
    file = _bits_file(options.output, placed, source.stem)
    report = file.with_suffix(".report.json")
    result = bitstream_result(blob.rom, placed, beam, file, budget)
    _write(file, bits, report, result)
    rows = summary_rows(result, report)
    if budget is not None:
        rows[-2:-2] = budget_rows(budget, source, result.depth, frame_buffer=design.frame_buffer)
    summarize(f"{source.name}:", rows)
    if options.load:
        load_bitstream(placed, file)
        summarize(f"{file.name}:", [("loaded", placed.title)])
    if options.reporting.json:
        print_json(result)


def _check_output(output: Path) -> None:
    if _names_file(output):
        check_folder(output.parent)
    else:
        check_output_folder(
            output, "no format of bitstreams", f"name a file with one of {', '.join(_SUFFIXES)}, or a folder"
        )


def _names_file(output: Path) -> bool:
    return output.suffix.lower() in _SUFFIXES and not output.is_dir()


def _bits_file(output: Path, placed: PlacedBoard, stem: str) -> Path:
    """Return the file of the bitstream: `output`, or `stem` in that folder."""
    if not _names_file(output):
        return output / f"{stem}{placed.suffix}"
    if output.suffix.lower() != placed.suffix:
        raise UsageError(f"--output: the bitstream of {placed.name} is a {placed.suffix} file, not {output.name}")
    return output


def _find_board(name: str) -> str:
    """Return the name of a board that voxrt brings, or the path of a board.json."""
    from voxrt.boards.bitstream import board_names  # noqa: PLC0415

    if name.endswith(".json"):
        return name
    try:
        return find_board(name, board_names())
    except ValueError as error:
        raise UsageError(f"--board: {error}; or give the path of a board.json") from error


def _place(name: str, seed: int | None, *, rebuild: bool, selftest: bool = False) -> PlacedBoard:
    from voxrt.boards.bitstream import read_board, rebuild_board  # noqa: PLC0415

    if not rebuild:
        return read_board(name, selftest=selftest)
    with stage_bar(1) as begin, tempfile.TemporaryDirectory(prefix="voxrt-") as folder:
        begin("synthesize, place and route")
        return rebuild_board(name, Path(folder), seed, selftest=selftest)


def read_memory(source: Path, depth: int | None, placed: PlacedBoard) -> tuple[Blob, voxrt.BudgetFit | None]:
    """Read a memory, or build an asset for the board's budget, and give what that took.

    What the bitstream cannot bring is refused.
    """
    from voxrt.export import Blob  # noqa: PLC0415
    from voxrt.octree import coarsen  # noqa: PLC0415
    from voxrt.voxelize.assets import SUFFIXES  # noqa: PLC0415

    capacity, most = placed.design.capacity, placed.design.core["MaxDepth"]
    if depth is not None and depth > most:
        raise voxrt.DoesNotFitError(f"--depth {depth}: {placed.name} traces up to {most} levels; give --depth {most}")
    if source.suffix.lower() in SUFFIXES:
        with build_bar() as bar:
            built = voxrt.build(source, depth=depth, budget=capacity, progress=bar.begin, estimated=bar.estimate)
        warn(built.warnings)
        if built.budget is not None and (loss := budget_loss(built.budget)):
            warn((voxrt.SceneWarning("budget", loss),))
        return Blob(built.rom, built.view, built.lighting), built.budget
    if depth is not None:
        raise UsageError(f"--depth is of assets, and {source} is a memory; leave it out")
    blob, warnings = voxrt.read_any(source)
    warn(warnings)
    tree = blob.rom.octree
    if len(tree.words) > capacity or tree.depth > most:
        fits = next(
            n for n in range(min(tree.depth, most), 0, -1) if len(coarsen(tree, tree.depth - n).words) <= capacity
        )
        remedy = f"build it with --depth {fits}, or give the asset"
        holder = placed.name
        if placed.design.frame_buffer and tree.depth <= most:
            holder = f"a bitstream of {placed.name}"
            remedy = f"write it into the running board: voxrt upload {source} --to serial:PORT"
        raise voxrt.DoesNotFitError(
            f"{source}: {len(tree.words):,} words and {tree.depth} levels, and {holder} holds {capacity:,} words "
            f"and {most} levels; {remedy}"
        )
    return blob, None


def _write_bits(file: Path, bits: bytes) -> None:
    from voxrt.export.atomic import write_atomically  # noqa: PLC0415

    with writing(file):
        file.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(file, bits)


def _write(file: Path, bits: bytes, report: Path, result: BitstreamResult) -> None:
    from voxrt.export.atomic import write_atomically  # noqa: PLC0415

    _write_bits(file, bits)
    with writing(report):
        write_atomically(report, msgspec.json.format(msgspec.json.encode(result), indent=1) + b"\n")


def budget_rows(budget: voxrt.BudgetFit, source: Path, depth: int, *, frame_buffer: bool) -> list[tuple[str, str]]:
    """Give the rows of what an asset gave up, and of how a board that has room for all of it shows it all."""
    fit = budget.fit
    if not (fit.changed or fit.appeared or fit.recoloured):
        return []
    rows = [("budget", budget_text(budget))]
    if frame_buffer:
        build = f"voxrt build {source} --depth {depth} -o out"
        rows.append(("all of it", f"{build}; voxrt upload out/{source.stem}.mem --to serial:PORT"))
    return rows


def summary_rows(result: BitstreamResult, report: Path) -> list[tuple[str, str]]:
    """Give the rows of the summary: names and values."""
    width, height = result.size
    squares = f", each pixel as {640 // width} x {640 // width}" if width < 640 else ""
    lanes = f"{result.lanes} lane{'' if result.lanes == 1 else 's'}"
    cycles = f"{result.cycles_per_pixel:.2f} per pixel in the slowest view; "
    if result.lead_lines is None:
        cycles += "whole pictures are shown, however long they take"
    elif result.lead_lines >= 0:
        cycles += f"rows are complete {result.lead_lines:.1f} lines before they are shown, or earlier"
    else:
        cycles += "some rows are repeated, because the next ones are late"
    return [
        *board_rows(result, f", {lanes}"),
        ("scene", f"{result.words:,} of {result.capacity:,} words, depth {result.depth}"),
        ("picture", f"{width} x {height}{squares}, {result.frames_per_second:.1f} frames per second"),
        ("cycles", cycles),
        ("wrote", result.bitstream),
        ("wrote", str(report)),
    ]


def board_rows(result: PlacedResult, lanes: str) -> list[tuple[str, str]]:
    """Give the rows of the board and of its clock."""
    reached, needed = result.fmax_mhz["system"], result.clock_hz / 1e6
    clock = f"place and route reach {reached:.1f} of {needed:.1f} MHz: the board may fail; try another --seed"
    return [
        ("board", f"{result.title}{lanes}, {result.clock_hz / 1e6:.1f} MHz"),
        *([("revision", _revision_text(result))] if result.revision else []),
        *([("clock", clock)] if reached < needed else []),
    ]


def _revision_text(result: PlacedResult) -> str:
    others = f"; {result.other_revisions}" if result.other_revisions else ""
    return f"the design is for {result.revision}{others}"
