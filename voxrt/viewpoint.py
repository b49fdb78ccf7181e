"""Where a camera stands when nobody says, or says only in part.

All cameras made here are right-handed, right = look x up, so that text in a scene reads correctly. Registers are small
integers; the camera is placed by the integers that the hardware will use, not by the real numbers they came from, so
that the picture is framed as promised.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.octree.camera import THREE_QUARTER, Camera, Lighting, eye_that_sees, focal_length, look_at
from voxrt.sim import frame_scene, outline

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from voxrt.octree import Rom
    from voxrt.octree.camera import Triple
    from voxrt.voxelize import Grid, Scene, Viewpoint

    Vector = NDArray[np.float64]

_BOUNCES = 4
"""How many mirrors a ray may meet where nobody says."""

_REGISTER = 2**15 - 1
_UP = np.array((0.0, 1.0, 0.0))
_BACK = np.array((0.0, 0.0, -1.0))


class ViewpointError(ValueError):
    """Camera registers that no camera can be derived from."""


def aim_camera(
    rom: Rom,
    size: tuple[int, int],
    *,
    position: Triple | None = None,
    look: Triple | None = None,
    right: Triple | None = None,
    up: Triple | None = None,
) -> Camera:
    """Complete a camera: what is given is kept, the rest frames the whole scene, upright and right-handed.

    Parameters
    ----------
    rom
        The scene.
    size
        Width and height of the picture, pixels.
    position
        1/16 voxel; without it the camera stands where the scene fills the picture.
    look, right, up
        Registers. `look` given alone is a direction, whose scale is chosen so that the angle of view is the default
        one; given with `right` or `up` it is kept as it is. Without `look` a given position looks at the scene's
        centre, and no position at all at the scene's front from a three-quarter view.

    Raises
    ------
    ViewpointError
        A register is zero where a direction is needed, or the registers lie in a plane and no position is given.
    """
    if position is None and (look, right, up) == (None, None, None):
        return frame_scene(rom, size)
    points = outline(rom.octree)
    if look is None or right is None or up is None:
        sight = np.array(THREE_QUARTER)
        if position is not None:
            towards = (points.min(axis=0) + points.max(axis=0)) / 2 - np.array(position) / 16
            sight = towards if towards.any() else sight
        look, right, up = _complete(_sight(sight, look, right, up), size, look, right, up)
    if position is None:
        registers = np.array((look, right, up), np.float64)
        if abs(np.linalg.det(registers)) < 1e-9:
            raise ViewpointError("look, right and up lie in a plane; give --position as well, or other registers")
        x, y, z = np.floor(16 * eye_that_sees(points, registers, size) + 0.5).astype(np.int64).tolist()
        position = (x, y, z)
    return Camera(position, look, right, up)


def authored_camera(viewpoint: Viewpoint, grid: Grid, size: tuple[int, int]) -> Camera:
    """Make the camera that stands where the scene's author wants it.

    Parameters
    ----------
    viewpoint
        In the scene frame.
    grid
        Where the voxels stand in the scene.
    size
        Width and height of the picture, pixels.

    Raises
    ------
    ViewpointError
        The eye is its own target, is straight above or below it, or is too far away for the registers.
    """
    eye, target = ((np.array(point) - grid.origin) / grid.voxel_size for point in (viewpoint.eye, viewpoint.target))
    wanted = {}
    if viewpoint.field_of_view is not None:
        # Theirs is from top to bottom, look_at's across the shorter side.
        height = 2 * np.tan(np.radians(viewpoint.field_of_view) / 2)
        wanted["field_of_view"] = float(np.degrees(2 * np.arctan(height * min(size) / size[1] / 2)))
    try:
        return look_at(eye, target, size=size, **wanted)
    except ValueError as error:
        raise ViewpointError(f"the scene's camera: {error}") from error


def authored_lighting(scene: Scene, grid: Grid) -> Lighting | None:
    """Make the shading that the scene's author wants: a light where it stands, mirrors where materials are some.

    Raises
    ------
    ViewpointError
        The light is too far away for the registers.
    """
    bounces = _BOUNCES if any(material.mirror for material in scene.materials) else 0
    if scene.light is None:
        return Lighting(bounces=bounces) if bounces else None
    place = np.floor(16 * (np.array(scene.light.position) - grid.origin) / grid.voxel_size + 0.5)
    if np.abs(place).max() >= 2**31:
        raise ViewpointError("the scene's light stands too far away; move it nearer")
    x, y, z = place.astype(np.int64).tolist()
    return Lighting((x, y, z), on=True, bounces=bounces)


def _sight(preferred: Vector, look: Triple | None, right: Triple | None, up: Triple | None) -> Vector:
    """Tell the unit direction to look in: the given one, else the preferred one made square to what is given."""
    if look is not None:
        return _unit(look, "look")
    if right is not None and up is not None:
        return _unit(np.cross(up, right), "up x right")
    given = up if right is None else right
    axis = np.zeros(3) if given is None else _unit(given, "up" if right is None else "right")
    return _unit(preferred - preferred @ axis * axis, "look")


def _complete(
    sight: Vector, size: tuple[int, int], look: Triple | None, right: Triple | None, up: Triple | None
) -> tuple[Triple, Triple, Triple]:
    """Give the missing registers the values of an upright right-handed camera that looks along `sight`."""
    given = up if right is None else right
    if given is None:  # look alone is a direction
        upright = _UP if abs(sight[1]) < 1 - 1e-9 else _BACK * np.sign(-sight[1])
        made = look_at(np.zeros(3), sight, size=size, up=upright)
        return made.look, made.right, made.up
    across = _unit(right if right is not None else np.cross(sight, given), "right" if right else "look x up")
    above = np.cross(across, sight)
    step = float(np.linalg.norm(given))
    reach = min(step * focal_length(size), _REGISTER / np.abs(sight).max())
    return (
        look or _register(sight * reach),
        right or _register(across * step),
        up or _register(above * step),
    )


def _unit(vector: ArrayLike, name: str) -> Vector:
    vector = np.asarray(vector, np.float64)
    length = float(np.linalg.norm(vector))
    if length < 1e-12:
        raise ViewpointError(f"{name} has no direction; give registers that are not zero and not parallel")
    return vector / length


def _register(vector: Vector) -> Triple:
    x, y, z = np.clip(np.floor(vector + 0.5), -_REGISTER, _REGISTER).astype(np.int64).tolist()
    if x == y == z == 0:
        raise ViewpointError("the given registers are too small or parallel to derive the others from; give all three")
    return (x, y, z)
