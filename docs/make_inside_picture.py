"""Draw ``docs/pictures/inside.png``: what is solid of small surfaces, as voxrt finds it. Needs matplotlib."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from matplotlib import pyplot as plt

from voxrt import build, octree
from voxrt.voxelize import EMPTY, Material, Mesh, Scene, SceneObject

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

PICTURE = Path(__file__).parent / "pictures" / "inside.png"
DEPTH, SIDE = 5, 32
LOW, HIGH = (4, 4, 4), (28, 28, 28)
ALL = range(6)
# The corners of the sides that face -x, +x, -y, +y, -z and +z, counter-clockwise seen from outside.
SIDES = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]


def box(
    low: Sequence[int] = LOW, high: Sequence[int] = HIGH, turned: Sequence[int] = (), without: Sequence[int] = ()
) -> list[NDArray[np.float64]]:
    """Return the sides of a box, each of four corners; some are turned, some are left out."""
    ends = np.array([low, high], np.float64)
    corners = np.array([[ends[i & 1, 0], ends[i >> 1 & 1, 1], ends[i >> 2, 2]] for i in range(8)])
    sides = [corners[list(side)] for side in SIDES]
    return [side[::-1] if i in turned else side for i, side in enumerate(sides) if i not in without]


CASES = {
    "one side turned": box(turned=(1,)),
    "each side twice, once per way": box() + box(turned=ALL),
    "a wall within": box(high=(16, 28, 28)) + box(low=(16, 4, 4), without=(0,)),
    "a cavity: the inner box faces inwards": box() + box((10, 10, 10), (22, 22, 22), turned=ALL),
    "two boxes that cross": box(high=(20, 20, 28)) + box(low=(12, 12, 4)),
    "open: one side is missing": box(without=(1,)),
}


def solid_slice(sides: list[NDArray[np.float64]]) -> NDArray[np.bool_]:
    """Return which voxels of the middle layer are solid: shape (SIDE, SIDE), indexed [x, y]."""
    faces = [4 * i + np.array(face) for i in range(len(sides)) for face in ((0, 1, 2), (0, 2, 3))]
    mesh = Mesh(np.concatenate(sides), np.array(faces), np.ones(len(faces), np.uint8))
    scene = Scene("case", [SceneObject("case", mesh)], [EMPTY, Material("stone", (150, 150, 150))])
    built = build(scene, depth=DEPTH, bounds=(0, 0, 0, SIDE, SIDE, SIDE))
    layer = octree.to_dense(built.octree, (0, 0, SIDE // 2), (SIDE, SIDE, SIDE // 2 + 1))
    return np.asarray(layer[:, :, 0] != 0)


def main() -> None:
    """Draw the middle layer of each case: its solid voxels, its sides, and an arrow the way that each side faces."""
    figure, axes = plt.subplots(2, 3, figsize=(9, 6.4))
    for place, (title, sides) in zip(axes.flat, CASES.items(), strict=True):
        place.imshow(solid_slice(sides).T, origin="lower", extent=(0, SIDE, 0, SIDE), cmap="Oranges", vmin=0, vmax=2)
        for number, side in enumerate(sides):
            low, high = side.min(axis=0), side.max(axis=0)
            if low[2] == high[2]:  # parallel to the layer
                continue
            place.plot(*np.stack([low, high])[:, :2].T, color="black")
            facing = np.cross(side[1] - side[0], side[2] - side[0])[:2]
            middle = (low + high)[:2] / 2 + 3 * (number % 3 - 1) * np.abs(facing[::-1]) / np.abs(facing).max()
            place.annotate(
                "",
                middle + 2.5 * facing / np.abs(facing).max(),
                middle,
                arrowprops={"arrowstyle": "->", "color": "tab:blue"},
            )
        place.set_title(title, fontsize=10)
        place.set_axis_off()
    figure.tight_layout()
    figure.savefig(PICTURE, dpi=110, metadata={"Software": None})


if __name__ == "__main__":
    main()
