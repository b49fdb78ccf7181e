"""The ray of a double-click: the voxel, the face and the point that the page is told."""

from __future__ import annotations

import numpy as np
import pytest
from fakes.device import scene
from oracles.cuts import memory_of

from voxrt.board.errors import Refused
from voxrt.board.scene import Scene
from voxrt.serve.request_handler import _cast_ray
from voxrt.serve.requests import CastRay

SOLID = (5, 2, 9)


def one_voxel():
    voxels = np.zeros((16, 16, 16), np.uint8)
    voxels[SOLID] = 7
    return Scene("one voxel", 4, memory_of(voxels), np.zeros((256, 3), np.uint8), np.zeros(256, bool))


@pytest.mark.parametrize(
    ("origin", "direction", "face", "point"),
    [
        ((-16, 40, 152), (3, 0, 0), 0, (5, 2.5, 9.5)),
        ((88, 400, 152), (0, -9, 0), 1, (5.5, 3, 9.5)),
        ((85, 40, 400), (0, 0, -(2**20 - 1)), 2, (5.3125, 2.5, 10)),
        ((72, 32, 152), (2, 1, 0), 0, (5, 2.25, 9.5)),
        ((88, 40, 152), (1, 2, 3), None, (5.5, 2.5, 9.5)),
        ((88, 40, 152), (0, 0, 0), None, (5.5, 2.5, 9.5)),
    ],
)
def test_hits(origin, direction, face, point):
    hit = _cast_ray(one_voxel(), 0, CastRay(origin=origin, direction=direction))
    assert hit == {"voxel": list(SOLID), "material": 7, "face": face, "point": pytest.approx(point, abs=1e-9)}


@pytest.mark.parametrize(
    ("origin", "direction"), [((-16, 40, 152), (-3, 0, 0)), ((8, 8, 8), (0, 0, 0)), ((-16, 40, 152), (0, 0, 0))]
)
def test_misses(origin, direction):
    assert _cast_ray(one_voxel(), 0, CastRay(origin=origin, direction=direction)) is None


def test_the_frame_of_an_animation():
    frames = scene(blocks=2, material=3, roots=(1, 2))  # word 1 leads to the second block, word 2 is a leaf
    assert _cast_ray(frames, 1, CastRay(origin=(-16, 40, 8), direction=(1, 0, 0)))["voxel"] == [0, 2, 0]


def test_a_ray_from_farther_than_registers_reach():
    with pytest.raises(Refused, match="must be multiples of 1/16 voxel below"):
        _cast_ray(one_voxel(), 0, CastRay(origin=(-(1 << 31), 0, 0), direction=(1, 0, 0)))
