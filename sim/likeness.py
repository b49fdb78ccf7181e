"""Voxels compared with the meshes that they were made from: two pictures from the same camera.

The meshes are ray-cast by Open3D (Intel Embree), an optional dependency: ``pip install open3d``. Both
sides use the same rays, in voxels, and the same shading rule, so that only the geometry differs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.octree.camera import POSITION_UNITS, pixel_directions
from voxrt.sim import _model
from voxrt.sim.engine_arguments import palette_of, registers_of
from voxrt.sim.errors import SimulatorError
from voxrt.sim.frame import FACE_NONE
from voxrt.sim.similarity import peak_signal_to_noise, structural_similarity
from voxrt.voxelize.colour.appearance import sample
from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree import Rom
    from voxrt.octree.camera import Camera
    from voxrt.voxelize import Grid, Scene, SurfaceAppearance


class View(Value, frozen=True, eq=False):
    """What the camera sees of the meshes, or of the voxels.

    Attributes
    ----------
    colour
        uint8, shape (H, W, 3), sRGB.
    depth
        float64, shape (H, W): voxels from the camera along the ray; infinite for a miss.
    normal
        float64, shape (H, W, 3): unit vectors towards the camera; zero for a miss and inside a solid.
    """

    colour: NDArray[np.uint8]
    depth: NDArray[np.float64]
    normal: NDArray[np.float64]


class Likeness(Value, frozen=True):
    """The similarity of meshes and voxels. NaN if nothing is seen that could be compared.

    Attributes
    ----------
    silhouette_iou
        Intersection over union of the silhouettes: pixels covered in both pictures, divided by those covered in either.
    depth_mean, depth_median, depth_95
        Mean, median and 95th percentile of the distance between the two surfaces along the ray, in voxels, over the
        pixels covered in both.
    normal_cosine
        Mean cosine between the normals, over the same pixels.
    normal_agreement
        Share of these pixels whose voxel face has the axis that is nearest to the normal of the mesh.
    psnr, ssim
        PSNR (decibel) and SSIM (1 for equal pictures) of the colours, over the whole frame.
    """

    silhouette_iou: float
    depth_mean: float
    depth_median: float
    depth_95: float
    normal_cosine: float
    normal_agreement: float
    psnr: float
    ssim: float


class Comparison(Value, frozen=True, eq=False):
    """What one camera sees of the meshes and of the voxels, and their similarity, as :func:`compare` returns it."""

    meshes: View
    voxels: View
    likeness: Likeness


def compare(scene: Scene, rom: Rom, camera: Camera, size: tuple[int, int]) -> Comparison:
    """Compare a memory with the meshes that it was made from.

    Parameters
    ----------
    scene
        The source. All triangles are cast, also those of objects that were voxelized from colliders.
    rom
        The memory, with its grid.
    camera
        The camera.
    size
        Columns and rows.

    Returns
    -------
    Comparison
        Both pictures and their similarity.

    Raises
    ------
    SimulatorError
        Open3D is not installed, the memory has no place in the scene, or the scene has points in place of triangles.

    Examples
    --------
    >>> import voxrt
    >>> built = voxrt.build("examples/house.obj", depth=6)
    >>> found = compare(built.scene, built.rom, voxrt.aim_camera(built.rom, (64, 48)), (64, 48))
    >>> found.likeness.silhouette_iou > 0.8
    True
    """
    if rom.grid is None:
        raise SimulatorError(f"{rom.name} does not say where it stands in its scene; build it anew, with a manifest")
    if any(item.points is not None for item in scene.objects):
        raise SimulatorError(
            f"{scene.name} has points, and memories are compared with triangles; compare one with a mesh"
        )
    directions = pixel_directions(camera, size).astype(np.float64)
    background = np.array(rom.materials[0].colour, dtype=np.uint8)
    meshes = _view_meshes(scene, rom.grid, camera, directions, background)
    voxels = _view_voxels(rom, camera, directions)
    return Comparison(meshes, voxels, _likeness(meshes, voxels))


def comparison_sheet(comparison: Comparison, hardware: NDArray[np.uint8] | None = None) -> NDArray[np.uint8]:
    """Place the pictures of a comparison side by side.

    Parameters
    ----------
    comparison
        The pictures of the meshes and of the voxels, the latter by the exact model.
    hardware
        uint8, shape (H, W, 3): the voxels by the simulated hardware; None leaves it out.

    Returns
    -------
    NDArray[np.uint8]
        Shape (H, 3 W or 4 W, 3): meshes, hardware if given, model, and the difference of meshes and model, which is
        black where they agree.

    Examples
    --------
    >>> import voxrt
    >>> built = voxrt.build("examples/house.obj", depth=5)
    >>> found = compare(built.scene, built.rom, voxrt.aim_camera(built.rom, (64, 48)), (64, 48))
    >>> comparison_sheet(found).shape
    (48, 192, 3)
    """
    meshes, voxels = comparison.meshes.colour, comparison.voxels.colour
    difference = np.abs(meshes.astype(np.int16) - voxels.astype(np.int16)).astype(np.uint8)
    traced = [voxels] if hardware is None else [hardware, voxels]
    return np.concatenate([meshes, *traced, difference], axis=1)


def _view_meshes(
    scene: Scene, grid: Grid, camera: Camera, directions: NDArray[np.float64], background: NDArray[np.uint8]
) -> View:
    open3d = _open3d()
    caster = open3d.t.geometry.RaycastingScene()
    first_triangle, colours, appearances = [], [], []
    count = 0
    palette = np.array([material.colour for material in scene.materials], dtype=np.float64)
    for item in scene.objects:
        mesh = item.mesh
        placed = mesh.positions @ item.transform[:3, :3].T + item.transform[:3, 3]
        voxels = (placed - np.array(grid.origin)) / grid.voxel_size
        if not len(mesh.triangles):
            continue
        caster.add_triangles(
            open3d.core.Tensor(voxels.astype(np.float32)), open3d.core.Tensor(mesh.triangles.astype(np.uint32))
        )
        first_triangle.append(count)
        colours.append(palette[mesh.materials])
        appearances.append(mesh.appearance)
        count += len(mesh.triangles)

    length = np.linalg.norm(directions, axis=-1)
    # The caster counts distances in the length of the direction: unit ones give voxels.
    unit = directions / np.where(length > 0, length, 1)[..., None]
    origins = np.broadcast_to(np.array(camera.position) / POSITION_UNITS, directions.shape)
    cast = caster.cast_rays(open3d.core.Tensor(np.concatenate([origins, unit], axis=-1).astype(np.float32)))
    depth = cast["t_hit"].numpy().astype(np.float64)
    normal = cast["primitive_normals"].numpy().astype(np.float64)
    seen = np.isfinite(depth)
    normal[~seen] = 0
    # Meshes are seen from both sides.
    cosine = np.sum(normal * unit, axis=-1)
    normal *= np.where(cosine > 0, -1, 1)[..., None]

    colour = np.broadcast_to(background, directions.shape).copy()
    if np.any(seen):
        part, triangle = cast["geometry_ids"].numpy()[seen], cast["primitive_ids"].numpy()[seen].astype(np.intp)
        own = np.concatenate(colours)[np.array(first_triangle)[part] + triangle]
        _paint(own, appearances, part, triangle, cast["primitive_uvs"].numpy()[seen].astype(np.float64))
        colour[seen] = np.floor(own * cosine[seen][:, None] ** 2 + 0.5).astype(np.uint8)
    return View(colour, depth, normal)


def _paint(
    colours: NDArray[np.float64],
    appearances: list[SurfaceAppearance | None],
    part: NDArray[np.uint32],
    triangle: NDArray[np.intp],
    shares: NDArray[np.float64],
) -> None:
    """Replace the colours of hits on painted triangles; `shares` are those of the triangles' other two corners."""
    for number, appearance in enumerate(appearances):
        if appearance is None:
            continue
        here = np.flatnonzero(part == number)
        here = here[appearance.rows[triangle[here]] >= 0]
        weights = np.column_stack([1 - shares[here].sum(axis=1), shares[here]])
        colours[here] = srgb_from_linear(sample(appearance, triangle[here], weights)[:, :3])


