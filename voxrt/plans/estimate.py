"""What a build will take, before it is begun: from the surface of the scene, counted in voxels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from voxrt.voxelize import _native
from voxrt.voxelize.rules import RULES

if TYPE_CHECKING:
    from voxrt.options.build_options import BuildOptions
    from voxrt.voxelize import Grid, Mesh, Scene, SceneObject

_SECONDS_PER_TRIANGLE = 1e-6
_SECONDS_PER_SURFACE_VOXEL = 60e-9
_SECONDS_PER_COLOURED_VOXEL = 100e-9
_SECONDS_PER_RULED_VOXEL = {"touch": 0.0, "centre": 80e-9, "half": 160e-9}
_SECONDS_PER_BAKED_VOXEL_AND_SAMPLE = 40e-9
_SECONDS_PER_HARDWARE_RAY = 6e-6
_TRIANGLES_PER_POINT = 0.5  # a voxel of four triangles holds several points
_BYTES_AT_START = 60 << 20
_BYTES_PER_TRIANGLE = 200
_BYTES_PER_SURFACE_VOXEL = 8
_BYTES_PER_COLOURED_VOXEL = 8
_BYTES_PER_RULED_VOXEL = {"touch": 0, "centre": 10, "half": 12}


class BuildEstimate(Struct, frozen=True):
    """What a build will take, to about a factor of two.

    Examples
    --------
    >>> str(BuildEstimate(200.0, 6 << 30))
    '3 minutes and 6.0 GB of memory'
    >>> str(BuildEstimate(200.0, 2 << 30, disk=9 << 30))
    '3 minutes, 2.0 GB of memory and 9.0 GB of disk'
    """

    seconds: float  # by the clock on the wall
    bytes: int  # of memory at the peak
    disk: int = 0  # bytes while it is built, besides the output
    surface: int = 0  # voxels of it
    least: int = 0  # bytes of memory that the program and the triangles take in any case
    width: int = 0  # voxels of the grid, along x or y, that the scene spans; 0 if that is not known

    def __str__(self) -> str:
        minutes = round(self.seconds / 60)
        time = f"{minutes} minute{'s' * (minutes > 1)}" if minutes else f"{self.seconds:.0f} seconds"
        memory = f"{self.bytes / (1 << 30):.1f} GB of memory"
        if not self.disk:
            return f"{time} and {memory}"
        return f"{time}, {memory} and {self.disk / (1 << 30):.1f} GB of disk"


def estimate_build(scene: Scene, grid: Grid, options: BuildOptions) -> BuildEstimate:
    """Estimate what a build takes, from the number of triangles or points and of the voxels that they meet.

    A triangle meets about as many voxels as its projection along the axis that it faces most has voxel areas, and half
    as many again beside them.

    Examples
    --------
    >>> import voxrt
    >>> scene = voxrt.load("examples/house.obj")
    >>> estimate_build(scene, voxrt.fit_grid(scene, depth=7), voxrt.BuildOptions()).seconds < 10
    True
    """
    triangles, surface, coloured = 0.0, 0.0, 0.0
    ruled = dict.fromkeys(RULES, 0.0)
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    shown: dict[int, tuple[Mesh, list[SceneObject]]] = {}
    for item in scene.objects:
        if item.points is not None:
            surface += len(item.points.positions)
            triangles += _TRIANGLES_PER_POINT * len(item.points.positions)
        elif len(item.mesh.triangles):
            shown.setdefault(id(item.mesh), (item.mesh, []))[1].append(item)
    for mesh, items in shown.values():
        areas, lowest, highest = _native.projected_areas(
            (
                np.ascontiguousarray(mesh.positions),
                np.ascontiguousarray(mesh.triangles, np.int32),
                np.stack([one.transform[:3] for one in items]),
            )
        )
        low, high = np.minimum(low, lowest), np.maximum(high, highest)
        for item, area in zip(items, areas, strict=True):
            voxels = 1.5 * area / grid.voxel_size / grid.voxel_size  # its square may overflow
            surface += voxels
            ruled[item.rule or options.rule] += voxels
            coloured += voxels if mesh.appearance is not None else 0
        triangles += len(items) * len(mesh.triangles)
    surface, coloured = (min(number, 8.0**grid.depth) for number in (surface, coloured))
    seconds = (
        triangles * _SECONDS_PER_TRIANGLE
        + surface * _SECONDS_PER_SURFACE_VOXEL
        + coloured * _SECONDS_PER_COLOURED_VOXEL
        + sum(min(ruled[rule], surface) * _SECONDS_PER_RULED_VOXEL[rule] for rule in RULES)
    )
    if options.bake:
        seconds += surface * options.bake_samples * _SECONDS_PER_BAKED_VOXEL_AND_SAMPLE
    if options.preview and options.engine == "rtl":
        seconds += hardware_seconds(options.size, options.samples or 1)
    least = _BYTES_AT_START + int(triangles * _BYTES_PER_TRIANGLE)
    taken = least + surface * _BYTES_PER_SURFACE_VOXEL + coloured * _BYTES_PER_COLOURED_VOXEL
    taken += sum(min(ruled[rule], surface) * _BYTES_PER_RULED_VOXEL[rule] for rule in RULES)
    ends = np.clip((np.stack([low, high]) - grid.origin) / grid.voxel_size, 0, grid.size)[:, :2]
    width = int(np.ceil(max(0.0, float((ends[1] - ends[0]).max()))))
    return BuildEstimate(seconds, int(taken), surface=int(surface), least=least, width=width)


def hardware_seconds(size: tuple[int, int], samples: int = 1) -> float:
    """Estimate the seconds that the simulated hardware takes for a picture.

    Examples
    --------
    >>> hardware_seconds((640, 480)) < 5
    True
    """
    return size[0] * size[1] * samples**2 * _SECONDS_PER_HARDWARE_RAY
