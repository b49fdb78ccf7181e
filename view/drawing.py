"""Panes drawn by PyVista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.octree.owners import SEVERAL
from voxrt.view.cells import import_pyvista, open_sides
from voxrt.view.legend import draw_legend, legend_width, remove_legend
from voxrt.view.plotter import TEXT, check_screen, place_eye
from voxrt.view.ray_drawing import PREVIEW_HEIGHT, PREVIEW_WIDTH, draw_preview, draw_ray

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista
    from numpy.typing import NDArray

    from voxrt.octree.owners import Owners
    from voxrt.view.legend import Entry
    from voxrt.view.pane import Pane, Preview

_TITLE = 34  # pixels above the octants that are kept free
_TOOLS = 0.18  # part of a window below them that is kept free
_GOLDEN_TURN = 0.6180339887498949  # sets the hues of neighbours far apart
_MESH = (255, 214, 90)
_BEFORE = -66000  # to the very front, in steps of the depth buffer
_GHOST = 0.15  # how much of the octants is seen where a ray is shown


def draw(
    panes: Sequence[Pane], size: tuple[int, int], *, preview: Preview | None = None, off_screen: bool
) -> tuple[pyvista.Plotter, list[pyvista.UnstructuredGrid]]:
    """Draw panes side by side, seen alike; or one, a preview beside it and the ray of the preview's pixel.

    Return the plotter, whose last subplots are the panes, and the cells of each pane. `size` is the width and height of
    all together, pixels. ViewerError where PyVista is missing, or there is nothing to draw on.
    """
    check_screen(off_screen=off_screen)
    pv = import_pyvista()
    layout: dict[str, Any] = {"shape": (1, len(panes))}
    if preview is not None:
        layout = {
            "shape": (2, 2),
            "groups": [(slice(None), 1)],
            "col_weights": [PREVIEW_WIDTH, 1 - PREVIEW_WIDTH],
            "row_weights": [PREVIEW_HEIGHT, 1 - PREVIEW_HEIGHT],
        }
    plotter = pv.Plotter(off_screen=off_screen, window_size=size, lighting="none", border=False, **layout)
    grids = [pane.grid() for pane in panes]
    for number, (pane, grid) in enumerate(zip(panes, grids, strict=True)):
        enter(plotter, number, preview is not None)
        plotter.set_background(pane.rom.materials[0].colour, all_renderers=False)
        draw_octants(plotter, number, pane, grid, level_range(grids), ghost=preview is not None)
        if pane.triangles is not None:
            _draw_triangles(plotter, pane.triangles)
        if grid.n_cells:
            legend = 0 if all(pane.by == "material" for pane in panes) else legend_width(plotter)
            room = (0, legend, 0 if off_screen else _TOOLS, min(0.2, _TITLE / size[1]))
            place_eye(plotter, np.asarray(grid.points, np.float64), room=room)
    if preview is not None:
        draw_preview(plotter, preview.colour)
        draw_ray(plotter, panes[0], preview, preview.pixel)
    elif len(panes) > 1:
        plotter.link_views()
    if off_screen:
        plotter.enable_anti_aliasing("ssaa", all_renderers=True)
    return plotter, grids


def enter(plotter: pyvista.Plotter, number: int, beside_preview: bool) -> None:
    """Go to the subplot of a pane."""
    plotter.subplot(0, 1 if beside_preview else number)


def level_range(grids: Sequence[pyvista.UnstructuredGrid]) -> tuple[int, int]:
    """Tell the lowest and the highest level of some octants; 0 where there are none."""
    levels = np.concatenate([np.asarray(grid.cell_data["level"], np.int64) for grid in grids])
    return (int(levels.min()), int(levels.max())) if len(levels) else (0, 0)


def draw_octants(
    plotter: pyvista.Plotter,
    number: int,
    pane: Pane,
    grid: pyvista.UnstructuredGrid,
    levels: tuple[int, int],
    *,
    ghost: bool = False,
) -> None:
    """Draw the octants of a pane in the current subplot, in place of those that were there, and say how many.

    `levels` are those that colours tell apart; a ghost lets the ray be seen through it and has no text.
    """
    add_octants(plotter, f"octants {number}", pane, grid, levels, ghost=ghost)
    if ghost:
        return
    remove_legend(plotter, "legend")
    if grid.n_cells and (entries := _legend(pane, grid, levels)):
        top = 1 - min(0.2, _TITLE / plotter.window_size[1])
        draw_legend(plotter, "legend", entries, left=1 - legend_width(plotter), top=top)
    caption = f"{pane.rom.name}: {grid.n_cells:,} octants shown, {int(grid.field_data['hidden'][0]):,} hidden"
    plotter.add_text(caption, position="upper_left", font_size=10, color=TEXT, name=f"told {number}")


def add_octants(
    plotter: pyvista.Plotter,
    name: str,
    pane: Pane,
    grid: pyvista.UnstructuredGrid,
    levels: tuple[int, int],
    *,
    ghost: bool = False,
) -> pyvista.Actor | None:
    """Draw octants in the current subplot, in place of those of that name; None where there are none."""
    look: dict[str, Any] = {
        "name": name,
        "show_edges": not ghost,
        "edge_color": "black",
        "edge_opacity": 0.45,
        "line_width": 1,
        "lighting": False,
        "culling": "back",
        "reset_camera": False,
        "opacity": _GHOST if ghost else 1.0,
    }
    plotter.remove_actor(name)
    if not grid.n_cells:
        return None
    return plotter.add_mesh(_sides(pane, grid, levels), scalars="colour", rgb=True, **look)


def _draw_triangles(plotter: pyvista.Plotter, triangles: NDArray[np.float64]) -> None:
    pv = import_pyvista()
    faces = np.insert(np.arange(3 * len(triangles)).reshape(-1, 3), 0, 3, axis=1)
    mesh = pv.PolyData(triangles.reshape(-1, 3), faces.ravel())
    actor = plotter.add_mesh(
        mesh, color=_MESH, style="wireframe", line_width=1, lighting=False, culling="back", reset_camera=False
    )
    # The octants hold the mesh within them: its lines are drawn as if they stood before.
    actor.mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor.mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0, _BEFORE)


def _sides(pane: Pane, grid: pyvista.UnstructuredGrid, levels: tuple[int, int]) -> pyvista.PolyData:
    """Give the sides of octants that can be seen, in their colours; each face has the brightness of pictures."""
    pv = import_pyvista()
    quads, cells = open_sides(grid)
    points = np.asarray(grid.points)
    sides = pv.PolyData(points, np.insert(quads, 0, 4, axis=1).ravel())
    if pane.by == "owner":
        assert pane.owners is not None
        colours = _owner_colours(pane.owners)[np.asarray(grid.cell_data["owner"])[cells]]
    elif pane.by == "level":
        colours = _level_colours(levels)[np.asarray(grid.cell_data["level"], np.int64)[cells] - levels[0]]
    else:
        colours = np.asarray(grid.cell_data["colour"])[cells]
    corner, right, _, up = (points[quads[:, at]].astype(np.float64) for at in range(4))
    facing = np.cross(right - corner, up - corner)
    axis = np.abs(facing).argmax(axis=1)
    faces = 2 * axis + (np.take_along_axis(facing, axis[:, None], axis=1)[:, 0] > 0)
    sides.cell_data["colour"] = np.rint(colours * (np.array(pane.faces)[faces, None] / 255)).astype(np.uint8)
    return sides


def _legend(pane: Pane, grid: pyvista.UnstructuredGrid, levels: tuple[int, int]) -> list[Entry]:
    """Give what the colours of octants mean."""
    if pane.by == "level":
        colours = _level_colours(levels)
        entries = [(str(1 << level), colours[level - levels[0]].tolist()) for level in range(levels[0], levels[1] + 1)]
        return [("voxels per side", None), *entries]
    if pane.by == "owner":
        assert pane.owners is not None
        owner = np.asarray(grid.cell_data["owner"])
        names, wheel = (*pane.owners.names, "several objects"), _owner_colours(pane.owners)
        present = np.unique(owner[owner != SEVERAL]).tolist() + [SEVERAL] * bool((owner == SEVERAL).any())
        return [(names[number], wheel[number].tolist()) for number in present]
    return []


def _level_colours(levels: tuple[int, int]) -> NDArray[np.uint8]:
    """Give the colour of each level from the lowest to the highest: uint8, shape (N, 3), sRGB."""
    pv = import_pyvista()
    count = levels[1] - levels[0] + 1
    wheel = pv.LookupTable("viridis_r", n_values=count).values
    return np.asarray(wheel, np.uint8)[:, :3]


def _owner_colours(owners: Owners) -> NDArray[np.uint8]:
    """Give each owner's colour, and last that of :data:`SEVERAL`, which is -1: uint8, shape (N + 1, 3), sRGB."""
    hues = np.arange(len(owners.names), dtype=np.float64) * _GOLDEN_TURN % 1
    wheel = np.clip(np.abs((hues[:, None] + np.array([0, 2 / 3, 1 / 3])) % 1 * 6 - 3) - 1, 0, 1)
    return np.vstack([np.rint(255 * (0.3 + 0.65 * wheel)), (150, 150, 150)]).astype(np.uint8)
