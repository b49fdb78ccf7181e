"""The window: octants to turn, to pick, to cut and to coarsen; a preview to choose rays in."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.draw import draw, draw_octants, draw_ray, enter, level_range
from voxrt.octree.stage import TEXT

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista

    from voxrt.octree.pane import Pane, Plane, Preview

_HELP = "click: octant   slider: smallest octant   c: cut   w/s: edges   q: quit"


class Window:
    """Panes in a window.

    A click on an octant tells about it; a slider makes octants uniform up to a size; the key ``c`` brings a plane that
    cuts octants away, and takes it off again; a click in the preview shows that pixel's ray.

    Parameters
    ----------
    panes, size, preview
        As :func:`voxrt.octree.draw.draw` takes them.
    off_screen
        Without a screen, to be worked by the methods.

    Raises
    ------
    ViewerError
        PyVista is missing, or there is no screen.
    """

    def __init__(
        self,
        panes: Sequence[Pane],
        size: tuple[int, int] = (1024, 768),
        *,
        preview: Preview | None = None,
        off_screen: bool = False,
    ) -> None:
        self.plotter, self.grids = draw(panes, size, preview=preview, off_screen=off_screen)
        self._panes = list(panes)
        self._shown = list(panes)  # coarsened
        self._solids = [pane.solid() for pane in panes]
        self._preview = preview
        self._plane: Plane | None = None
        depth = max(pane.rom.octree.depth for pane in panes)
        plotter = self.plotter
        enter(plotter, 0, preview is not None)
        plotter.add_slider_widget(
            self.set_level,
            (0, depth),
            value=0,
            title="smallest octant: 2^n voxels a side",
            pointa=(0.05, 0.1),
            pointb=(0.4, 0.1),
            style="modern",
            fmt="%.0f",
            color=TEXT,
            title_height=0.02,
        )
        plotter.add_text(_HELP, position="lower_right", font_size=7, color=TEXT, name="help")
        plotter.add_key_event("c", self.toggle_plane)
        if preview is None:
            plotter.enable_element_picking(
                self.pick, left_clicking=True, show_message=False, color=TEXT, line_width=3, picker="hardware"
            )
        else:
            plotter.iren.add_observer("LeftButtonPressEvent", lambda *_: self.click(*plotter.iren.get_event_position()))

    def show(self) -> None:
        """Wait until the window is closed."""
        self.plotter.show()

    def set_level(self, level: float) -> None:
        """Make octants of 2**level voxels a side uniform."""
        shown = [pane.coarsened(round(level)) for pane in self._panes]
        if [pane.rom.octree for pane in shown] != [pane.rom.octree for pane in self._shown]:
            self._shown, self._solids = shown, [pane.solid() for pane in shown]
            self._redraw()

    def set_plane(self, normal: tuple[float, float, float], point: tuple[float, float, float]) -> None:
        """Cut away the octants whose middles lie on the normal's side of a plane through a point."""
        self._plane = (normal, point)
        self._redraw()

    def toggle_plane(self) -> None:
        """Bring the plane that cuts, or take it off and show all octants again."""
        if self._plane is None:
            grid = self.grids[0]
            self.plotter.add_plane_widget(
                self.set_plane, normal="x", origin=grid.center, bounds=grid.bounds, interaction_event="end"
            )
        else:
            self.plotter.clear_plane_widgets()
            self._plane = None
            self._redraw()

    def pick(self, cell: pyvista.UnstructuredGrid) -> None:
        """Tell about an octant, given as its cell."""
        x, y, z = np.floor(cell.center).astype(np.int64).tolist()
        for number, pane in enumerate(self._shown):
            enter(self.plotter, number, self._preview is not None)
            if max(x, y, z) < pane.rom.octree.size:
                text = pane.describe((x, y, z))
                self.plotter.add_text(text, position="left_edge", font_size=9, color=TEXT, name="picked")

    def click(self, x: int, y: int) -> None:
        """Show the ray of the preview's pixel that stands at a place in the window (pixels from its lower left)."""
        if self._preview is None:
            return
        renderer = self.plotter.renderers[0]
        if not renderer.IsInViewport(x, y):
            return
        renderer.SetDisplayPoint(x, y, 0)
        renderer.DisplayToWorld()
        height, width = self._preview.colour.shape[:2]
        column, up = np.floor(np.array(renderer.GetWorldPoint()[:2])).astype(np.int64).tolist()
        if 0 <= column < width and 0 <= up < height:
            draw_ray(self.plotter, self._shown[0], self._preview, (column, height - 1 - up))
            self.plotter.render()

    def _redraw(self) -> None:
        self.grids = [pane.grid(solid, self._plane) for pane, solid in zip(self._shown, self._solids, strict=True)]
        for number, (pane, grid) in enumerate(zip(self._shown, self.grids, strict=True)):
            enter(self.plotter, number, self._preview is not None)
            draw_octants(self.plotter, number, pane, grid, level_range(self.grids), ghost=self._preview is not None)
        self.plotter.render()
