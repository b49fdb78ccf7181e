"""``voxrt compare``."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import Annotated

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Pixels, Reporting, png
from voxrt.cli.memory_results import compare_result
from voxrt.cli.messages import summarize, warn
from voxrt.cli.results import print_json


def compare(
    rom: Annotated[Path, Parameter(metavar="ROM")],
    asset: Annotated[Path, Parameter(metavar="ASSET")],
    /,
    *,
    output: Annotated[Path | None, Parameter(("--output", "-o"), metavar="FILE")] = None,
    size: Pixels = (640, 480),
    allow_outside: Annotated[bool, Parameter(show_default=False)] = False,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Compare a memory with the meshes that it was built from, as the default camera sees both.

    Parameters
    ----------
    rom
        A .mem file with its manifest.
    asset
        What it was built from.
    output
        A .png of the meshes, the memory and their difference, side by side.
    size
        Width and height, pixels. [default: 640x480]
    allow_outside
        Open files that the asset names outside its folder and the folders in it, too.
    reporting
        How to tell it.
    """
    if output is not None:
        png(output)
    blob, warnings = voxrt.read_any(rom)
    memory = blob.rom
    scene = voxrt.load(asset, allow_outside=allow_outside)
    warn((*warnings, *scene.warnings))
    found = voxrt.compare(scene, memory, voxrt.aim_camera(memory, size), size)
    if output is not None:
        voxrt.save_picture(voxrt.comparison_sheet(found), output)
    if reporting.json:
        print_json(compare_result(found.likeness, output))
        return
    likeness = asdict(found.likeness)
    rows = [(name.replace("_", " "), f"{value:.4g}") for name, value in likeness.items()]
    summarize(f"{rom.name} and {asset.name}:", rows + ([("wrote", str(output))] if output else []))
