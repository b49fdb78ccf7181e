"""Panes and rays drawn by PyVista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.octree.owners import SEVERAL
from voxrt.view.cells import import_pyvista, open_sides
from voxrt.view.plotter import TEXT, check_screen, light_up, place_eye

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista
    from numpy.typing import NDArray

    from voxrt.octree.owners import Owners
    from voxrt.view.pane import DrawnRay, Pane, Preview

_PREVIEW_WIDTH, _PREVIEW_HEIGHT = 0.42, 0.4  # of a preview, as parts of the picture's
_COLUMN, _LINE = 0.61, 1.1  # of the table, as parts of the letters' size
_LEGEND_LIMIT = 16
_GOLDEN_TURN = 0.6180339887498949  # sets the hues of neighbours far apart
_MESH = (255, 214, 90)
_BEFORE = -66000  # to the very front, in steps of the depth buffer
_GHOST = 0.15  # how much of the octants is seen where a ray is shown


def draw(
    panes: Sequence[Pane],
    size: tuple[int, int],
    *,
    preview: Preview | None = None,
    off_screen: bool,
) -> tuple[pyvista.Plotter, list[pyvista.UnstructuredGrid]]:
    """Draw panes side by side, seen alike; or one, a preview beside it and the ray of the preview's pixel.

    Parameters
    ----------
    panes
        One or more; with a preview one.
    size
        Width and height of all together, pixels.
    preview
        Where the ray that is shown comes from.
    off_screen
        Draw for a picture and not in a window.

    Returns
    -------
    tuple
        The plotter, and the cells of each pane. The panes are the plotter's last subplots.

    Raises
    ------
    ViewerError
        PyVista is missing, or there is nothing to draw on.
    """
    check_screen(off_screen=off_screen)
    pv = import_pyvista()
    layout: dict[str, Any] = {"shape": (1, len(panes))}
    if preview is not None:
        layout = {
            "shape": (2, 2),
            "groups": [(slice(None), 1)],
            "col_weights": [_PREVIEW_WIDTH, 1 - _PREVIEW_WIDTH],
            "row_weights": [_PREVIEW_HEIGHT, 1 - _PREVIEW_HEIGHT],
        }
    plotter = pv.Plotter(off_screen=off_screen, window_size=size, lighting="none", border=False, **layout)
    grids = [pane.grid() for pane in panes]
    for number, (pane, grid) in enumerate(zip(panes, grids, strict=True)):
        enter(plotter, number, preview is not None)
        plotter.set_background(pane.rom.materials[0].colour, all_renderers=False)
        light_up(plotter)
        draw_octants(plotter, number, pane, grid, level_range(grids), ghost=preview is not None)
        if pane.triangles is not None:
            _draw_triangles(plotter, pane.triangles)
        if grid.n_cells:
            place_eye(plotter, np.asarray(grid.points, np.float64))
    if preview is not None:
        _draw_preview(plotter, preview.colour)
        plotter.subplot(1, 0)
        plotter.set_background((0, 0, 0), all_renderers=False)
        draw_ray(plotter, panes[0], preview, preview.pixel)
        _turn_to_ray(plotter, preview.follow(preview.pixel))
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

    `levels` are those that colours tell apart; a ghost lets the ray be seen through it.
    """
    add_octants(plotter, f"octants {number}", pane, grid, levels, ghost=ghost)
    if grid.n_cells and pane.by == "owner":
        _name_owners(plotter, pane, grid)
    told = f"{pane.rom.name}: {grid.n_cells:,} octants shown, {int(grid.field_data['hidden'][0]):,} hidden"
    plotter.add_text(told, position="upper_left", font_size=10, color=TEXT, name=f"told {number}")


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
        "ambient": 0.25,
        "culling": "back",
        "reset_camera": False,
        "opacity": _GHOST if ghost else 1.0,
    }
    plotter.remove_actor(name)
    if not grid.n_cells:
        return None
    sides = _sides(pane, grid)
    if pane.by == "level":
        return _colour_levels(plotter, sides, levels, look)
    return plotter.add_mesh(sides, scalars="colour", rgb=True, **look)


