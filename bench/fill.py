"""What ``--fill`` makes of open meshes: solid voxels of the development assets with each choice.

Usage: ``python bench/fill.py [--write]``. ``--write`` puts the table into ``bench/results/fill.md`` as well. It has the
assets for which ``auto`` differs from ``solid``, or of which ``solid`` notes that an open object is mostly filled.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from report import ASSETS, options_of, write_page

import voxrt
from voxrt.voxelize import AssetError, DoesNotFitError

if TYPE_CHECKING:
    from pathlib import Path

SUFFIXES = (".gltf", ".glb", ".obj", ".ply", ".stl", ".usd", ".usda", ".usdc", ".usdz")
LEFT_OUT = ("malformed", "trouble", "24_gpu_instancing", "teapotScene", "PointInstancer", "chess_set")
DEPTH = 7


def measure(path: Path) -> tuple[list[int], int] | None:
    """Give the solid voxels for surface, solid and auto, and the open objects that solid fills for the most part."""
    try:
        scene = voxrt.load(path, allow_outside=True)
        built = [voxrt.build(scene, depth=DEPTH, geometry="render", fill=fill) for fill in ("surface", "solid", "auto")]
    except (AssetError, DoesNotFitError):
        return None
    noted = sum(warning.count for warning in built[1].warnings if warning.kind == "mostly-filled")
    return [one.solid_voxels for one in built], noted


def main() -> None:
    parser = options_of(__doc__)
    options = parser.parse_args()
    lines, same = [], 0
    for path in sorted(ASSETS.rglob("*")):
        name = str(path.relative_to(ASSETS))
        if path.suffix.lower() not in SUFFIXES or any(part in name for part in LEFT_OUT):
            continue
        if (found := measure(path)) is None:
            continue
        (surface, solid, auto), noted = found
        if solid == auto and not noted:
            same += 1
            continue
        lines.append(f"| `{name}` | {surface:,} | {solid:,} | {auto:,} | {noted or ''} |")
        print(lines[-1], flush=True)
    print(f"{same} others are the same")
    if options.write:
        head = "| asset | surface | solid | auto | objects noted |\n|---|--:|--:|--:|--:|"
        about = (
            f"Solid voxels by `--fill` at depth {DEPTH}, by `bench/fill.py`: the assets for which `auto` differs from "
            f"`solid`, and\nthose of which `solid` notes that open objects are mostly filled. For {same} others both "
            "are the same and nothing is noted.\n"
        )
        write_page("fill.md", f"# Fill\n\n{about}\n{head}\n" + "\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
