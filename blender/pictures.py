"""Pictures of memories for Blender: pixels as its render passes hold them, row 0 at the bottom."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

import voxrt
from voxrt.octree import frame_octree
from voxrt.octree.camera import pixel_directions, sample_cameras
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree.camera import Camera

FAR = 1e10
"""The depth of what no ray meets, as Blender's own engines write it."""


@dataclass(frozen=True, slots=True)
class View:
    """A memory as it is seen: from a camera, in a picture of some size, with so many rays per pixel on each axis."""

    result: voxrt.BuildResult
    camera: Camera
    size: tuple[int, int]
    samples: int = 1
    transparent: bool = False
    root: int = 0

    def frame(self) -> voxrt.Frame:
        """Render it by the exact model."""
        return voxrt.render(
            self._rom,
            self.camera,
            size=self.size,
            engine="model",
            lighting=self.result.lighting,
            samples=self.samples,
            background="transparent" if self.transparent else None,
        )

    def check(self) -> voxrt.sim.EngineCheck:
        """Render it by the simulated hardware and by the model, one ray per pixel, and compare them."""
        from voxrt.views.pictures import config_of  # noqa: PLC0415 - slow to import

        return voxrt.check(
            self._rom,
            self.camera,
            self.size,
            lighting=self.result.lighting or voxrt.Lighting(),
            config=config_of(self.result.lighting),
        )

    def depth(self) -> NDArray[np.float32]:
        """Return the exact depth of each pixel in metres along the line of sight: shape (H, W), row 0 at the bottom."""
        camera = sample_cameras(self.camera, self.size, self.samples)[0]
        directions = pixel_directions(camera, self.size).reshape(-1, 3)
        rom = self._rom
        hits = voxrt.cast_rays(rom.octree, np.array(camera.position) / 16, directions)
        sight = np.cross(camera.up, camera.right).astype(np.float64)
        ahead = directions @ (sight / np.linalg.norm(sight))
        assert rom.grid is not None
        depth = np.where(hits.hit, np.where(hits.hit, hits.parameter, 0) * ahead * rom.grid.voxel_size, FAR)
        return depth.reshape(self.size[1], self.size[0])[::-1].astype(np.float32)

    @property
    def _rom(self) -> voxrt.Rom:
        rom = self.result.rom
        if not self.root:
            return rom
        return voxrt.Rom(rom.name, frame_octree(rom.octree, self.root), rom.materials, rom.grid)


def combined(frame: voxrt.Frame) -> NDArray[np.float32]:
    """Return the linear, premultiplied pixels of a frame: float32, shape (H, W, 4), row 0 at the bottom."""
    colour = frame.colour[::-1]
    pixels = np.ones((*colour.shape[:2], 4), np.float32)
    pixels[:, :, :3] = LINEAR_OF_SRGB8[colour[:, :, :3]]
    if colour.shape[2] == 4:
        pixels[:, :, 3] = colour[:, :, 3] / 255
        pixels[:, :, :3] *= pixels[:, :, 3:]
    return pixels


def material_index(frame: voxrt.Frame) -> NDArray[np.float32]:
    """Return the memory's material of each pixel, 0 for none: float32, shape (H, W), row 0 at the bottom."""
    return frame.material[::-1].astype(np.float32)
