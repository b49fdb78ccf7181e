"""F12: pixels are those of `voxrt.render` of the exported memory."""

from __future__ import annotations

import struct

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="Blender's module bpy is not here: make blender-test")

import blender_scenes as scenes  # noqa: E402

import voxrt  # noqa: E402
from voxrt.views.viewpoint import authored_camera  # noqa: E402
from voxrt.voxelize.colour.srgb import srgb_from_linear  # noqa: E402

MATERIAL_PASS = "Material Index" if bpy.app.version >= (5, 0, 0) else "IndexMA"
pytestmark = pytest.mark.usefixtures("extension")


def stage(size=(160, 120), **settings):
    """A scene with a camera for the engine."""
    scenes.monkey(material=scenes.paint("skin", (0.6, 0.3, 0.1)))
    scenes.cube((2.5, 1, 0), scenes.textured()[0])
    camera = scenes.link("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (5, -7, 4), (1.15, 0, 0.6)
    camera.data.shift_x = 0.05
    scene = bpy.context.scene
    scene.camera = camera
    scene.render.engine = "VOXRT"
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.voxrt.depth = 6
    for name, value in settings.items():
        setattr(scene.voxrt, name, value)
    return scene


def rendered(tmp_path):
    """The passes of F12 as Blender writes them into a file: arrays by name, row 0 at the top."""
    scene = bpy.context.scene
    bpy.ops.render.render()
    path = tmp_path / "picture.exr"
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.color_depth, settings.exr_codec = "OPEN_EXR_MULTILAYER", "32", "NONE"
    if hasattr(settings, "use_exr_interleave"):
        settings.use_exr_interleave = True  # one part
    bpy.data.images["Render Result"].save_render(str(path), scene=scene)
    return passes_of(path.read_bytes())


def passes_of(data):
    """Read an uncompressed OpenEXR file of 32-bit channels: passes by name, channels in the order of their names."""
    at, header = 8, {}
    while data[at]:
        name, kind, _ = data[at:].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        (length,) = struct.unpack_from("<i", data, at)
        header[name.decode()] = data[at + 4 : at + 4 + length]
        at += 4 + length
    assert header["compression"] == b"\0"
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    names, place = [], 0
    while header["channels"][place]:
        name = header["channels"][place:].split(b"\0", 1)[0]
        assert struct.unpack_from("<i", header["channels"], place + len(name) + 1) == (2,)
        names.append(name.decode())
        place += len(name) + 17
    rows = np.frombuffer(data, np.uint8, offset=at + 1 + 8 * height).reshape(height, -1)[:, 8:]
    channels = np.ascontiguousarray(rows).view("<f4").reshape(height, len(names), width)
    passes = {}
    for number, name in enumerate(names):
        _, layer, channel = name.rsplit(".", 2)
        passes.setdefault(layer, {})[channel] = channels[:, number]
    return passes


def sRGB(one):  # noqa: N802 - the name of the curve
    return srgb_from_linear(np.dstack([one["R"], one["G"], one["B"]]))


def exported(tmp_path, result):
    """The memory as its file holds it."""
    result.save(tmp_path / "memory.mem")
    return voxrt.read_rom(tmp_path / "memory.mem")[0]


@pytest.mark.parametrize("samples", ["1", "2"])
def test_pixels_are_those_of_the_exported_memory(tmp_path, samples):
    from voxrt_extension.engine import render_size
    from voxrt_extension.memory import LATEST

    scene = stage(samples=samples)
    passes = rendered(tmp_path)
    result = LATEST.results[scene.name]
    rom = exported(tmp_path, result)
    size = render_size(scene.render)
    assert size == (160, 120)
    camera = authored_camera(result.scene.viewpoint, rom.grid, size)
    frame = voxrt.render(rom, camera, size=size, engine="model", samples=int(samples))
    np.testing.assert_array_equal(sRGB(passes["Combined"]), frame.colour)
    assert len(np.unique(frame.material)) > 3
    assert (passes["Combined"]["A"] == 1).all()


def test_passes_are_exact(tmp_path):
    """Depth and material of each pixel are those of the voxels that a marching oracle finds."""
    scene = stage(size=(64, 48))
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_material_index = True
    passes = rendered(tmp_path)
    from voxrt_extension.memory import LATEST

    result = LATEST.results[scene.name]
    grid = result.rom.grid
    camera = authored_camera(result.scene.viewpoint, grid, (64, 48))
    frame = voxrt.render(result.rom, camera, size=(64, 48), engine="model")
    depth, index = passes["Depth"]["Z"], passes[MATERIAL_PASS]["X"]
    np.testing.assert_array_equal(index, frame.material)
    assert (depth[frame.material == 0] == np.float32(1e10)).all()
    # The depth of each pixel, against the position at which its ray stands then: on a face of a voxel of the material.
    cells = result.to_dense()
    eye = np.array(camera.position) / 16
    forward = np.cross(camera.up, camera.right).astype(float)
    forward /= np.linalg.norm(forward)
    for row, column in np.argwhere(frame.material)[::37]:
        way = np.array(camera.look) + np.array(camera.right) * (column - 32) + np.array(camera.up) * (24 - row)
        place = eye + way * (depth[row, column] / grid.voxel_size / (way @ forward))
        axis = frame.face[row, column]
        assert place[axis] == pytest.approx(round(place[axis]), abs=1e-3)
        inside = place + 1e-2 * np.sign(way) * (np.arange(3) == axis)
        assert cells[tuple(np.floor(inside).astype(int))] == frame.material[row, column]


def test_transparent_film(tmp_path):
    scene = stage()
    scene.render.film_transparent = True
    passes = rendered(tmp_path)
    alpha = passes["Combined"]["A"]
    assert set(np.unique(alpha)) == {0.0, 1.0}


def test_size_and_percentage(tmp_path):
    scene = stage(size=(160, 120))
    scene.render.resolution_percentage = 50
    assert rendered(tmp_path)["Combined"]["R"].shape == (60, 80)


def test_frames_differ(tmp_path):
    scene = stage()
    one = bpy.data.objects["Suzanne"]
    for frame, turn in ((1, 0.0), (10, 2.0)):
        one.rotation_euler.z = turn
        one.keyframe_insert("rotation_euler", frame=frame)
    scene.frame_set(1)
    first = rendered(tmp_path)["Combined"]["R"]
    scene.frame_set(10)
    assert (rendered(tmp_path)["Combined"]["R"] != first).any()


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (
            lambda scene: setattr(scene.camera.data, "type", "ORTHO"),
            "Scene: camera: cameras without perspective were left out; make its lens a perspective one",
        ),
        (lambda _: scenes.cube().__setitem__("voxrt_rule", "all"), "voxrt_rule: invalid enum value 'all'"),
    ],
)
def test_what_cannot_be_rendered_is_one_line(change, problem):
    scene = stage()
    change(scene)
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.render.render()
    assert problem in str(caught.value)
    assert len(str(caught.value).strip().splitlines()) == 1
