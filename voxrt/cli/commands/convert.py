"""``voxrt convert``."""

from __future__ import annotations

from typing import TYPE_CHECKING

import voxrt
from voxrt.cli.inputs.configuration import find_configuration
from voxrt.cli.inputs.lighting import supported
from voxrt.cli.inputs.source import is_asset, read_source
from voxrt.cli.results.build_results import print_json
from voxrt.cli.results.memory_results import ConvertResult
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import name_file, summarize
from voxrt.export.outputs import check_folder, check_output_folder, writing
from voxrt.options.shared import PREVIEW_SIZE
from voxrt.views.writers import PANE_WRITERS

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.cli.inputs.source import Source
    from voxrt.options.memory_commands import ConvertCommand


def run(options: ConvertCommand) -> None:
    """Write a memory or an asset in another format. The suffixes of the files say which."""
    target, material = options.target, _colours(options.material)
    if material and is_asset(options.source):
        raise UsageError(f"--material is of node listings, and {options.source.name} has materials; leave it out")
    if options.form == "core":
        check_output_folder(target, "of a file, and --form core writes several", "name a folder")
        source = read_source(options.source, options.depth, options.from_dialect, material, frames=True)
        files = _write_core(source, target, options.config, options.size or PREVIEW_SIZE)
    else:
        if options.config is not None or options.size is not None:
            raise UsageError("--config and --size are of --form core; add that, or leave them out")
        if target.suffix.lower() not in voxrt.WRITABLE_SUFFIXES:
            raise UsageError(f"{target}: is not a format to write; name one of {', '.join(voxrt.WRITABLE_SUFFIXES)}")
        check_folder(target.parent)
        has_frames = target.suffix.lower() not in PANE_WRITERS
        source = read_source(options.source, options.depth, options.from_dialect, material, frames=has_frames)
        files = voxrt.convert(source.blob, target, dialect=options.dialect)
    if options.reporting.json:
        print_json(ConvertResult([name_file(file) for file in files], source.warnings))
    else:
        summarize(f"{options.source.name}:", [("wrote", str(file)) for file in files])


def _write_core(source: Source, folder: Path, config: str | None, size: tuple[int, int]) -> tuple[Path, ...]:
    """Write what a core holds; remove what another configuration has left in the folder."""
    from voxrt.board.errors import Refused  # noqa: PLC0415
    from voxrt.board.view import View  # noqa: PLC0415
    from voxrt.boards.board_scenes import board_scene  # noqa: PLC0415 - NumPy comes with it
    from voxrt.boards.core_files import MEMORY_FILES, check_fit, core_files, is_memory_file  # noqa: PLC0415
    from voxrt.export.atomic import write_together  # noqa: PLC0415

    lighting = source.blob.lighting or voxrt.Lighting()
    configuration = find_configuration(config or ("lit" if lighting.features else "tiny"))
    check_fit(source.rom, configuration)
    lighting = supported(lighting, set(configuration.features))
    view = View(source.camera(size), size, lighting=lighting)
    try:
        made = core_files(board_scene(source.blob), view, configuration)
    except Refused as error:
        raise voxrt.ViewpointError(str(error)) from error
    files = {folder / name: data for name, data in made.items()}
    stale = [folder / name for name in MEMORY_FILES if name not in made and is_memory_file(folder / name)]
    with writing(next(iter(files))):
        write_together({**files, **dict.fromkeys(stale)})
    return tuple(files)


def _colours(materials: tuple[str, ...]) -> dict[str, tuple[int, int, int]]:
    colours = {}
    for material in materials:
        name, _, digits = material.rpartition("=")
        try:
            red, green, blue = bytes.fromhex(digits.removeprefix("#"))
        except ValueError:
            raise UsageError(f"--material {material} is not NAME=RRGGBB, such as Roof=d65438") from None
        colours[name] = (red, green, blue)
    return colours
