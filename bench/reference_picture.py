"""Reference pictures of a scene's triangles, under a sun and a sky: what a preview should look like.

Visibility comes from Open3D's RaycastingScene (Embree): the first triangle on a ray, the shadow rays to the sun and the
rays to the sky. Colours come from the source: textures and vertex colours at the point hit, not from voxels. The shade
is Lambert's, by the source's own normals where it has them; else a triangle is smooth where the mean normals at its
corners are within 45 degrees of its own. Sides that face away are shaded as if they faced the viewer. There is no light
from surface to surface. Open3D's own renderer (Filament) needs a Vulkan driver, which many machines lack.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import open3d

from voxrt.voxelize.colour.appearance import sample
from voxrt.voxelize.colour.srgb import linear_from_srgb

if TYPE_CHECKING:
    from voxrt.sim.baking.daylight import Daylight
    from voxrt.voxelize import Grid, Scene

_SMOOTH = np.cos(np.radians(45.0))
_GROUND = 0.5
_LIFT = 1e-3  # voxels
_AWAY = 1e-2


@dataclass(frozen=True, eq=False)
class _Part:
    """The triangles of one object: where they begin among all, and what gives their colours."""

    first: int
    mesh: object


class Reference:
    """A scene in voxels of a grid, ready to be looked at."""

    def __init__(self, scene: Scene, grid: Grid) -> None:
        self._scene = scene
        self._parts: list[_Part] = []
        corners = []
        for item in scene.objects:
            mesh = item.mesh
            if not len(mesh.triangles):
                continue
            places = mesh.positions.astype(np.float64) @ item.transform[:3, :3].T + item.transform[:3, 3]
            triangles = mesh.triangles[:, ::-1] if np.linalg.det(item.transform[:3, :3]) < 0 else mesh.triangles
            self._parts.append(_Part(sum(map(len, corners)), mesh))
            corners.append(((places - grid.origin) / grid.voxel_size)[triangles])
        self._mirrored = [
            np.linalg.det(item.transform[:3, :3]) < 0 for item in scene.objects if len(item.mesh.triangles)
        ]
        self.corners = np.concatenate(corners)
        self._firsts = np.array([part.first for part in self._parts])
        flat = np.ascontiguousarray(self.corners.reshape(-1, 3).astype(np.float32))
        self._tracer = open3d.t.geometry.RaycastingScene()
        self._tracer.add_triangles(flat, np.arange(len(flat), dtype=np.uint32).reshape(-1, 3))
        welded, places = np.unique(flat, axis=0, return_inverse=True)
        sides = self.corners[:, 1:] - self.corners[:, :1]
        faces = np.cross(sides[:, 0], sides[:, 1])
        self._faces = _unit(faces)
        normals = np.zeros((len(welded), 3))
        for corner in range(3):
            np.add.at(normals, places.reshape(-1, 3)[:, corner], faces)
        smooth = _unit(normals)[places.reshape(-1, 3)]
        is_smooth = (np.einsum("tkc,tc->tk", smooth, self._faces) > _SMOOTH).all(axis=1)
        self._normals = np.where(is_smooth[:, None, None], smooth, self._faces[:, None])
        self._take_authored_normals()

    def _take_authored_normals(self) -> None:
        shown = [item for item in self._scene.objects if len(item.mesh.triangles)]
        for item, part, mirrored in zip(shown, self._parts, self._mirrored, strict=True):
            if item.mesh.normals is None:
                continue
            linear = item.transform[:3, :3]
            found = _unit(item.mesh.normals.of_corners() @ np.linalg.pinv(linear))
            found = found[:, ::-1] if mirrored else found
            here = slice(part.first, part.first + len(found))
            behind = np.einsum("tkc,tc->t", found, self._faces[here]) < 0
            found[behind] = -found[behind]
            self._normals[here] = np.where(found.any(axis=2)[:, :, None], found, self._normals[here])

    def shade(
        self, origins: np.ndarray, directions: np.ndarray, daylight: Daylight, background: np.ndarray, rays: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Give the linear colour of rays, shape (N, 3), and whether they hit; `rays` go to the sky from each hit."""
        found = self._cast(origins, directions)
        triangle = found["primitive_ids"].numpy().astype(np.int64)
        distance = found["t_hit"].numpy().astype(np.float64)
        hit = np.isfinite(distance)
        colours = np.broadcast_to(background, (len(origins), 3)).copy()
        triangle, uv = triangle[hit], found["primitive_uvs"].numpy()[hit].astype(np.float64)
        shares = np.column_stack([1 - uv.sum(axis=1), uv])
        points = origins[hit] + distance[hit, None] * directions[hit]
        faces = self._faces[triangle]
        normals = _unit(np.einsum("nk,nkc->nc", shares, self._normals[triangle]))
        away = np.einsum("nc,nc->n", faces, directions[hit]) > 0
        normals[away] = -normals[away]
        faces = np.where(away[:, None], -faces, faces)
        starts = points + _AWAY * faces
        light = np.zeros((len(points), 3))
        if any(daylight.sun):
            sun = np.array(daylight.sun) / np.linalg.norm(daylight.sun)
            cosine = np.maximum(normals @ sun, 0) * (faces @ sun > 0)
            open_to = ~self._blocked(starts, np.broadcast_to(sun, starts.shape))
            light += (daylight.sun_light * cosine * open_to)[:, None]
        sky = np.zeros(len(points))
        random = np.random.default_rng(1)
        for _ in range(rays):
            way = normals + _unit(random.normal(size=starts.shape))  # distributed by the cosine
            way = _unit(way)
            lit = ~self._blocked(starts, way) & (np.einsum("nc,nc->n", way, faces) > 0)
            sky += lit * np.where(way[:, 1] > 0, 1.0, _GROUND)
        light += (sky / rays)[:, None] * np.array(daylight.sky)
        colours[hit] = self._albedo(triangle, shares) * light
        return colours, hit

    def _cast(self, origins: np.ndarray, directions: np.ndarray) -> dict:
        rays = np.concatenate([origins, directions], axis=1).astype(np.float32)
        return self._tracer.cast_rays(open3d.core.Tensor(rays))

    def _blocked(self, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
        rays = np.concatenate([origins, directions], axis=1).astype(np.float32)
        return self._tracer.test_occlusions(open3d.core.Tensor(rays), tnear=_LIFT).numpy()

    def _albedo(self, triangles: np.ndarray, shares: np.ndarray) -> np.ndarray:
        """Give the source's colour at points of triangles, linear."""
        table = linear_from_srgb(np.array([one.colour for one in self._scene.materials]))
        part = np.searchsorted(self._firsts, triangles, side="right") - 1
        found = np.zeros((len(triangles), 3))
        for number in np.unique(part).tolist():
            here = np.flatnonzero(part == number)
            mesh, local = self._parts[number].mesh, triangles[here] - self._parts[number].first
            own = shares[here][:, ::-1] if self._mirrored[number] else shares[here]
            found[here] = table[mesh.materials[local]]
            if mesh.appearance is not None:
                painted = mesh.appearance.rows[local] >= 0
                found[here[painted]] = sample(mesh.appearance, local[painted], own[painted])[:, :3]
        return found


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-30)
