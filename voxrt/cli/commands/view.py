"""``voxrt view``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

import voxrt
from voxrt import octree
from voxrt import view as drawing
from voxrt.cli.commands.trace import check_pixel
from voxrt.cli.inputs.source import Source, read_source
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import summarize
from voxrt.export.outputs import check_folder, writing
from voxrt.options.shared import PREVIEW_SIZE
from voxrt.view.animation import ANIMATION_SUFFIXES, write_animation
from voxrt.view.plotter import check_screen
from voxrt.view.scene_overlay import find_owners, preview_of, scene_triangles
from voxrt.views.writers import PANE_WRITERS
from voxrt.voxelize.formats.external_files import as_text

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from voxrt.options.picture_commands import ViewCommand
    from voxrt.view import Pane

_TURNS = 72  # pictures of a turntable
_SIZE, _WIDE = (1024, 768), (1280, 720)


def run(options: ViewCommand) -> None:
    """Show the octants of a memory or of an asset, in a window or as a picture."""
    _check_files(options)
    _check_company(options)
    paths = [path for path in (options.scene, options.other) if path is not None]
    sources = [read_source(path, options.depth) for path in paths]
    in_window = options.output is None and options.screenshot is None and options.turntable is None
    if in_window:
        check_screen(off_screen=False)
    panes = [_pane(source, as_text(path.stem), options) for source, path in zip(sources, paths, strict=True)]
    if options.level_limit is not None:
        panes = [pane.coarsened(options.level_limit) for pane in panes]
    if options.clip:
        panes = [replace(pane, high=_half(pane, "xyz".index(options.clip))) for pane in panes]
    elif options.slice:
        panes = [replace(pane, high=_below(pane, options.slice), cut=True) for pane in panes]
    size = options.size or (_SIZE if options.other is None and options.ray is None else _WIDE)
    preview = None
    if options.ray is not None:
        camera = sources[0].camera(PREVIEW_SIZE)
        preview = preview_of(panes[0].rom, camera, PREVIEW_SIZE, options.ray, flat=panes[0].flat)
    rows = _octant_rows(panes)
    writers: list[tuple[Path | None, Callable[[Path], None]]] = [
        (options.output, lambda file: PANE_WRITERS[file.suffix.lower()](file, panes[0])),
        (options.screenshot, lambda file: voxrt.save_picture(drawing.picture(panes, size, preview=preview), file)),
        (options.turntable, lambda file: write_animation(file, drawing.turntable(panes, size, _TURNS))),
    ]
    for file, write in writers:
        if file is not None:
            with writing(file):
                write(file)
            rows.append(("wrote", str(file)))
    summarize(f"{options.scene.name}:", rows)
    if in_window:
        drawing.Window(panes, size, preview=preview).show()


def _check_files(options: ViewCommand) -> None:
    output, turntable = options.output, options.turntable
    if output is not None and output.suffix.lower() not in PANE_WRITERS:
        raise UsageError(f"{output}: octants are written to files that end in {', '.join(PANE_WRITERS)}")
    if turntable is not None and turntable.suffix.lower() not in ANIMATION_SUFFIXES:
        raise UsageError(f"{turntable}: turntables are files that end in {' or '.join(ANIMATION_SUFFIXES)}")
    for file in (output, turntable, options.screenshot):
        if file is not None:
            check_folder(file.parent)


def _check_company(options: ViewCommand) -> None:
    ray, other, output = (value is not None for value in (options.ray, options.other, options.output))
    for first, second, excluded in (
        ("--ray", "a second scene", ray and other),
        ("--ray", "--turntable", ray and options.turntable is not None),
        ("--output", "--ray", output and ray),
        ("--output", "a second scene", output and other),
        ("--clip", "--slice", options.clip and options.slice),
    ):
        if excluded:
            raise UsageError(f"{first} and {second} exclude each other")
    if options.ray is not None:
        check_pixel(options.ray, PREVIEW_SIZE)


def _pane(source: Source, name: str, options: ViewCommand) -> Pane:
    lighting, by = source.blob.lighting, options.by
    pane = drawing.Pane(replace(source.rom, name=name), by=by, flat=lighting is not None and lighting.flat)
    if by != "owner" and not options.overlay:
        return pane
    if source.scene is None or source.rom.grid is None:
        raise UsageError(
            f"{name}: a memory knows no {'owners' if by == 'owner' else 'triangles'}; name the asset instead"
        )
    if by == "owner":
        pane = replace(pane, owners=find_owners(source.scene, source.rom.grid))
    if options.overlay:
        pane = replace(pane, triangles=scene_triangles(source.scene, source.rom.grid))
    return pane


def _octant_rows(panes: list[Pane]) -> list[tuple[str, str]]:
    rows = []
    for pane in panes:
        mesh = pane.mesh()
        if len(panes) > 1:
            rows.append(("memory", pane.rom.name))
        rows.append(("shown", f"{len(mesh.levels):,} octants"))
        rows.append(("hidden", f"{mesh.hidden:,} octants"))
    return rows


def _half(pane: Pane, axis: int) -> tuple[int, int, int] | None:
    bounds = octree.solid_bounds(pane.rom.octree)
    return bounds and _below(pane, ((axis, (bounds[0][axis] + bounds[1][axis]) // 2),))


def _below(pane: Pane, cuts: tuple[tuple[int, int], ...]) -> tuple[int, int, int]:
    high = [pane.rom.octree.size] * 3
    for axis, place in cuts:
        high[axis] = min(high[axis], place)
    x, y, z = high
    return x, y, z
