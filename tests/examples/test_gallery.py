"""Every example of the gallery runs, and shows what it is meant to, to the pixel.

``pytest tests/examples/test_gallery.py`` with VOXRT_RENEW_PICTURES=1 writes the pictures anew: look at them.
"""

from __future__ import annotations

import os
import runpy
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image

HERE = Path(__file__).parent
GALLERY = HERE.parents[1] / "examples" / "gallery"
PICTURES = HERE / "pictures"


@pytest.fixture(autouse=True)
def _no_screen():
    mpl.use("Agg")
    yield
    mpl.pyplot.close("all")


@pytest.mark.filterwarnings("ignore:FigureCanvasAgg is non-interactive")
@pytest.mark.parametrize("example", sorted(GALLERY.glob("*.py")), ids=lambda path: path.stem)
def test_an_example_shows_its_picture(example):
    picture = runpy.run_path(str(example), run_name="__main__")["picture"]
    golden = PICTURES / f"{example.stem}.png"
    if os.environ.get("VOXRT_RENEW_PICTURES"):
        Image.fromarray(picture).save(golden, optimize=True)
    np.testing.assert_array_equal(picture, np.asarray(Image.open(golden).convert("RGB")))
