"""``voxrt view``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

import voxrt
from voxrt import octree
from voxrt.cli.arguments import Pixels, UsageError, levels, png, whole
from voxrt.cli.messages import summarize, warn
from voxrt.export.octants import write_octants
from voxrt.outputs import check_folder, writing
from voxrt.voxelize.load import SUFFIXES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from cyclopts import Token

    from voxrt.octree import Rom


def _level(kind: type, tokens: Sequence[Token]) -> int:
    number = whole(kind, tokens)
    if not 0 <= number <= octree.MAX_DEPTH:
        raise ValueError(f"{number} is not 0 to {octree.MAX_DEPTH}")
    return number


def view(
    scene: Annotated[Path, Parameter(metavar="ROM|ASSET")],
    /,
    *,
    by: Literal["material", "level"] = "material",
    clip: Literal["x", "y", "z"] | None = None,
    level_limit: Annotated[int | None, Parameter(converter=_level, metavar="N")] = None,
    depth: Annotated[int | None, Parameter(converter=levels, metavar="N")] = None,
    size: Pixels = (1024, 768),
    screenshot: Annotated[Path | None, Parameter(metavar="FILE")] = None,
    export: Annotated[Path | None, Parameter(metavar="FILE")] = None,
    debug: Annotated[bool, Parameter(show_default=False)] = False,  # noqa: ARG001 - read where errors are explained
) -> None:
    """Show the octants of a memory, or of an asset, in a window or as a picture.

    Octants that others cover on all six sides are left out. In the window a click on an octant shows its address, word,
    level, bounds and material.

    Parameters
    ----------
    scene
        A .mem file or a memory in another format, or an asset, which is built on the way.
    by
        What the colours tell.
    clip
        Cut away the half of the scene that is nearer to the eye along this axis.
    level_limit
        Make octants of 2**N voxels a side uniform first, for fewer octants.
    depth
        Levels of the octree, for an asset and where no manifest says.
    size
        Width and height, pixels. [default: 1024x768]
    screenshot
        A .png to write instead of opening a window.
    export
        A .vtu to write instead of opening a window, for ParaView and PyVista.
    debug
        Show the traceback of an error.
    """
    if export is not None and export.suffix.lower() != ".vtu":
        raise UsageError(f"{export}: octants are exported to VTK files; give it a name that ends in .vtu")
    for file in (export, screenshot and png(screenshot)):
        if file is not None:
            check_folder(file.parent)
    rom = _read(scene, depth)
    if level_limit is not None:
        rom = replace(rom, octree=octree.coarsen(rom.octree, min(level_limit, rom.octree.depth)))
    grid = octree.octants(rom, high=_behind_cut(rom, clip))
    rows = [("shown", f"{grid.n_cells:,} octants"), ("hidden", f"{int(grid.field_data['hidden'][0]):,} octants")]
    if export is not None:
        with writing(export):
            export.parent.mkdir(parents=True, exist_ok=True)
            write_octants(grid, export)
        rows.append(("wrote", str(export)))
    if screenshot is not None:
        voxrt.save_picture(octree.picture(rom, grid, by=by, size=size), screenshot)
        rows.append(("wrote", str(screenshot)))
    summarize(f"{scene.name}:", rows)
    if export is None and screenshot is None:
        octree.show(rom, grid, by=by, size=size)


def _read(scene: Path, depth: int | None) -> Rom:
    if scene.suffix.lower() in SUFFIXES:
        result = voxrt.build(scene, depth=depth)
        warn(result.warnings)
        return result.rom
    blob, warnings = voxrt.read_any(scene, depth=depth)
    warn(warnings)
    return blob.rom


def _behind_cut(rom: Rom, axis: Literal["x", "y", "z"] | None) -> tuple[int, int, int] | None:
    bounds = octree.solid_bounds(rom.octree)
    if axis is None or bounds is None:
        return None
    high = [rom.octree.size] * 3
    number = "xyz".index(axis)
    high[number] = (bounds[0][number] + bounds[1][number]) // 2
    x, y, z = high
    return x, y, z
