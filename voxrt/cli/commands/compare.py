"""``voxrt compare``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import asdict

import voxrt
from voxrt.cli.results.build_results import print_json
from voxrt.cli.results.memory_results import compare_result
from voxrt.cli.terminal.messages import complain, summarize, tabulate, warn

if TYPE_CHECKING:
    from voxrt.octree import Rom
    from voxrt.options.picture_commands import CompareCommand
    from voxrt.sim import Camera, EngineCheck
    from voxrt.views.depth_likeness import LikenessAtDepth

_COARSEST = 3
"""The first depth of the curve."""


def run(options: CompareCommand) -> None:
    """Compare a memory with the meshes that it was built from, as the default camera sees both."""
    blob, warnings = voxrt.read_any(options.rom)
    memory = blob.rom
    scene = voxrt.load(options.asset, allow_outside=options.allow_outside)
    warn((*warnings, *scene.warnings))
    camera = voxrt.aim_camera(memory, options.size)
    found = voxrt.compare(scene, memory, camera, options.size)
    hardware = _hardware(memory, camera, options.size) if options.check else None
    outputs = {}
    if options.output is not None:
        voxrt.save_picture(
            voxrt.comparison_sheet(found, None if hardware is None else hardware.rtl.colour), options.output
        )
        outputs["picture"] = options.output
    points: tuple[LikenessAtDepth, ...] = ()
    if options.curve is not None:
        lowest = min(_COARSEST, memory.octree.depth)
        points = voxrt.likeness_curve(scene, range(lowest, memory.octree.depth + 1), options.size)
        voxrt.save_picture(voxrt.draw_likeness_curve(points), options.curve)
        outputs["curve"] = options.curve
    wrong = None if hardware is None else hardware.wrong_pixels
    if options.reporting.json:
        print_json(compare_result(found.likeness, wrong, points, outputs))
        return
    rows = [(name.replace("_", " "), f"{value:.4g}") for name, value in asdict(found.likeness).items()]
    if wrong is not None:
        rows.append(("hardware", f"{wrong} pixels differ from the exact model"))
    summarize(
        f"{options.rom.name} and {options.asset.name}:",
        rows + [("wrote", str(path)) for path in outputs.values()],
        answer=True,
    )
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
    likeness = point.likeness
    figures = (likeness.silhouette_iou, likeness.depth_mean, likeness.ssim, likeness.psnr)
    return (str(point.depth), f"{point.words:,}", *(f"{figure:.4g}" for figure in figures))
