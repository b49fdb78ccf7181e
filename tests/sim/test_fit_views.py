"""The pictures by which a budget chooses: their cameras, their likeness, and the choice."""

import math

import numpy as np
import pytest

import voxrt
from voxrt import octree, sim
from voxrt.octree.camera import THREE_QUARTER, Lighting
from voxrt.sim import _model
from voxrt.sim.engine_arguments import palette_of, registers_of
from voxrt.views.viewpoint import aim_camera

SIZE = (320, 240)


@pytest.fixture(scope="module")
def rom():
    return voxrt.build("examples/courtyard.glb", depth=6).rom


def cameras_around(rom):
    x, y, z = 1000 * np.array(THREE_QUARTER)
    for angle in np.arange(6) * math.pi / 3:
        across, ahead = x * math.cos(angle) + z * math.sin(angle), z * math.cos(angle) - x * math.sin(angle)
        yield aim_camera(rom, SIZE, look=(round(across), round(y), round(ahead)))


@pytest.mark.parametrize("flat", [False, True])
def test_views_are_those_of_aimed_cameras(rom, flat):
    views = _model.FitViews(_model.Memory(rom.octree.words, rom.octree.depth), palette_of(rom.materials), flat)
    cameras = list(cameras_around(rom))
    np.testing.assert_array_equal(views.cameras(), [registers_of(camera) for camera in cameras])
    coarse = octree.coarsen(rom.octree, 1)
    other = octree.Rom("coarse", coarse, rom.materials)
    lighting = Lighting(flat=True) if flat else Lighting(faces=None)
    pairs = [
        [sim.render(one, camera, SIZE, engine="model", lighting=lighting).colour for one in (rom, other)]
        for camera in cameras
    ]
    psnr, ssim = views.likeness(_model.Memory(coarse.words, coarse.depth))
    assert psnr == pytest.approx(np.mean([sim.peak_signal_to_noise(*pair) for pair in pairs]), abs=1e-9)
    assert ssim == pytest.approx(np.mean([sim.structural_similarity(*pair) for pair in pairs]), abs=1e-9)
    assert views.likeness(_model.Memory(rom.octree.words, rom.octree.depth)) == (math.inf, 1)


def test_the_fit_with_the_best_worst_figure_is_chosen():
    first = (100.0, 20.0, 0.5)
    assert _model.choose_fit([first]) == 0
    assert _model.choose_fit([first, (10.0, 30.0, 0.9), (1.0, 19.0, 0.9)]) == 1
    assert _model.choose_fit([first, first]) == 0
    with pytest.raises(ValueError, match="no fits"):
        _model.choose_fit([])
