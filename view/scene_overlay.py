"""What the viewer shows of a scene beside its octants: its meshes, whose its voxels are, and the camera's rays."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.octree import Owners, build
from voxrt.octree.camera import Lighting
from voxrt.sim import follow_pixel, render
from voxrt.view.pane import DrawnRay, Preview
from voxrt.view.ray_table import HEADS, describe_end, describe_root, ray_table
from voxrt.voxelize import EMPTY, MATERIAL_LIMIT, DoesNotFitError, Material, voxelize

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree import Rom
    from voxrt.sim import Camera, RayPath
    from voxrt.voxelize import Grid, Scene

_COLUMNS = (0, 1, 2, 3, 7, 9)  # of the table, beside a picture
_MEANING_WIDTH = 26


def scene_triangles(scene: Scene, grid: Grid) -> NDArray[np.float64]:
    """Give a scene's triangles in grid space: float64, shape (T, 3, 3), voxels; counter-clockwise from outside."""
    triangles = [np.zeros((0, 3, 3))]
    for item in scene.objects:
        frame = item.transform[:3, :3]
        corners = item.mesh.positions[item.mesh.triangles] @ frame.T + item.transform[:3, 3]
        corners = corners[:, ::-1] if np.linalg.det(frame) < 0 else corners  # a mirror turns their order around
        triangles.append((corners - grid.origin) / grid.voxel_size)
    return np.concatenate(triangles)


def find_owners(scene: Scene, grid: Grid) -> Owners:
    """Tell whose each voxel of a scene is: voxelize it once more, with a material per object.

    DoesNotFitError for more objects than there are material ids.
    """
    if len(scene.objects) > MATERIAL_LIMIT:
        raise DoesNotFitError(
            f"{scene.name}: owners can be told of {MATERIAL_LIMIT} objects, not of {len(scene.objects)}; "
            "colour by material"
        )
    names = tuple(item.name for item in scene.objects)
    owned = [
        replace(
            item,
            mesh=replace(
                item.mesh,
                materials=np.full(len(item.mesh.triangles), number, np.uint8),
                appearance=None,
                material_map=None,
            ),
            collider_material=number,
        )
        for number, item in enumerate(scene.objects, 1)
    ]
    materials = (EMPTY, *(Material(name, (0, 0, 0)) for name in names))
    return Owners(build(voxelize(replace(scene, objects=tuple(owned), materials=materials), grid).voxels), names)


def preview_of(
    rom: Rom, camera: Camera, size: tuple[int, int], pixel: tuple[int, int], *, flat: bool = False
) -> Preview:
    """Return a memory's picture, in which a pixel can be chosen to see its ray; `flat` shows materials as they are.

    SimulatorError where the camera's directions are too large.
    """

    def follow(pixel: tuple[int, int]) -> DrawnRay:
        return drawn_ray(rom, follow_pixel(rom.octree, camera, size, pixel), pixel)

    lighting = Lighting(flat=flat)
    return Preview(render(rom, camera, size, engine="model", lighting=lighting).colour, pixel, follow)


def drawn_ray(rom: Rom, path: RayPath, pixel: tuple[int, int]) -> DrawnRay:
    """Give a ray as the viewer draws it: what lies far outside the world is left out."""
    side = rom.octree.size
    points = np.array([path.point(reading.time) for reading in path.readings]).reshape(-1, 3)
    along = np.array(path.direction, np.float64)
    along = along / max(float(np.linalg.norm(along)), 1.0)
    eye = np.array(path.origin) / 16
    if len(points):
        start = points[0] - along * min(float(np.linalg.norm(points[0] - eye)), side / 4)
        end = points[-1] if path.cell else _way_out(points[-1], along, side)
    else:  # past the world
        start, end = eye, eye + along * side
    x, y, z = start.tolist()
    end_x, end_y, end_z = end.tolist()
    rows = [tuple(row[column] for column in _COLUMNS) for row in [HEADS, *ray_table(rom, path)]]
    widths = [max(len(row[column]) for row in rows) for column in range(len(_COLUMNS) - 1)]
    lines = [
        " ".join((*(cell.rjust(wide) for cell, wide in zip(row, widths, strict=False)), row[-1][:_MEANING_WIDTH]))
        for row in rows
    ]
    table = (
        f"pixel {pixel[0]},{pixel[1]}: {len(path.readings)} words",
        f"hits {describe_end(rom, path)}",
        describe_root(rom, path).split(";")[0],
        "",
    )
    return DrawnRay(
        start=(x, y, z),
        end=(end_x, end_y, end_z),
        corners=np.array([reading.corner for reading in path.readings], np.int64).reshape(-1, 3),
        levels=np.array([reading.level for reading in path.readings], np.int64),
        words=np.array([reading.word for reading in path.readings], np.uint32),
        points=points,
        table=(*table, *lines),
    )


def _way_out(point: NDArray[np.float64], along: NDArray[np.float64], side: int) -> NDArray[np.float64]:
    """Follow a ray from within the world to its end."""
    moving = along != 0
    if not moving.any():
        return point
    walls = np.where(along > 0, side, 0)[moving]
    return point + along * float(np.min((walls - point[moving]) / along[moving]))