def _view_voxels(rom: Rom, camera: Camera, directions: NDArray[np.float64]) -> View:
    height, width = directions.shape[:2]
    flat = directions.reshape(-1, 3)
    origins = np.broadcast_to(np.array(camera.position, dtype=np.int32), flat.shape)
    memory = _model.Memory(rom.octree.words, rom.octree.depth)
    hits = memory.trace(np.ascontiguousarray(origins), flat.astype(np.int32))
    axis = np.minimum(hits.face, 2)[:, None].astype(np.int64)
    lateral = np.take_along_axis(flat, axis, 1)[:, 0]
    # The plane crossed is the near one of the cell hit.
    plane = np.take_along_axis(hits.cell, axis, 1)[:, 0] + (lateral < 0)
    start = np.array(camera.position)[axis[:, 0]] / POSITION_UNITS
    crossed = hits.face != FACE_NONE
    parameter = np.where(crossed, (plane - start) / np.where(crossed, lateral, 1), 0)
    depth = np.where(hits.material > 0, parameter * np.linalg.norm(flat, axis=1), np.inf)
    normal = np.zeros_like(flat)
    np.put_along_axis(normal, axis, np.where(crossed, -np.sign(lateral), 0)[:, None], 1)
    colour = memory.render(palette_of(rom.materials), registers_of(camera), width, height).colour
    return View(colour, depth.reshape(height, width), normal.reshape(height, width, 3))


def _likeness(meshes: View, voxels: View) -> Likeness:
    on_mesh, on_voxel = np.isfinite(meshes.depth), np.isfinite(voxels.depth)
    both, either = on_mesh & on_voxel, on_mesh | on_voxel
    apart = np.abs(meshes.depth[both] - voxels.depth[both])
    faced = both & np.any(voxels.normal != 0, axis=-1)
    cosine = np.sum(meshes.normal[faced] * voxels.normal[faced], axis=-1)
    nearest = np.argmax(np.abs(meshes.normal[faced]), axis=-1) == np.argmax(np.abs(voxels.normal[faced]), axis=-1)
    nothing = float("nan")
    return Likeness(
        silhouette_iou=float(both.sum() / either.sum()) if either.any() else nothing,
        depth_mean=float(apart.mean()) if both.any() else nothing,
        depth_median=float(np.median(apart)) if both.any() else nothing,
        depth_95=float(np.percentile(apart, 95)) if both.any() else nothing,
        normal_cosine=float(cosine.mean()) if faced.any() else nothing,
        normal_agreement=float(nearest.mean()) if faced.any() else nothing,
        psnr=peak_signal_to_noise(meshes.colour, voxels.colour),
        ssim=structural_similarity(meshes.colour, voxels.colour),
    )


def _open3d() -> Any:  # noqa: ANN401 - Open3D has no types
    try:
        import open3d  # noqa: PLC0415 - 900 MB that few need
    except ModuleNotFoundError as error:
        raise SimulatorError(
            "comparing with the source meshes needs Open3D, which is not installed; pip install open3d"
        ) from error
    except ImportError as error:
        raise SimulatorError(f"Open3D cannot be loaded: {error}; on Debian: apt install libegl1 libgl1") from error
    return open3d
