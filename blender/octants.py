"""The cells of the octree, drawn over the viewport."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from voxrt.octree.leaf_arrays import solid_leaves

from .memory import LATEST

if TYPE_CHECKING:
    from numpy.typing import NDArray

    import voxrt

MOST_CELLS = 100_000
"""More are not drawn: the largest ones are."""

_COLOUR = (1.0, 0.6, 0.1, 0.6)
_CORNERS = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)])
_EDGES = np.array([[i, i | 1 << axis] for axis in range(3) for i in range(8) if not i >> axis & 1])


def cell_edges(rom: voxrt.Rom) -> NDArray[np.float32]:
    """Return the edges of the solid octants of a memory, the largest first: shape (N, 12, 2, 3), Blender's frame."""
    assert rom.grid is not None
    found = solid_leaves(rom.octree)
    order = np.argsort(-found.levels.astype(np.int8), kind="stable")[:MOST_CELLS]
    sides = 1 << found.levels[order].astype(np.int64)
    corners = found.corners[order][:, None] + _CORNERS * sides[:, None, None]
    placed = corners * rom.grid.voxel_size + np.array(rom.grid.origin)
    x, y, z = np.moveaxis(placed[:, _EDGES], -1, 0)
    return np.stack([x, -z, y], axis=-1).astype(np.float32)


class _Overlay:
    """Draws the cells of the latest memory of the scene that a viewport shows."""

    def __init__(self) -> None:
        self._handle: Any = None
        self._rom: object = None
        self._batch: Any = None

    def show(self) -> None:
        self._handle = bpy.types.SpaceView3D.draw_handler_add(self._draw, (), "WINDOW", "POST_VIEW")

    def hide(self) -> None:
        bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")

    def _draw(self) -> None:
        import gpu  # noqa: PLC0415 - Blender without a screen has none
        from gpu_extras.batch import batch_for_shader  # noqa: PLC0415

        scene = bpy.context.scene
        result = LATEST.results.get(scene.name)
        if result is None or not scene.voxrt.octants:
            return
        shader = gpu.shader.from_builtin("UNIFORM_COLOR")
        if self._rom is not result.rom:
            self._rom = result.rom
            self._batch = batch_for_shader(shader, "LINES", {"pos": cell_edges(result.rom).reshape(-1, 3)})
        gpu.state.blend_set("ALPHA")
        gpu.state.depth_test_set("LESS_EQUAL")
        shader.bind()
        shader.uniform_float("color", _COLOUR)
        self._batch.draw(shader)
        gpu.state.depth_test_set("NONE")
        gpu.state.blend_set("NONE")


_OVERLAY = _Overlay()


def register() -> None:
    """Draw the overlay in all viewports, where their scene wants it."""
    _OVERLAY.show()


def unregister() -> None:
    """Undo :func:`register`."""
    _OVERLAY.hide()
