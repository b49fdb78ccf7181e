"""``voxrt trace``."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import Annotated

from cyclopts import Parameter

from voxrt.cli.arguments import Depth, Pixel, Pixels, Reporting, Sight
from voxrt.cli.errors import UsageError
from voxrt.cli.memory_results import trace_result
from voxrt.cli.messages import summarize, tabulate
from voxrt.cli.results import print_json
from voxrt.cli.source import read_source
from voxrt.options.build_options import PREVIEW_SIZE
from voxrt.sim import follow_pixel
from voxrt.view.ray_table import HEADS, describe_end, describe_root, ray_table


def trace(
    scene: Annotated[Path, Parameter(metavar="ROM|ASSET")],
    /,
    *,
    pixel: Pixel,
    size: Pixels = PREVIEW_SIZE,
    sight: Annotated[Sight, Parameter(name="*")] = Sight(),  # noqa: B008
    depth: Depth = None,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Print the path of one pixel's ray through the octree: each word that it reads, in order.

    Parameters
    ----------
    scene
        A memory (.mem or another format), or an asset, which is built first.
    pixel
        Column and row of the pixel in the picture of `voxrt render`, from the upper left.
    size
        Width and height of that picture in pixels. [default: 640x480]
    sight
        The camera.
    depth
        Levels of the octree, for an asset or for a memory without a manifest.
    reporting
        How results are printed.
    """
    check_pixel(pixel, size)
    source = read_source(scene, depth)
    camera = source.camera(size, sight)
    path = follow_pixel(source.rom.octree, camera, size, pixel)
    if reporting.json:
        print_json(trace_result(camera, size, pixel, path))
        return
    x, y, z = (f"{value / 16:g}" for value in path.origin)
    summarize(
        f"{scene.name}, pixel {pixel[0]},{pixel[1]} of {size[0]}x{size[1]}:",
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