def draw_ray(plotter: pyvista.Plotter, pane: Pane, preview: Preview, pixel: tuple[int, int]) -> None:
    """Mark a pixel in the preview, list what its ray reads below, and draw the ray in the pane."""
    pv = import_pyvista()
    ray = preview.follow(pixel)
    height = preview.colour.shape[0]
    column, row = pixel
    x, y, reach = column + 0.5, height - row - 0.5, max(preview.colour.shape) / 25
    arms = [
        (x + a * reach * dx, y + a * reach * dy, 0.1) for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)) for a in (0.3, 1)
    ]
    plotter.subplot(0, 0)
    plotter.add_mesh(
        pv.line_segments_from_points(np.array(arms, float)),
        color="red", line_width=3, lighting=False, name="mark", reset_camera=False,
    )  # fmt: skip
    plotter.subplot(1, 0)
    draw_table(plotter, ray.table)
    enter(plotter, 0, True)
    leaf = ray.words >> 31 == 1
    solid = leaf & (ray.words & 0xFF != 0)
    for name, some, style in (
        ("pointers", ~leaf, {"color": "white", "line_width": 1, "opacity": 0.35}),
        ("spaces", leaf & ~solid, {"color": (120, 190, 255), "line_width": 2}),
        ("hit edges", solid, {"color": "white", "line_width": 4}),
    ):
        plotter.remove_actor(name)
        if some.any():
            boxes = _boxes(ray, some)
            plotter.add_mesh(boxes, style="wireframe", lighting=False, name=name, reset_camera=False, **style)
    plotter.remove_actor("hit")
    if solid.any():
        colour = pane.rom.materials[int(ray.words[solid][0]) & 0xFF].colour
        plotter.add_mesh(_boxes(ray, solid), color=colour, name="hit", ambient=0.5, reset_camera=False)
    line = pv.Line(ray.start, ray.end)
    plotter.add_mesh(line, color="red", line_width=4, lighting=False, name="ray", reset_camera=False)
    plotter.remove_actor("stands")
    if len(ray.points):
        plotter.add_mesh(
            pv.PolyData(ray.points.astype(np.float32)),
            color="red", point_size=9, render_points_as_spheres=True, lighting=False, name="stands", reset_camera=False,
        )  # fmt: skip


def draw_table(plotter: pyvista.Plotter, table: tuple[str, ...]) -> None:
    """Write lines of one width below the preview, as large as they fit, and no more of them than do."""
    pv = import_pyvista()
    width, height = _PREVIEW_WIDTH * plotter.window_size[0], (1 - _PREVIEW_HEIGHT) * plotter.window_size[1]
    size = max(7, min(15, int(0.97 * width / (_COLUMN * max(map(len, table))))))
    fitting = int(height / (_LINE * size)) - 1
    lines = table if len(table) <= fitting else (*table[: fitting - 2], "... voxrt trace tells the rest", table[-1])
    text = pv.Text("\n".join(lines))
    letters = text.GetTextProperty()
    letters.SetFontFamilyToCourier()
    letters.SetFontSize(size)
    letters.SetColor(*(channel / 255 for channel in TEXT))
    letters.SetVerticalJustificationToTop()
    text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    text.position = (0.02, 0.98)
    plotter.subplot(1, 0)
    plotter.add_actor(text, name="table", reset_camera=False)


def _turn_to_ray(plotter: pyvista.Plotter, ray: DrawnRay) -> None:
    """Look at a ray and what it went through from the side, and from above."""
    along = np.array(ray.end) - ray.start
    aside = np.cross(along, (0, 1, 0))
    aside = aside / np.linalg.norm(aside) if aside.any() else np.array((1.0, 0, 0))
    aside *= 1 if aside[2] >= 0 else -1
    leaf = ray.words >> 31 == 1
    ends = ray.corners[leaf] + (1 << ray.levels[leaf])[:, None]
    x, y, z = np.add(aside, (0, 0.35, 0)).tolist()
    enter(plotter, 0, True)
    place_eye(plotter, np.concatenate([[ray.start, ray.end], ray.corners[leaf], ends]), (x, y, z))


