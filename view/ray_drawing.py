"""A ray drawn by PyVista: its pixel, the table of its words, and the octants that it goes through."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.words import is_leaf, material
from voxrt.view.cells import import_pyvista
from voxrt.view.legend import LINE, draw_legend
from voxrt.view.plotter import TEXT, place_eye, place_eye_around

if TYPE_CHECKING:
    import pyvista
    from numpy.typing import NDArray

    from voxrt.view.pane import DrawnRay, Pane, Preview

PREVIEW_WIDTH, PREVIEW_HEIGHT = 0.42, 0.4
"""The size of a preview, as parts of the picture's."""

_COLUMN, _LINE = 0.61, 1.1  # of the table, as parts of the letters' size
_SMALLEST, _READABLE, _LARGEST = 7, 9, 15  # letters of the table; smaller ones than the readable only for wide tables
_POINTER, _SPACE, _RAY = (255, 255, 255), (120, 190, 255), (255, 60, 60)


def draw_preview(plotter: pyvista.Plotter, colour: NDArray[np.uint8]) -> None:
    """Draw a preview at the upper left."""
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
    plotter.subplot(1, 0)
    plotter.set_background((0, 0, 0), all_renderers=False)


def draw_ray(plotter: pyvista.Plotter, pane: Pane, preview: Preview, pixel: tuple[int, int]) -> None:
    """Mark a pixel in the preview, list what its ray reads below, and draw the ray in the pane."""
    pv = import_pyvista()
    ray = preview.follow(pixel)
    _mark(plotter, preview, pixel)
    leaf = is_leaf(ray.words)
    solid = leaf & (material(ray.words) != 0)
    hit = pane.rom.materials[material(int(ray.words[solid][0]))] if solid.any() else None
    plotter.subplot(1, 0)
    entries = [("words that are pointers", _POINTER), ("words that are empty leaves", _SPACE), ("the ray", _RAY)]
    if hit is not None:
        entries.append((f"the hit: {hit.name}", hit.colour))
    legend_height = (len(entries) + 0.5) * LINE / ((1 - PREVIEW_HEIGHT) * plotter.window_size[1])
    draw_legend(plotter, "ray legend", entries, left=0.02, top=legend_height, bottom=0)
    draw_table(plotter, ray.table, legend_height)
    plotter.subplot(0, 1)
    for name, some, style in (
        ("pointers", ~leaf, {"color": _POINTER, "line_width": 1, "opacity": 0.35}),
        ("spaces", leaf & ~solid, {"color": _SPACE, "line_width": 2}),
        ("hit edges", solid, {"color": "white", "line_width": 4}),
    ):
        plotter.remove_actor(name)
        if some.any():
            boxes = _boxes(ray, some)
            plotter.add_mesh(boxes, style="wireframe", lighting=False, name=name, reset_camera=False, **style)
    plotter.remove_actor("hit")
    if hit is not None:
        plotter.add_mesh(_boxes(ray, solid), color=hit.colour, lighting=False, name="hit", reset_camera=False)
    line = pv.Line(ray.start, ray.end)
    plotter.add_mesh(line, color=_RAY, line_width=4, lighting=False, name="ray", reset_camera=False)
    plotter.remove_actor("stands")
    if len(ray.points):
        plotter.add_mesh(
            pv.PolyData(ray.points.astype(np.float32)),
            color=_RAY, point_size=9, render_points_as_spheres=True, lighting=False, name="stands", reset_camera=False,
        )  # fmt: skip
    _turn_to_ray(plotter, ray)


def draw_table(plotter: pyvista.Plotter, table: tuple[str, ...], kept: float) -> None:
    """Write lines of one width below the preview, as large as they fit.

    Lines in the middle are left out where there are too many: the first and the last words of a ray stay. `kept` is the
    part of the height that is kept free below.
    """
    pv = import_pyvista()
    width = 0.96 * PREVIEW_WIDTH * plotter.window_size[0]
    height = (0.98 - kept) * (1 - PREVIEW_HEIGHT) * plotter.window_size[1]
    wide, high = int(width / (_COLUMN * max(map(len, table)))), int(height / (_LINE * len(table)))
    size = max(_SMALLEST, min(_LARGEST, wide, max(_READABLE, high)))
    columns, fitting = int(width / (_COLUMN * size)), max(3, int(height / (_LINE * size)))
    lines = list(table)
    if len(lines) > fitting:
        last = max(1, fitting // 3)
        lines = [*lines[: fitting - last - 1], "... (voxrt trace lists all words)", *lines[-last:]]
    text = pv.Text("\n".join(line if len(line) <= columns else f"{line[: columns - 2]}.." for line in lines))
    letters = text.GetTextProperty()
    letters.SetFontFamilyToCourier()
    letters.SetFontSize(size)
    letters.SetColor(*(channel / 255 for channel in TEXT))
    letters.SetVerticalJustificationToTop()
    text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    text.position = (0.02, 0.98)
    plotter.subplot(1, 0)
    plotter.add_actor(text, name="table", reset_camera=False)


def _mark(plotter: pyvista.Plotter, preview: Preview, pixel: tuple[int, int]) -> None:
    """Mark a pixel of the preview by a cross that is open in the middle."""
    height, (column, row) = preview.colour.shape[0], pixel
    x, y, reach = column + 0.5, height - row - 0.5, max(preview.colour.shape) / 25
    arms = [
        (x + a * reach * dx, y + a * reach * dy, 0.1) for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)) for a in (0.3, 1)
    ]
    plotter.subplot(0, 0)
    plotter.add_mesh(
        import_pyvista().line_segments_from_points(np.array(arms, float)),
        color=_RAY, line_width=3, lighting=False, name="mark", reset_camera=False,
    )  # fmt: skip


def _turn_to_ray(plotter: pyvista.Plotter, ray: DrawnRay) -> None:
    """Look from the side, and from above, at what a ray went through; its hit is in the middle."""
    along = np.array(ray.end) - ray.start
    aside = np.cross(along, (0, 1, 0))
    aside = aside / np.linalg.norm(aside) if aside.any() else np.array((1.0, 0, 0))
    aside *= 1 if aside[2] >= 0 else -1
    leaf = is_leaf(ray.words)
    ends = ray.corners + (1 << ray.levels)[:, None]
    x, y, z = np.add(aside, (0, 0.35, 0)).tolist()
    if leaf.any() and material(int(ray.words[-1])):
        middle = (ray.corners[-1] + ends[-1]) / 2
        place_eye_around(plotter, middle, np.concatenate([ray.corners[leaf], ends[leaf]]), (x, y, z))
    else:
        place_eye(plotter, np.concatenate([[ray.start, ray.end], ray.corners[leaf], ends[leaf]]), (x, y, z))


def _boxes(ray: DrawnRay, some: NDArray[np.bool_]) -> pyvista.PolyData:
    pv = import_pyvista()
    boxes = [
        pv.Box(np.stack([corner, corner + (1 << int(level))], axis=1).astype(float).ravel())
        for corner, level in zip(ray.corners[some], ray.levels[some], strict=True)
    ]
    return pv.merge(boxes) if len(boxes) > 1 else boxes[0]
