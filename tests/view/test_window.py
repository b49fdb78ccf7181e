"""The window, worked without a screen: what its widgets and clicks call."""

from __future__ import annotations

import numpy as np
import pytest

from voxrt import octree, view
from voxrt.octree.camera import FACES, look_at
from voxrt.view.scene_overlay import preview_of
from voxrt.voxelize import EMPTY, Material

SIZE = (320, 240)


pytestmark = pytest.mark.usefixtures("_canvas")


@pytest.fixture
def rom():
    cube = np.zeros((16, 16, 16), np.uint8)
    cube[:, :6] = 1
    cube[3:9, 6:11, 2:7] = 2
    return octree.Rom(
        "world", octree.from_dense(cube), (EMPTY, Material("red", (220, 40, 40)), Material("green", (40, 200, 60)))
    )


@pytest.fixture
def opened():
    windows = []

    def open_window(*arguments, **options):
        windows.append(view.Window(*arguments, off_screen=True, **options))
        windows[-1].plotter.show(auto_close=False)
        return windows[-1]

    yield open_window
    for window in windows:
        window.plotter.close()


def widgets(window):
    return getattr(window.plotter, "widgets", window.plotter)  # where they are since PyVista 0.48


def texts(window):
    """What stands written in the window, by name."""
    found = {}
    for renderer in window.plotter.renderers:
        for name, actor in renderer.actors.items():
            if hasattr(actor, "GetInput") and isinstance(actor.GetInput(), str):
                found[name] = actor.GetInput()
            elif hasattr(actor, "GetText"):
                found[name] = "".join(actor.GetText(corner) or "" for corner in range(8))
    return found


def test_the_slider_makes_octants_uniform(rom, opened):
    window = opened([view.Pane(rom)], SIZE)
    (slider,) = widgets(window).slider_widgets
    fine = window.grids[0].n_cells
    slider.GetRepresentation().SetValue(2)
    slider.InvokeEvent("InteractionEvent")
    slider.InvokeEvent("EndInteractionEvent")
    coarse = view.octants(view.Pane(rom).coarsened(2).rom)
    assert window.grids[0] == coarse
    assert coarse.n_cells < fine
    assert f"world: {coarse.n_cells} octants shown" in texts(window)["told 0"]
    window.set_level(0)
    assert window.grids[0].n_cells == fine


def test_the_plane_cuts_octants_away_and_closes_the_cut(rom, opened):
    window = opened([view.Pane(rom)], SIZE)
    whole = window.grids[0]
    window.toggle_plane()
    (plane,) = widgets(window).plane_widgets
    plane.SetNormal(1, 0, 0)
    plane.SetOrigin(8.0, 8.0, 8.0)
    plane.InvokeEvent("EndInteractionEvent")
    left = window.grids[0]
    centres = left.cell_centers().points
    assert len(centres)
    assert centres[:, 0].max() <= 8
    inner = {tuple(centre) for centre in centres.tolist()} - {tuple(c) for c in whole.cell_centers().points.tolist()}
    assert inner or left.n_cells < whole.n_cells
    window.toggle_plane()
    assert not widgets(window).plane_widgets
    assert window.grids[0] == whole


def test_a_click_tells_about_the_octant_under_it(rom, opened):
    window = opened([view.Pane(rom)], SIZE)
    renderer = window.plotter.renderer
    point = np.array([5.5, 11.0, 4.5])  # on the box's top
    renderer.SetWorldPoint(*point, 1)
    renderer.WorldToDisplay()
    x, y, _ = renderer.GetDisplayPoint()
    window.plotter.iren._mouse_left_button_click(round(x), round(y))
    assert texts(window)["picked 0"] == view.Pane(rom).describe((5, 10, 4))
    window.plotter.iren._mouse_left_button_click(2, 200)  # the background
    assert texts(window)["picked 0"] == view.Pane(rom).describe((5, 10, 4))


def test_panes_are_worked_together(rom, opened):
    window = opened([view.Pane(rom), view.Pane(rom, by="level")], SIZE)
    window.set_level(3)
    assert window.grids[0].n_cells == window.grids[1].n_cells
    cameras = [renderer.camera.position for renderer in window.plotter.renderers]
    assert cameras[0] == cameras[1]
    window.plotter.renderers[0].camera.Azimuth(30)
    assert window.plotter.renderers[1].camera.position == window.plotter.renderers[0].camera.position != cameras[0]


def test_many_octants_have_a_stand_in_while_they_are_turned(rom, opened, monkeypatch):
    monkeypatch.setattr("voxrt.view.window._MANY", 20)
    monkeypatch.setattr("voxrt.view.window._PATIENCE", 0.0)
    window = opened([view.Pane(rom)], SIZE)
    full, light = (window.plotter.renderer.actors[f"{name} 0"] for name in ("octants", "light"))
    assert light.mapper.GetInput().GetNumberOfCells() < full.mapper.GetInput().GetNumberOfCells()
    for rate, seen in ((15, light), (0.001, full)):  # as the interactor sets it while something is turned, and after
        window.plotter.render_window.SetDesiredUpdateRate(rate)
        window.plotter.render()
        assert [actor.GetVisibility() for actor in (full, light)] == [seen is full, seen is light]
    window.set_level(3)
    assert "light 0" not in window.plotter.renderer.actors


