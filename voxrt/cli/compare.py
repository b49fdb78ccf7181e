"""``voxrt compare``."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Pixels, Reporting, png
from voxrt.cli.memory_results import compare_result
from voxrt.cli.messages import complain, summarize, tabulate, warn
from voxrt.cli.results import print_json

if TYPE_CHECKING:
    from voxrt.octree import Rom
    from voxrt.sim import Camera, EngineCheck
    from voxrt.views.depth_likeness import LikenessAtDepth

_COARSEST = 3
"""The first depth of the curve."""


def compare(
    rom: Annotated[Path, Parameter(metavar="ROM")],
    asset: Annotated[Path, Parameter(metavar="ASSET")],
    /,
    *,
    output: Annotated[Path | None, Parameter(("--output", "-o"), metavar="FILE")] = None,
    curve: Annotated[Path | None, Parameter(metavar="FILE")] = None,
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
        A .png of four pictures side by side: the meshes, the memory by the simulated hardware and by the exact model,
        and the difference.
    curve
        A .png that plots the similarity against depth and words. The asset is built at each depth up to the memory's.
    size
        Width and height in pixels. [default: 640x480]
    allow_outside
        Also open files that the asset names outside of its own folder.
    reporting
        How results are printed.
    """
    for picture in (output, curve):
        if picture is not None:
            png(picture)
    blob, warnings = voxrt.read_any(rom)
    memory = blob.rom
    scene = voxrt.load(asset, allow_outside=allow_outside)
    warn((*warnings, *scene.warnings))
    camera = voxrt.aim_camera(memory, size)
    found = voxrt.compare(scene, memory, camera, size)
    hardware = _hardware(memory, camera, size)
    outputs = {}
    if output is not None:
        voxrt.save_picture(voxrt.comparison_sheet(found, None if hardware is None else hardware.rtl.colour), output)
        outputs["picture"] = output
    points: tuple[LikenessAtDepth, ...] = ()
    if curve is not None:
        lowest = min(_COARSEST, memory.octree.depth)
        points = voxrt.likeness_curve(scene, range(lowest, memory.octree.depth + 1), size)
        voxrt.save_picture(voxrt.draw_likeness_curve(points), curve)
        outputs["curve"] = curve
    wrong = None if hardware is None else hardware.wrong_pixels
    if reporting.json:
        print_json(compare_result(found.likeness, wrong, points, outputs))
        return
    rows = [(name.replace("_", " "), f"{value:.4g}") for name, value in asdict(found.likeness).items()]
    if wrong is not None:
        rows.append(("hardware", f"{wrong} pixels differ from the exact model"))
    summarize(f"{rom.name} and {asset.name}:", rows + [("wrote", str(path)) for path in outputs.values()], answer=True)
    if points:
        heads = ("depth", "words", "silhouette IoU", "mean depth error, voxels", "SSIM", "PSNR, dB")
        tabulate(heads, [_row(point) for point in points], answer=True)


def _hardware(memory: Rom, camera: Camera, size: tuple[int, int]) -> EngineCheck | None:
    """Render by both engines; None where the simulated hardware is missing or cannot hold the memory."""
    try:
        return voxrt.check(memory, camera, size, lighting=voxrt.Lighting(faces=None))
    except voxrt.SimulatorError as error:
        complain(f"without the hardware's picture: {error}")
        return None


def _row(point: LikenessAtDepth) -> tuple[str, ...]:
    told = point.likeness
    figures = (told.silhouette_iou, told.depth_mean, told.ssim, told.psnr)
    return (str(point.depth), f"{point.words:,}", *(f"{figure:.4g}" for figure in figures))
