"""PyVista, and whether it can draw here."""

import pytest


@pytest.fixture
def _pyvista():
    pytest.importorskip("pyvista", reason="PyVista is not installed")


@pytest.fixture
def _canvas(_pyvista):
    from voxrt.view import ViewerError
    from voxrt.view.plotter import check_screen

    try:
        check_screen(off_screen=True)
    except ViewerError as problem:
        pytest.skip(str(problem))