def test_a_click_in_the_preview_chooses_the_ray(rom, opened):
    pixels = []

    def follow(pixel):
        pixels.append(pixel)
        return view.DrawnRay(
            (-4.0, 8.0, 8.0), (3.0, 8.0, 8.0), np.array([[0, 0, 0], [3, 8, 4]]), np.array([3, 0]),
            np.array([9, 0xFFFFFF02], np.uint32), np.array([[0.0, 8, 8], [3, 8, 8]]), (f"pixel {pixel}",),
        )  # fmt: skip

    colour = np.zeros((30, 40, 3), np.uint8)
    window = opened([view.Pane(rom)], SIZE, preview=view.Preview(colour, (1, 2), follow))
    assert set(pixels) == {(1, 2)}
    renderer = window.plotter.renderers[0]
    renderer.SetWorldPoint(31.5, 30 - 20.5, 0, 1)  # pixel 31,20
    renderer.WorldToDisplay()
    x, y, _ = renderer.GetDisplayPoint()
    window.plotter.iren._mouse_left_button_click(round(x), round(y))
    assert pixels[-1] == (31, 20)
    assert texts(window)["table"] == "pixel (31, 20)"


def box_of(text, renderer):
    """Where a text is: left, right, bottom, top; parts of the subplot."""
    size = [0.0, 0.0]
    text.GetSize(renderer, size)
    width, height = renderer.GetSize()
    x, y = text.GetPositionCoordinate().GetValue()[:2]
    style = text.GetTextProperty().GetVerticalJustificationAsString()
    low = {"Bottom": y, "Centered": y - size[1] / height / 2, "Top": y - size[1] / height}[style]
    return x, x + size[0] / width, low, low + size[1] / height


def places(renderer, points):
    """Where points of the scene are: parts of the subplot's width and height."""
    left, bottom, right, top = renderer.viewport
    window = renderer.GetVTKWindow().GetSize()
    found = []
    for point in points:
        renderer.SetWorldPoint(*point, 1)
        renderer.WorldToDisplay()
        x, y, _ = renderer.GetDisplayPoint()
        found.append(((x / window[0] - left) / (right - left), (y / window[1] - bottom) / (top - bottom)))
    return np.array(found)


@pytest.mark.parametrize("size", [(320, 240), (640, 480), (1024, 400)])
@pytest.mark.parametrize("by", ["level", "owner"])
def test_legends_stand_beside_the_scene_and_in_their_pane(rom, opened, size, by):
    names = (*(f"object {number} with a name that is long" for number in range(40)), "last")
    owners = octree.Owners(rom.octree, names)
    cube = np.zeros((16, 16, 16), np.uint8)
    cube[:, 0, :] = np.arange(256).reshape(16, 16) % 40 + 1
    many = octree.Owners(octree.from_dense(cube), names)
    world = octree.Rom("world", octree.from_dense((cube > 0).astype(np.uint8)), rom.materials)
    for pane in (view.Pane(rom, by=by, owners=owners), view.Pane(world, by=by, owners=many)):
        window = opened([pane, pane], size)
        for renderer, grid in zip(window.plotter.renderers, window.grids, strict=True):
            legend = {name: actor for name, actor in renderer.actors.items() if name.startswith("legend ")}
            boxes = [box_of(actor, renderer) for name, actor in legend.items() if not name.endswith("squares")]
            assert boxes
            low, high = np.min(boxes, axis=0), np.max(boxes, axis=0)
            assert low[[0, 2]].min() >= 0
            assert high[[1, 3]].max() <= 1
            scene = places(renderer, np.asarray(grid.points))
            assert scene[:, 0].max() < low[0]
            assert scene.min() > 0
            assert scene[:, 1].max() < 1 - 20 / size[1]  # below the title
    lines = [actor.GetInput() for name, actor in legend.items() if not name.endswith("squares")]
    if by == "owner" and size == (320, 240):
        assert lines[-1].startswith("and ")


@pytest.mark.parametrize("size", [(320, 240), (640, 480), (1024, 640)])
def test_the_hit_of_a_ray_is_in_the_table_and_in_the_middle(rom, opened, size):
    camera = look_at((5.5, 30, 4.5), (5.5, 10, 4.6), up=(0, 0, -1), size=(40, 30))
    window = opened([view.Pane(rom)], size, preview=preview_of(rom, camera, (40, 30), (20, 15)))
    table = texts(window)["table"].splitlines()
    assert table[0].startswith("pixel 20,15")
    assert table[1].startswith("hits voxel 5, 10, 4, its y")
    assert "0xFFFFFF02" in table[-1]
    below, pane = (
        next(renderer for renderer in window.plotter.renderers if name in renderer.actors) for name in ("table", "ray")
    )
    lowest = box_of(below.actors["table"], below)
    assert min(lowest) >= 0
    assert max(lowest) <= 1
    legend = [actor for name, actor in below.actors.items() if name.startswith("ray legend ") and "squares" not in name]
    assert legend[0].GetInput().startswith("words that are")  # a small picture cuts the row
    assert max(box_of(actor, below)[3] for actor in legend) < lowest[2]
    ray = preview_of(rom, camera, (40, 30), (20, 15)).follow((20, 15))
    middle = ray.corners[-1] + (1 << ray.levels[-1]) / 2
    assert places(pane, [middle])[0] == pytest.approx((0.5, 0.5), abs=0.01)


def test_faces_have_the_brightness_of_pictures(rom):
    pixels = view.picture([view.Pane(rom)], SIZE).reshape(-1, 3)
    found = {tuple(pixel) for pixel in pixels.tolist()}
    for brightness in (FACES[3], FACES[1], FACES[5]):  # those that the eye sees: top, right, front
        assert tuple(round(channel * brightness / 255) for channel in (220, 40, 40)) in found
