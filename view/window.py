"""The window: octants to turn, pick, cut and coarsen, and a preview to choose rays in."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.octant import octant_at
from voxrt.view.cells import import_pyvista
from voxrt.view.drawing import add_octants, draw, draw_octants, enter, level_range
from voxrt.view.plotter import TEXT
from voxrt.view.ray_drawing import draw_ray

if TYPE_CHECKING:
    from collections.abc import Sequence

    import pyvista
    from numpy.typing import NDArray

    from voxrt.view.pane import Pane, Plane, Preview

_MANY = 100_000  # octants: more are slow to draw without a graphics card
_PATIENCE = 0.1  # seconds that a picture may take while the octants are turned
_BEHIND = 0.02  # voxels: from where a side is seen to what is behind it
_HELP = "click: octant   slider: smallest octant   c: cut   w/s: edges   q: quit"


class Window:
    """Panes in a window.

    A click on an octant shows what it is. A slider makes octants uniform up to a size. The key ``c`` adds a plane that
    cuts octants away, and removes it again. A click in the preview shows the ray of that pixel.

    Parameters
    ----------
    panes, size, preview
        As :func:`voxrt.view.drawing.draw` takes them.
    off_screen
        Draw without a screen; the methods take the place of mouse and keys.

    Raises
    ------
    ViewerError
        PyVista is not installed, or there is no screen.

    Examples
    --------
    >>> import voxrt
    >>> from voxrt.view import Pane
    >>> window = Window([Pane(voxrt.build("examples/house.obj", depth=4).rom)], (64, 48), off_screen=True)
    >>> window.set_level(2)
    >>> window.plotter.close()
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
        self._light: list[tuple[pyvista.Actor, pyvista.Actor]] = []  # octants and what stands in for them
        self._slow = False
        self._begun: float | None = None
        self._lighten()
        self.plotter.render_window.AddObserver("StartEvent", self._begin_picture)
        self.plotter.render_window.AddObserver("EndEvent", self._end_picture)
        depth = max(pane.rom.octree.depth for pane in panes)
        plotter = self.plotter
        enter(plotter, 0, preview is not None)
        plotter.add_slider_widget(
            self.set_level,
            (0, depth),
            value=0,
            title="smallest octant: 2^n voxels per side",
            pointa=(0.6, 0.12),
            pointb=(0.95, 0.12),
            style="modern",
            fmt="%.0f",
            color=TEXT,
            title_height=0.02,
            tube_width=0.004,
            slider_width=0.012,
        )
        plotter.add_text(_HELP, position="lower_right", font_size=7, color=TEXT, name="help")
        plotter.add_key_event("c", self.toggle_plane)
        plotter.iren.add_observer("LeftButtonPressEvent", lambda *_: self.click(*plotter.iren.get_event_position()))

    def show(self) -> None:
        """Wait until the window is closed."""
        self.plotter.show()

    def set_level(self, level: float) -> None:
        """Make octants of 2**level voxels per side uniform."""
        shown = [pane.coarsened(round(level)) for pane in self._panes]
        if [pane.rom.octree for pane in shown] != [pane.rom.octree for pane in self._shown]:
            self._shown, self._solids = shown, [pane.solid() for pane in shown]
            self._redraw()

    def set_plane(self, normal: tuple[float, float, float], point: tuple[float, float, float]) -> None:
        """Cut away the octants whose centres lie on the normal's side of a plane through a point."""
        self._plane = (normal, point)
        self._redraw()

    def toggle_plane(self) -> None:
        """Add the plane that cuts, or remove it and show all octants again."""
        if self._plane is None:
            grid = self.grids[0]
            self.plotter.add_plane_widget(
                self.set_plane, normal="x", origin=grid.center, bounds=grid.bounds, interaction_event="end"
            )
        else:
            self.plotter.clear_plane_widgets()
            self._plane = None
            self._redraw()

    def click(self, x: int, y: int) -> None:
        """Describe the octant, or show the ray of the preview's pixel, at a place (pixels from the lower left)."""
        if self._preview is not None and self.plotter.renderers[0].IsInViewport(x, y):
            self._choose(self._preview, x, y)
        for number in range(len(self._shown)):
            enter(self.plotter, number, self._preview is not None)
            renderer = self.plotter.renderer
            if renderer.IsInViewport(x, y) and (point := _seen_point(renderer, x, y)) is not None:
                self.pick(number, point + _BEHIND * np.array(self.plotter.camera.direction))

    def pick(self, number: int, point: NDArray[np.float64]) -> None:
        """Describe and mark the octant that holds a point (float64, shape (3,), voxels) of a pane."""
        pane = self._shown[number]
        if point.min() < 0 or point.max() >= pane.rom.octree.size:
            return
        x, y, z = np.floor(point).astype(np.int64).tolist()
        enter(self.plotter, number, self._preview is not None)
        self.plotter.add_text(
            pane.describe((x, y, z)), position="lower_left", font_size=9, color=TEXT, name=f"picked {number}"
        )
        octant = octant_at(pane.rom.octree, (x, y, z))
        box = import_pyvista().Box(np.stack([octant.corner, octant.end], axis=1).ravel().tolist())
        self.plotter.add_mesh(
            box,
            color="white",
            style="wireframe",
            line_width=4,
            lighting=False,
            name=f"mark {number}",
            reset_camera=False,
            pickable=False,
        )
        self.plotter.render()

    def _choose(self, preview: Preview, x: int, y: int) -> None:
        height, width = preview.colour.shape[:2]
        place = _world_point(self.plotter.renderers[0], x, y, 0)
        column, up, _ = np.floor(place).astype(np.int64).tolist()
        if 0 <= column < width and 0 <= up < height:
            draw_ray(self.plotter, self._shown[0], preview, (column, height - 1 - up))
            self.plotter.render()

    def _redraw(self) -> None:
        self.grids = [pane.grid(solid, self._plane) for pane, solid in zip(self._shown, self._solids, strict=True)]
        for number, (pane, grid) in enumerate(zip(self._shown, self.grids, strict=True)):
            enter(self.plotter, number, self._preview is not None)
            draw_octants(self.plotter, number, pane, grid, level_range(self.grids), ghost=self._preview is not None)
        self._lighten()
        self.plotter.render()

    def _lighten(self) -> None:
        """Make coarser octants that are shown while many octants are turned, if the machine is too slow for all."""
        self._light = []
        for number, (pane, grid) in enumerate(zip(self._shown, self.grids, strict=True)):
            enter(self.plotter, number, self._preview is not None)
            self.plotter.remove_actor(f"light {number}")
            if grid.n_cells <= _MANY:
                continue
            coarse, light, level = pane, grid, 1
            while light.n_cells > _MANY:
                coarse = pane.coarsened(level)
                light, level = coarse.grid(plane=self._plane), level + 1
            actor = add_octants(self.plotter, f"light {number}", coarse, light, level_range(self.grids))
            if actor is not None:
                self._light.append((self.plotter.renderer.actors[f"octants {number}"], actor))

    def _begin_picture(self, *_event: object) -> None:
        """Choose what to draw: coarser octants while VTK wants several pictures per second, as when something turns."""
        turned = self._slow and self.plotter.render_window.GetDesiredUpdateRate() > 1
        for full, light in self._light:
            full.SetVisibility(not turned)
            light.SetVisibility(turned)
        self._begun = None if turned else perf_counter()

    def _end_picture(self, *_event: object) -> None:
        if self._begun is not None:
            self._slow = perf_counter() - self._begun > _PATIENCE


def _seen_point(renderer: pyvista.Renderer, x: int, y: int) -> NDArray[np.float64] | None:
    """Return what is seen at a place; computed, for not every driver tells the depth of a pixel."""
    from vtkmodules.vtkRenderingCore import vtkCellPicker  # noqa: PLC0415 - optional

    picker = vtkCellPicker()
    picker.SetTolerance(0)
    return np.array(picker.GetPickPosition()) if picker.Pick(x, y, 0, renderer) else None


def _world_point(renderer: pyvista.Renderer, x: int, y: int, depth: float) -> NDArray[np.float64]:
    renderer.SetDisplayPoint(x, y, depth)
    renderer.DisplayToWorld()
    place = np.array(renderer.GetWorldPoint())
    point: NDArray[np.float64] = place[:3] / place[3]
    return point
