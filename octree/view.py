"""Pictures of the octants, and a window to turn them in, by PyVista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from voxrt.octree.errors import ViewerError
from voxrt.octree.octant import octant_at
from voxrt.octree.octants import import_pyvista, octants

if TYPE_CHECKING:
    import os

    import pyvista
    from numpy.typing import NDArray

    from voxrt.octree.query import Corner
    from voxrt.octree.rom import Rom

Aspect: TypeAlias = Literal["material", "level"]

_TOWARDS_EYE = (0.62, 0.55, 1.0)  # a little to the right of the front, and above
_TOWARDS_SUN = (0.35, 1.0, 0.65)
_MARGIN = 0.92
_TEXT = (230, 233, 238)


def plot(
    rom: Rom,
    low: Corner = (0, 0, 0),
    high: Corner | None = None,
    *,
    by: Aspect = "material",
    size: tuple[int, int] = (1024, 768),
    screenshot: str | os.PathLike[str] | None = None,
) -> None:
    """Show the octants of a memory in a window, until it is closed, or save a picture of them.

    A click on an octant shows its word's address, the word, level, bounds and material.

    Parameters
    ----------
    rom
        The memory and its materials.
    low, high
        Only octants that overlap the voxels from `low` up to and without `high` (default: the world's end), whole.
    by
        What the colours tell.
    size
        Width and height, pixels.
    screenshot
        A picture to write instead of opening a window.

    Raises
    ------
    ViewerError
        PyVista is not installed, or there is no screen for a window.
    DoesNotFitError
        Too many octants.
    """
    grid = octants(rom, low, high)
    if screenshot is None:
        show(rom, grid, by=by, size=size)
    else:
        plotter = _draw(rom, grid, by, size, off_screen=True)
        plotter.screenshot(screenshot, return_img=False)
        plotter.close()


def picture(
    rom: Rom, grid: pyvista.UnstructuredGrid, *, by: Aspect = "material", size: tuple[int, int] = (1024, 768)
) -> NDArray[np.uint8]:
    """Draw the octants of `grid`, made by :func:`octants` (uint8, shape (H, W, 3), sRGB)."""
    plotter = _draw(rom, grid, by, size, off_screen=True)
    pixels = np.array(plotter.screenshot(None, return_img=True)[..., :3], np.uint8)
    plotter.close()
    return pixels


def show(
    rom: Rom, grid: pyvista.UnstructuredGrid, *, by: Aspect = "material", size: tuple[int, int] = (1024, 768)
) -> None:
    """Show the octants of `grid`, made by :func:`octants`, in a window until it is closed.

    Raises
    ------
    ViewerError
        There is no screen.
    """
    if not import_pyvista().system_supports_plotting():
        raise ViewerError("there is no screen to open a window on; save a picture instead (--screenshot FILE)")
    plotter = _draw(rom, grid, by, size, off_screen=False)

    def tell(picked: pyvista.UnstructuredGrid) -> None:
        x, y, z = np.floor(picked.center).astype(np.int64).tolist()
        plotter.add_text(describe(rom, (x, y, z)), position="lower_left", font_size=10, color=_TEXT, name="picked")

    plotter.enable_element_picking(tell, left_clicking=True, show_message=False, color=_TEXT, line_width=3)
    plotter.show()


def describe(rom: Rom, voxel: Corner) -> str:
    """Say all that the memory knows of the octant that holds a voxel, in lines."""
    octant = octant_at(rom.octree, voxel)
    ranges = ", ".join(
        f"{axis} {first}...{end - 1}" for axis, first, end in zip("xyz", octant.corner, octant.end, strict=True)
    )
    return "\n".join(
        (
            f"address 0x{octant.address:X}",
            f"word 0x{octant.word:08X}",
            f"level {octant.level}: {'x'.join([str(1 << octant.level)] * 3)} voxels",
            f"voxels {ranges}",
            f"material {octant.material}: {rom.materials[octant.material].name}",
        )
    )


def _draw(
    rom: Rom, grid: pyvista.UnstructuredGrid, by: Aspect, size: tuple[int, int], *, off_screen: bool
) -> pyvista.Plotter:
    pv = import_pyvista()
    if off_screen:
        _hush()
    plotter = pv.Plotter(off_screen=off_screen, window_size=size, lighting="none")
    plotter.set_background(rom.materials[0].colour)
    plotter.add_light(pv.Light(position=_TOWARDS_SUN, light_type="scene light", intensity=0.75))
    plotter.add_light(pv.Light(light_type="headlight", intensity=0.2))
    if grid.n_cells:
        look = {
            "show_edges": True,
            "edge_color": "black",
            "edge_opacity": 0.45,
            "line_width": 1,
            "ambient": 0.25,
            "culling": "back",
        }
        if by == "material":
            plotter.add_mesh(grid, scalars="colour", rgb=True, **look)
        else:
            _colour_levels(plotter, grid, look)
    told = f"{rom.name}: {grid.n_cells:,} octants shown, {int(grid.field_data['hidden'][0]):,} hidden"
    plotter.add_text(told, position="upper_left", font_size=10, color=_TEXT)
    if grid.n_cells:
        _frame(plotter, np.asarray(grid.points, np.float64), size)
    if off_screen:
        plotter.enable_anti_aliasing("ssaa")
    return plotter


def _frame(plotter: pyvista.Plotter, points: NDArray[np.float64], size: tuple[int, int]) -> None:
    """Stand where all points (shape (N, 3)) are in the picture, and as near as that allows.

    A point is in the picture when its distance aside is at most `half` times its depth, on both sides and axes: linear
    in where the camera stands.
    """
    look = -np.array(_TOWARDS_EYE) / np.linalg.norm(_TOWARDS_EYE)
    right = np.cross(look, (0, 1, 0))
    right /= np.linalg.norm(right)
    up = np.cross(right, look)
    depths, height = points @ look, _MARGIN * np.tan(np.radians(plotter.camera.view_angle) / 2)
    stands = []
    for axis, half in ((right, height * size[0] / size[1]), (up, height)):
        aside = points @ axis
        low, high = np.min(half * depths - aside), np.min(half * depths + aside)
        stands.append(((low + high) / (2 * half), (high - low) / 2))
    (depth_x, column), (depth_y, row) = stands
    eye = min(depth_x, depth_y) * look + column * right + row * up
    plotter.camera.position = tuple(eye)
    plotter.camera.focal_point = tuple(eye + (np.mean(depths) - min(depth_x, depth_y)) * look)
    plotter.camera.up = (0, 1, 0)
    plotter.reset_camera_clipping_range()


def _hush() -> None:
    """Keep VTK from telling standard error that it finds no screen, where none is needed."""
    from vtkmodules.vtkCommonCore import vtkLogger  # noqa: PLC0415 - optional

    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)


def _colour_levels(plotter: pyvista.Plotter, grid: pyvista.UnstructuredGrid, look: dict[str, object]) -> None:
    low, high = (int(level) for level in grid.get_data_range("level"))
    plotter.add_mesh(
        grid,
        scalars="level",
        cmap="viridis_r",
        clim=(low - 0.5, high + 0.5),
        n_colors=high - low + 1,
        annotations={float(level): f"{1 << level}" for level in range(low, high + 1)},
        scalar_bar_args={
            "title": "voxels a side",
            "n_labels": 0,
            "color": _TEXT,
            "vertical": True,
            "position_x": 0.9,
            "position_y": 0.72,
            "width": 0.06,
            "height": 0.26,
        },
        **look,
    )
