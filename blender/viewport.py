"""The viewport: the memory as it is edited, rendered with fewer pixels while something moves."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from msgspec.structs import replace

import voxrt
from voxrt.views.viewpoint import authored_camera
from voxrt.voxelize.formats.blend.scene import SceneReader
from voxrt.voxelize.formats.blend.views import projected_viewpoint, read_daylight

from .edited_memory import EditedMemory
from .memory import LATEST, scene_name
from .pictures import View
from .settings import build_options

if TYPE_CHECKING:
    from numpy.typing import NDArray

REST_SECONDS = 0.4
"""How long nothing must move before a picture is exact."""

_COARSE, _COARSEST = 2, 8  # pixels of the viewport per rendered one, on each axis, while something moves
_MOVING_SECONDS = 0.06
"""What a picture may take while something moves: slower ones have fewer pixels next time."""

_FASTER = 6  # so many times faster, pictures get four times the pixels again


@dataclass(frozen=True, slots=True)
class Looking:
    """How a viewport looks at the scene: the frame of its eye in Blender's, its projection, and its size in pixels."""

    place: tuple[tuple[float, ...], ...]
    projection: tuple[tuple[float, ...], ...]
    size: tuple[int, int]

    @classmethod
    def of(cls, region: Any, view: Any) -> Looking:
        """Return how a region looks."""
        place, projection = (tuple(map(tuple, one)) for one in (view.view_matrix.inverted(), view.window_matrix))
        return cls(place, projection, (region.width, region.height))


class Viewport:
    """The memory that one viewport shows."""

    def __init__(self) -> None:
        self._reader: SceneReader | None = None
        self._edited: EditedMemory | None = None
        self._result: voxrt.BuildResult | None = None
        self._options: voxrt.BuildOptions | None = None
        self._exact = True  # whether the memory is that of a whole build
        self._moved = 0.0  # when something moved last
        self._looking: Looking | None = None
        self._divisor = _COARSE

    def update(self, depsgraph: Any) -> None:
        """Take over what changed: one object at a time where that is all, else the whole scene.

        Raise what :func:`voxrt.build` raises.
        """
        self._moved = time.monotonic()
        if self._result is None or not self._take_edits(depsgraph):
            self._build(depsgraph)

    def rest(self, depsgraph: Any) -> bool:
        """Build the whole scene if its memory was edited, and nothing has moved for a while. Tell whether all is exact.

        Raise what :func:`voxrt.build` raises.
        """
        if time.monotonic() - self._moved < REST_SECONDS:
            return False
        if not self._exact:
            self._build(depsgraph)
        return True

    def look(self, looking: Looking) -> None:
        """Take note of how the region looks now."""
        if looking != self._looking:
            self._looking, self._moved = looking, time.monotonic()

    def view(self, looking: Looking, *, coarse: bool) -> View | None:
        """Return the view of a region; `coarse` for fewer pixels. None where it has no perspective, or no memory."""
        if self._result is None:
            return None
        divisor = self._divisor if coarse else 1
        width, height = (max(1, side // divisor) for side in looking.size)
        viewpoint = projected_viewpoint("viewport", np.array(looking.place), looking.projection, looking.size)
        if viewpoint is None:
            return None
        grid = self._result.rom.grid
        assert grid is not None
        return View(self._result, authored_camera(viewpoint, grid, (width, height)), (width, height))

    def frame(self, looking: Looking, *, coarse: bool) -> voxrt.Frame | None:
        """Render the view of a region; a coarse one that takes long has fewer pixels next time."""
        view = self.view(looking, coarse=coarse)
        if view is None:
            return None
        began = time.monotonic()
        frame = view.frame()
        took = time.monotonic() - began
        if coarse and took > _MOVING_SECONDS:
            self._divisor = min(2 * self._divisor, _COARSEST)
        elif coarse and took * _FASTER < _MOVING_SECONDS:
            self._divisor = max(self._divisor // 2, _COARSE)
        return frame

    def _build(self, depsgraph: Any) -> None:
        scene = depsgraph.scene.original
        self._options = build_options(scene, read_daylight(depsgraph))
        self._reader = SceneReader(bpy.data.materials, scene_name(scene))
        read = self._reader.scene(depsgraph, scene_name(scene))
        self._result = voxrt.build(read, options=self._options)
        self._edited = EditedMemory(read, self._result, self._options)
        self._exact = True
        LATEST.results[scene.name] = self._result

    def _take_edits(self, depsgraph: Any) -> bool:
        """Make the voxels of edited objects again. False where the whole scene must be built."""
        assert self._reader is not None
        assert self._edited is not None
        assert self._result is not None
        changed = [one for one in depsgraph.updates if not isinstance(one.id, bpy.types.Scene | bpy.types.Collection)]
        objects = {
            one.id.name: one.id
            for one in changed
            if isinstance(one.id, bpy.types.Object) and (one.is_updated_transform or one.is_updated_geometry)
        }
        # The data of an object comes with the object.
        others = [one.id for one in changed if not isinstance(one.id, bpy.types.Object | bpy.types.Mesh)]
        if others or any(one.type != "MESH" or one.is_instancer for one in objects.values()):
            return False
        if build_options(depsgraph.scene.original, read_daylight(depsgraph)) != self._options:
            return False
        for one in objects.values():
            found = self._reader.again(one)
            if found is None or not self._edited.replaced(*found):
                return False
        if objects:
            self._edited.commit()
            self._result = replace(self._result, rom=self._edited.rom())
            self._exact = False
        return True


def draw(pixels: NDArray[np.float32], size: tuple[int, int]) -> None:
    """Draw linear, premultiplied pixels, shape (H, W, 4), row 0 at the bottom, over a region of some size."""
    import gpu  # noqa: PLC0415 - Blender without a screen has none
    from gpu_extras.presets import draw_texture_2d  # noqa: PLC0415

    height, width, _ = pixels.shape
    data = gpu.types.Buffer("FLOAT", pixels.size, np.ascontiguousarray(pixels).reshape(-1))
    texture = gpu.types.GPUTexture((width, height), format="RGBA32F", data=data)
    gpu.state.blend_set("ALPHA_PREMULT")
    draw_texture_2d(texture, (0, 0), *size)
    gpu.state.blend_set("NONE")
