"""Every public name of the rooms for users has a docstring, with an example that runs."""

from __future__ import annotations

import doctest
import importlib
import inspect
import pkgutil
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
ROOMS = ("voxrt", "voxrt.octree", "voxrt.export", "voxrt.sim", "voxrt.view")
FOLDERS = tuple(f"voxrt.{folder}" for folder in ("options", "sources", "views", "plans", "building", "boards"))

NEEDS = {
    "voxrt.sim.likeness": "open3d",
    "voxrt.view.animation": "pyvista",
    "voxrt.view.cells": "pyvista",
    "voxrt.view.pictures": "pyvista",
    "voxrt.view.window": "pyvista",
    "voxrt.views.depth_likeness": "open3d",
    "voxrt.sim.rendering.check": "voxrt.sim._rtl",
    "voxrt.sim.hardware.shader_features": "voxrt.sim._rtl",
}
"""What examples need that an installation may lack, by module or by function."""

RETURNED = {
    "voxrt.export.Manifest", "voxrt.export.RomFiles", "voxrt.export.RomInfo", "voxrt.export.WordFile",
    "voxrt.building.fitting.BudgetFit", "voxrt.building.fitting.InteriorFit",
    "voxrt.views.depth_likeness.LikenessAtDepth",
    "voxrt.octree.Census", "voxrt.octree.Difference", "voxrt.octree.Fit", "voxrt.octree.Leaves", "voxrt.octree.Octant",
    "voxrt.octree.Piece", "voxrt.octree.WorldFigures",
    "voxrt.octree.Region", "voxrt.octree.SurfaceChange", "voxrt.sim.Comparison", "voxrt.sim.EngineCheck",
    "voxrt.sim.Frame", "voxrt.sim.Likeness",
    "voxrt.sim.Picked", "voxrt.sim.PixelColour", "voxrt.sim.RayHits", "voxrt.sim.Reading", "voxrt.sim.RenderCost",
    "voxrt.sim.View", "voxrt.view.DrawnRay", "voxrt.view.Preview",
}  # fmt: skip
"""Values that a function returns: the function has the example."""


def modules():
    for room in (*ROOMS, *FOLDERS):
        package = importlib.import_module(room)
        folders = [path for path in package.__path__ if Path(path).resolve().is_relative_to(ROOT)] or package.__path__
        for module in pkgutil.iter_modules(folders):
            if not module.name.startswith("_") and not module.ispkg:
                yield f"{room}.{module.name}"


def examples():
    finder = doctest.DocTestFinder(exclude_empty=True)
    for name in modules():
        module = importlib.import_module(name)
        for test in finder.find(module):
            if test.examples:
                yield test


EXAMPLES = {test.name: test for test in examples()}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the example scenes, for what examples write."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)


@pytest.mark.usefixtures("folder")
@pytest.mark.parametrize("name", sorted(EXAMPLES))
def test_the_example_runs(name):
    for prefix, needed in NEEDS.items():
        if name == prefix or name.startswith(f"{prefix}."):
            pytest.importorskip(needed, reason=f"{needed} is not installed", exc_type=ImportError)
            if needed == "pyvista":
                skip_unless_pyvista_draws()
    runner = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS | doctest.FAIL_FAST)
    output = []
    runner.run(EXAMPLES[name], out=output.append)
    assert runner.failures == 0, "".join(output)


def skip_unless_pyvista_draws():
    from voxrt.view import ViewerError
    from voxrt.view.plotter import check_screen

    try:
        check_screen(off_screen=True)
    except ViewerError as error:
        pytest.skip(str(error))


def public():
    """The public functions and classes, by the name of the room's that exports them."""
    for room in ROOMS:
        package = importlib.import_module(room)
        for name in package.__all__:
            value = getattr(package, name)
            if inspect.isfunction(value) or inspect.isclass(value):
                yield value.__module__, name, value


@pytest.mark.parametrize(
    "value", [pytest.param(value, id=f"{module}.{name}") for module, name, value in sorted(public(), key=str)]
)
def test_the_public_name_is_documented_with_an_example(value):
    module = value.__module__
    if module.startswith(("voxrt.voxelize", "voxrt.octree.camera")):
        pytest.skip("the tests of that room hold it")
    assert value.__doc__
    room = module if module.startswith(FOLDERS) else ".".join(module.split(".")[:2])
    if issubclass(type(value), type) and (issubclass(value, Exception) or f"{room}.{value.__name__}" in RETURNED):
        return
    named = [name for name in EXAMPLES if name.startswith(f"{module}.{value.__qualname__}")]
    assert named, f"{module}.{value.__qualname__} has no example"
