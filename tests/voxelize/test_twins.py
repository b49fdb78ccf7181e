"""One model in two formats gives the same voxels."""

import numpy as np
import pytest
from assets import asset

from voxrt.voxelize import fit_grid, voxelize
from voxrt.voxelize.load import load

ARRAYS = ("brick_codes", "brick_masks", "octant_codes", "octant_levels")


@pytest.mark.parametrize(
    ("one", "other", "up"),
    [
        # The stages say z up of the coordinates that their OBJ twins hold, too.
        ("obj/kaolin/amsterdam.obj", "usd/kaolin/sample_data/meshes/amsterdam.usda", "z"),
        ("obj/kaolin/pizza.obj", "usd/kaolin/sample_data/meshes/pizza.usda", "z"),
        ("usd/kaolin/tests/samples/io/amsterdam.usdz", "usd/kaolin/sample_data/meshes/amsterdam.usda", None),
        ("usd/kaolin/tests/samples/io/pizza.usdz", "usd/kaolin/sample_data/meshes/pizza.usda", None),
    ],
)
@pytest.mark.parametrize("fill", ["solid", "surface"])
def test_the_same_voxels(one, other, up, fill):
    first, second = load(asset(one), up=up), load(asset(other))
    grid = fit_grid(first, depth=6)
    ours, twins = (voxelize(scene, grid, fill=fill).voxels for scene in (first, second))
    for name in ARRAYS:
        assert np.array_equal(getattr(ours, name), getattr(twins, name)), name
