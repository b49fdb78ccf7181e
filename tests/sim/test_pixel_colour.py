"""How a pixel gets its colour, against the rendered picture and against rational arithmetic."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from oracles import worlds

from voxrt import sim
from voxrt.octree import Rom, from_dense
from voxrt.octree.camera import Lighting
from voxrt.voxelize import EMPTY, Material

SIZE = (24, 18)
VOXELS = worlds.noise(4, 0.12, 31)
COLOURS = np.random.default_rng(7).integers(0, 256, (256, 3)).tolist()
ROM = Rom(
    "noise",
    from_dense(VOXELS),
    (EMPTY, *(Material(f"m{n}", tuple(COLOURS[n]), mirror=n % 2 == 1) for n in range(1, int(VOXELS.max()) + 1))),
)
LIGHTINGS = {
    "faces": Lighting(),
    "report": Lighting(faces=None),
    "flat": Lighting(flat=True),
    "faces, light": Lighting((130, 300, 60), on=True, ambient=70),
    "report, light": Lighting((130, 300, 60), on=True, faces=None),
    "flat, light": Lighting((130, 130, 130), on=True, flat=True),
    "one mirror": Lighting(bounces=1),
    "mirrors, report": Lighting(bounces=15, faces=None),
    "mirrors, light": Lighting((130, 300, 60), on=True, bounces=3),
}


@pytest.mark.parametrize("name", LIGHTINGS)
@pytest.mark.parametrize("eye", [(30, 22, 40), (8.5, 8.5, 8.5), (-20, 3, 9)], ids=str)
def test_the_colour_is_that_of_the_picture(name, eye):
    lighting = LIGHTINGS[name]
    camera = sim.look_at(eye, (8, 7.5, 8), size=SIZE)
    frame = sim.render(ROM, camera, SIZE, engine="model", lighting=lighting)
    for row, column in np.ndindex(*frame.material.shape):
        path = sim.follow_pixel(ROM.octree, camera, SIZE, (column, row))
        found = sim.explain_colour(ROM, path, lighting)
        assert found.rgb == tuple(frame.colour[row, column].tolist())
        last = found.surface or (found.mirrors[-1] if found.is_mean else None)
        assert (last.material if last else 0) == frame.material[row, column]
        first = (*found.mirrors, found.surface)[0]
        assert (first.voxel if first else None) == path.cell
        assert all(ROM.materials[mirror.material].mirror for mirror in found.mirrors)
        assert len(found.mirrors) <= lighting.bounces + found.is_mean
        if found.surface is None:
            continue
        material = ROM.materials[found.surface.material].colour
        assert np.abs(np.multiply(material, found.brightness) - found.rgb).max() < 0.5 + 1e-9
        if found.surface.face and lighting.shading == "faces":
            sign, axis = found.surface.face
            assert found.face_brightness == lighting.faces[2 * "xyz".index(axis) + (sign == "+")]
            dark = found.light in {"turned away", "shadowed"}
            factor = Fraction(lighting.ambient, 256) if dark else 1
            assert found.brightness == float(Fraction(found.face_brightness, 255) * factor)


def test_every_state_of_the_light_occurs():
    lighting = LIGHTINGS["faces, light"]
    camera = sim.look_at((30, 22, 40), (8, 7.5, 8), size=SIZE)
    found = {
        sim.explain_colour(ROM, sim.follow_pixel(ROM.octree, camera, SIZE, (column, row)), lighting).light
        for column in range(SIZE[0])
        for row in range(SIZE[1])
    }
    assert found == {"none", "lit", "turned away", "shadowed"}


def test_the_side_is_the_one_that_the_camera_sees():
    for axis in range(3):
        for sign in (-1, 1):
            origin = [128, 128, 128]
            origin[axis] += sign * 1000
            direction = [0, 0, 0]
            direction[axis] = -sign
            voxels = np.zeros((16, 16, 16), np.uint8)
            voxels[8, 8, 8] = 2
            rom = Rom("dot", from_dense(voxels), ROM.materials)
            found = sim.explain_colour(rom, sim.follow_ray(rom.octree, origin, direction))
            assert found.surface.face == f"{'-+'[sign > 0]}{'xyz'[axis]}"
