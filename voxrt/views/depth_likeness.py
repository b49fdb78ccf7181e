"""The similarity of voxels to their meshes at each depth, and the words that it takes."""

from __future__ import annotations

from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt import octree, sim, voxelize
from voxrt.views.viewpoint import aim_camera
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from voxrt.sim import Likeness
    from voxrt.voxelize import Scene


class LikenessAtDepth(Value, frozen=True):
    """A scene at one depth, as :func:`likeness_curve` finds it.

    Attributes
    ----------
    depth
        Levels of the octree.
    words
        Words of its memory.
    likeness
        The similarity of its picture to that of the meshes; distances in voxels of this grid.
    """

    depth: int
    words: int
    likeness: Likeness


def likeness_curve(
    scene: Scene, depths: Iterable[int], size: tuple[int, int], *, threads: int = 0
) -> tuple[LikenessAtDepth, ...]:
    """Compare the voxels of a scene with its meshes at several depths, from one camera.

    Parameters
    ----------
    scene
        The source.
    depths
        The depths, ascending, 1 … 16 each. The camera frames the scene at the last.
    size
        Columns and rows of the pictures.
    threads
        Threads of the native stages; 0 takes one per core.

    Returns
    -------
    tuple[LikenessAtDepth, ...]
        One per depth.

    Raises
    ------
    SimulatorError
        Open3D is not installed.

    Examples
    --------
    >>> import voxrt
    >>> curve = likeness_curve(voxrt.load("examples/house.obj"), [3, 5], (64, 48))
    >>> curve[0].words < curve[1].words, curve[0].likeness.depth_mean > 0
    (True, True)
    """
    roms = [_rom(scene, depth, threads) for depth in depths]
    finest = roms[-1].octree.depth
    camera = aim_camera(roms[-1], size)
    curve = []
    for rom in roms:
        x, y, z = (int(place) for place in np.rint(np.ldexp(camera.position, rom.octree.depth - finest)))
        found = sim.compare(scene, rom, replace(camera, position=(x, y, z)), size)
        curve.append(LikenessAtDepth(rom.octree.depth, len(rom.octree.words), found.likeness))
    return tuple(curve)


def draw_likeness_curve(curve: tuple[LikenessAtDepth, ...]) -> NDArray[np.uint8]:
    """Plot a curve against depth and against words.

    Returns
    -------
    NDArray[np.uint8]
        Shape (H, W, 3), sRGB.

    Raises
    ------
    SimulatorError
        Matplotlib is not installed.

    Examples
    --------
    >>> import voxrt
    >>> curve = likeness_curve(voxrt.load("examples/house.obj"), [3, 4], (64, 48))
    >>> draw_likeness_curve(curve).shape
    (600, 900, 3)
    """
    try:
        from matplotlib.figure import Figure  # noqa: PLC0415 - slow to load, optional
    except ImportError as error:
        raise sim.SimulatorError(
            "drawing a curve needs matplotlib, which is not installed; pip install matplotlib"
        ) from error
    figure = Figure(figsize=(9, 6), dpi=100, layout="constrained")
    places = figure.subplots(2, 2, sharey="row")
    for column, (across, label) in enumerate((("depth", "depth"), ("words", "words of memory"))):
        at = [getattr(point, across) for point in curve]
        worlds = [point.likeness.depth_mean / (1 << point.depth) for point in curve]
        places[0, column].plot(at, worlds, "o-", color="tab:red", label="mean depth error / side of the world")
        places[0, column].set_yscale("log")
        for name, what in (("silhouette_iou", "silhouette IoU"), ("ssim", "SSIM"), ("normal_agreement", "normals")):
            places[1, column].plot(at, [getattr(point.likeness, name) for point in curve], "o-", label=what)
        for row in (0, 1):
            places[row, column].grid(visible=True, alpha=0.3)
            places[row, column].legend(fontsize=8)
            if across == "words":
                places[row, column].set_xscale("log")
        places[1, column].set_xlabel(label)
    drawn = BytesIO()
    figure.savefig(drawn, format="rgba")
    return np.frombuffer(drawn.getvalue(), np.uint8).reshape(600, 900, 4)[..., :3].copy()


def _rom(scene: Scene, depth: int, threads: int) -> octree.Rom:
    grid = voxelize.fit_grid(scene, depth=depth)
    scene = voxelize.assign_colours(scene, grid)
    voxels = voxelize.voxelize(scene, grid, threads=threads).voxels
    return octree.Rom(scene.name, octree.build(voxels, threads=threads), scene.materials, grid)
