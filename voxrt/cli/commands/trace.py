"""``voxrt trace``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.results.memory_results import trace_result
from voxrt.cli.terminal.messages import summarize, tabulate
from voxrt.cli.results.build_results import print_json
from voxrt.cli.inputs.source import read_source
from voxrt.options.build_options import PREVIEW_SIZE
from voxrt.sim import follow_pixel
from voxrt.view.ray_table import HEADS, describe_end, describe_root, ray_table

if TYPE_CHECKING:
    from voxrt.options.picture_commands import TraceCommand


def run(options: TraceCommand) -> None:
    """Print the path of one pixel's ray through the octree: each word that it reads, in order."""
    check_pixel(options.pixel, options.size)
    source = read_source(options.scene, options.depth)
    camera = source.camera(options.size, options.sight)
    path = follow_pixel(source.rom.octree, camera, options.size, options.pixel)
    if options.reporting.json:
        print_json(trace_result(camera, options.size, options.pixel, path))
        return
    x, y, z = (f"{value / 16:g}" for value in path.origin)
    summarize(
        f"{options.scene.name}, pixel {options.pixel[0]},{options.pixel[1]} of {options.size[0]}x{options.size[1]}:",
        [
            ("ray", f"from voxel {x}, {y}, {z} along {', '.join(map(str, path.direction))}"),
            ("root", describe_root(source.rom, path)),
            ("reads", f"{len(path.readings)} words"),
            ("hits", describe_end(source.rom, path)),
        ],
        answer=True,
    )
    if path.readings:
        tabulate(HEADS, ray_table(source.rom, path), answer=True)


def check_pixel(pixel: tuple[int, int], size: tuple[int, int]) -> None:
    """Refuse a pixel outside the picture."""
    if pixel[0] >= size[0] or pixel[1] >= size[1]:
        raise UsageError(
            f"pixel {pixel[0]},{pixel[1]} lies outside the picture of {size[0]}x{size[1]}; columns go to "
            f"{size[0] - 1}, rows to {size[1] - 1}"
        )