def _boxes(ray: DrawnRay, some: NDArray[np.bool_]) -> pyvista.PolyData:
    pv = import_pyvista()
    boxes = [
        pv.Box(np.stack([corner, corner + (1 << int(level))], axis=1).astype(float).ravel())
        for corner, level in zip(ray.corners[some], ray.levels[some], strict=True)
    ]
    return pv.merge(boxes) if len(boxes) > 1 else boxes[0]


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


def _draw_preview(plotter: pyvista.Plotter, colour: NDArray[np.uint8]) -> None:
    pv = import_pyvista()
    height, width = colour.shape[:2]
    plotter.subplot(0, 0)
    plotter.set_background((0, 0, 0), all_renderers=False)
    screen = pv.Plane(center=(width / 2, height / 2, 0), i_size=width, j_size=height, i_resolution=1, j_resolution=1)
    plotter.add_mesh(screen, texture=pv.Texture(np.ascontiguousarray(colour)), lighting=False, name="preview")
    plotter.view_xy()
    plotter.enable_parallel_projection()
    plotter.camera.tight(padding=0.02, adjust_render_window=False)
    plotter.camera.clipping_range = (0.1, 10 * (width + height))
    plotter.renderer.SetInteractive(0)  # clicks choose a pixel and turn nothing


def _colour_levels(
    plotter: pyvista.Plotter, sides: pyvista.PolyData, levels: tuple[int, int], look: dict[str, Any]
) -> pyvista.Actor:
    low, high = levels
    return plotter.add_mesh(
        sides,
        scalars="level",
        cmap="viridis_r",
        clim=(low - 0.5, high + 0.5),
        n_colors=high - low + 1,
        annotations={float(level): f"{1 << level}" for level in range(low, high + 1)},
        scalar_bar_args={
            "title": "voxels per side",
            "n_labels": 0,
            "color": TEXT,
            "vertical": True,
            "position_x": 0.86,
            "position_y": 0.72,
            "width": 0.06,
            "height": 0.26,
        },
        **look,
    )


def _sides(pane: Pane, grid: pyvista.UnstructuredGrid) -> pyvista.PolyData:
    """Give the sides of octants that can be seen, with the data that colours them."""
    pv = import_pyvista()
    quads, cells = open_sides(grid)
    sides = pv.PolyData(np.asarray(grid.points), np.insert(quads, 0, 4, axis=1).ravel())
    sides.cell_data["level"] = np.asarray(grid.cell_data["level"])[cells]
    if pane.by == "owner":
        assert pane.owners is not None
        sides.cell_data["colour"] = _owner_colours(pane.owners)[np.asarray(grid.cell_data["owner"])[cells]]
    else:
        sides.cell_data["colour"] = np.asarray(grid.cell_data["colour"])[cells]
    return sides


def _name_owners(plotter: pyvista.Plotter, pane: Pane, grid: pyvista.UnstructuredGrid) -> None:
    assert pane.owners is not None
    owner = np.asarray(grid.cell_data["owner"])
    names, colours = (*pane.owners.names, "several objects"), _owner_colours(pane.owners)
    present = np.unique(owner[owner != SEVERAL]).tolist() + [SEVERAL] * bool((owner == SEVERAL).any())
    entries = [[names[number], colours[number].tolist()] for number in present[:_LEGEND_LIMIT]]
    legend = plotter.add_legend(entries, background_opacity=0.9, bcolor=pane.rom.materials[0].colour, face="rectangle")
    height = min(0.9, 0.022 * len(entries))
    legend.SetPosition(0.83, 0.97 - height)
    legend.SetPosition2(0.16, height)


def _owner_colours(owners: Owners) -> NDArray[np.uint8]:
    """Give each owner's colour, and last that of :data:`SEVERAL`, which is -1: uint8, shape (N + 1, 3), sRGB."""
    hues = np.arange(len(owners.names), dtype=np.float64) * _GOLDEN_TURN % 1
    wheel = np.clip(np.abs((hues[:, None] + np.array([0, 2 / 3, 1 / 3])) % 1 * 6 - 3) - 1, 0, 1)
    return np.vstack([np.rint(255 * (0.3 + 0.65 * wheel)), (150, 150, 150)]).astype(np.uint8)
