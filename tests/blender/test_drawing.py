"""What viewports draw by the GPU's interface, off-screen: on a machine without a GPU, Mesa computes it."""

from __future__ import annotations

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="Blender's module bpy is not here: make blender-test")

import blender_scenes as scenes  # noqa: E402

pytestmark = pytest.mark.usefixtures("extension")

SIZE = (96, 64)


@pytest.fixture
def gpu():
    """Blender's module gpu, which draws."""
    module = pytest.importorskip("gpu")
    if not hasattr(module, "init"):
        pytest.skip("this Blender draws nothing without a window")
    try:
        module.init()
    except (SystemError, RuntimeError) as error:
        pytest.skip(f"nothing can be drawn here: {error}")
    return module


def grown(mask):
    """A mask with the pixels around it."""
    padded = np.pad(mask, 1)
    height, width = mask.shape
    return np.any([padded[row : row + height, column : column + width] for row in range(3) for column in range(3)], 0)


def drawn(gpu, projection, draw):
    """What is drawn on transparent black: float32, shape (H, W, 4), row 0 at the bottom."""
    from mathutils import Matrix

    target = gpu.types.GPUOffScreen(*SIZE, format="RGBA32F")
    with target.bind():
        found = gpu.state.active_framebuffer_get()
        found.clear(color=(0, 0, 0, 0), depth=1)
        with gpu.matrix.push_pop(), gpu.matrix.push_pop_projection():
            gpu.matrix.load_matrix(Matrix.Identity(4))
            gpu.matrix.load_projection_matrix(Matrix(projection))
            draw()
        pixels = found.read_color(0, 0, *SIZE, 4, 0, "FLOAT")
    target.free()
    pixels.dimensions = SIZE[0] * SIZE[1] * 4
    return np.array(pixels, np.float32).reshape(SIZE[1], SIZE[0], 4)


def screen():
    """The projection in which a region draws: x and y count pixels."""
    found = np.diag([2 / SIZE[0], 2 / SIZE[1], -1, 1])
    found[:2, 3] = -1
    return found.tolist()


def test_a_picture_is_drawn_pixel_by_pixel(gpu):
    from voxrt_extension.viewport import draw

    rng = np.random.default_rng(1)
    alpha = rng.integers(0, 2, (SIZE[1], SIZE[0], 1))
    pixels = np.concatenate([rng.random((SIZE[1], SIZE[0], 3)) * alpha, alpha], axis=2).astype(np.float32)
    np.testing.assert_allclose(drawn(gpu, screen(), lambda: draw(pixels, SIZE)), pixels, atol=1e-5)


def test_a_coarse_picture_fills_the_region(gpu):
    """It is interpolated between the middles of its pixels."""
    from voxrt_extension.viewport import draw

    pixels = np.random.default_rng(2).random((SIZE[1] // 4, SIZE[0] // 4, 4)).astype(np.float32)
    pixels[..., 3] = 1
    expected = pixels
    for axis in (0, 1):
        count = expected.shape[axis]
        places = np.clip((np.arange(4 * count) + 0.5) / 4 - 0.5, 0, count - 1)
        low = np.minimum(places.astype(int), count - 2)
        weights = np.expand_dims(places - low, tuple(one for one in range(3) if one != axis))
        expected = expected.take(low, axis) * (1 - weights) + expected.take(low + 1, axis) * weights
    np.testing.assert_allclose(drawn(gpu, screen(), lambda: draw(pixels, SIZE)), expected, atol=0.01)


def test_octants_are_drawn_where_their_edges_are(gpu):
    from voxrt_extension.memory import LATEST
    from voxrt_extension.octants import _OVERLAY, cell_edges

    scenes.monkey()
    scene = bpy.context.scene
    scene.voxrt.depth = 3
    bpy.ops.voxrt.build()
    camera = scenes.link("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (3, -4, 2), (1.15, 0, 0.6)
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    lens = camera.calc_matrix_camera(depsgraph, x=SIZE[0], y=SIZE[1])
    projection = np.array(lens) @ np.array(camera.matrix_world.inverted())

    assert not drawn(gpu, projection.tolist(), _OVERLAY._draw).any()
    scene.voxrt.octants = True
    shown = drawn(gpu, projection.tolist(), _OVERLAY._draw)[..., 3] > 0

    edges = cell_edges(LATEST.results[scene.name].rom).reshape(-1, 2, 3)
    along = np.linspace(0, 1, 200)[None, :, None]
    points = (edges[:, :1] * (1 - along) + edges[:, 1:] * along).reshape(-1, 3)
    clip = np.column_stack([points, np.ones(len(points))]) @ projection.T
    places = ((clip[:, :2] / clip[:, 3:] + 1) / 2 * SIZE).astype(int)
    inside = ((places >= 0) & (places < SIZE)).all(axis=1)
    expected = np.zeros((SIZE[1], SIZE[0]), bool)
    expected[places[inside, 1], places[inside, 0]] = True
    assert shown.any()
    assert not (shown & ~grown(expected)).any()
    assert not (expected & ~grown(shown)).any()
