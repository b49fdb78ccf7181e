"""Cameras from all, some or no registers, around a scene, and the author's camera and light.

All cameras made here are right-handed, right = look x up, so that text in a scene reads correctly. Registers are small
integers. The position is computed from these integers, not from the real numbers before rounding, so that the scene
fits the picture exactly.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from voxrt import octree, sim
from voxrt.octree import Rom
from voxrt.octree.camera import THREE_QUARTER, Camera, Lighting, eye_that_sees, focal_length, look_at
from voxrt.voxelize.arguments import instance, whole, whole_array

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from voxrt.octree.camera import Triple
    from voxrt.voxelize import Grid, Scene, Viewpoint

    Vector = NDArray[np.float64]

_BOUNCES = 4
"""Default number of reflections in a scene with mirrors."""

_REGISTER = 2**15 - 1
_UP = np.array((0.0, 1.0, 0.0))
_BACK = np.array((0.0, 0.0, -1.0))


class ViewpointError(ValueError):
    """Registers from which no camera can be derived."""


def aim_camera(
    rom: Rom,
    size: tuple[int, int],
    *,
    position: Triple | None = None,
    look: Triple | None = None,
    right: Triple | None = None,
    up: Triple | None = None,
) -> Camera:
    """Complete a camera: given registers are kept, the others show the whole scene, upright and right-handed.

    Parameters
    ----------
    rom
        The scene.
    size
        Width and height of the picture, pixels.
    position
        Integers, 1/16 voxel. None places the camera where the scene fills the picture.
    look, right, up
        Integers, signed 16 bit. `look` alone is a direction of any length; the angle of view is the default one. With
        `right` or `up`, `look` is kept as it is. Without `look`, the camera looks at the centre of the scene, or if
        there is no position either, at its front from the right and above.

    Returns
    -------
    Camera
        All four registers.

    Raises
    ------
    TypeError, ValueError
        An argument is not of the right type, or not made of integers.
    ViewpointError
        A register is zero where a direction is needed, or the registers lie in a plane and no position is given.

    Examples
    --------
    >>> import voxrt
    >>> rom = voxrt.build("examples/house.obj", depth=4).rom
    >>> aim_camera(rom, (64, 48), position=(128, 128, 800), look=(0, 0, -1)).look[:2]
    (0, 0)
    """
    return CameraAim(rom, size).camera(position=position, look=look, right=right, up=up)


class CameraAim:
    """Completes cameras of one scene as :func:`aim_camera` does, and looks at the scene once for all of them."""

    def __init__(self, rom: Rom, size: tuple[int, int]) -> None:
        self._rom = instance("rom", rom, Rom)
        width, height = whole_array("size", size, (2,), np.int64, low=1, high=1 << 14).tolist()
        self._size = (width, height)

    @cached_property
    def _outline(self) -> NDArray[np.float64]:
        return sim.outline(self._rom.octree)

    @cached_property
    def _centre(self) -> NDArray[np.float64]:
        centre: NDArray[np.float64] = (self._outline.min(axis=0) + self._outline.max(axis=0)) / 2
        return centre

    @cached_property
    def _whole_scene(self) -> Camera:
        return sim.frame_points(self._outline, self._size)

    def camera(
        self,
        *,
        position: Triple | None = None,
        look: Triple | None = None,
        right: Triple | None = None,
        up: Triple | None = None,
    ) -> Camera:
        """Complete a camera; :func:`aim_camera` says how, and which errors there are."""
        position = _triple("position", position, 1 << 31)
        look, right, up = _triple("look", look), _triple("right", right), _triple("up", up)
        if position is None and (look, right, up) == (None, None, None):
            return self._whole_scene
        if look is None or right is None or up is None:
            sight = np.array(THREE_QUARTER)
            if position is not None:
                towards = self._centre - np.array(position) / 16
                sight = towards if towards.any() else sight
            look, right, up = _complete(_sight(sight, look, right, up), self._size, look, right, up)
        if position is None:
            registers = np.array((look, right, up), np.float64)
            if abs(np.linalg.det(registers)) < 1e-9:
                raise ViewpointError("look, right and up lie in a plane; give --position as well, or other registers")
            x, y, z = np.floor(16 * eye_that_sees(self._outline, registers, self._size) + 0.5).astype(np.int64).tolist()
            position = (x, y, z)
        return Camera(position, look, right, up)


def authored_camera(viewpoint: Viewpoint, grid: Grid, size: tuple[int, int]) -> Camera:
    """Make the camera of the scene's author (scene frame) for pictures of `size` pixels, on a grid.

    ViewpointError if it is too far away for the registers, or its `up` points along the line of sight.

    Examples
    --------
    A camera that looks straight down has the scene's -z axis at the top of its picture, as a map:

    >>> from voxrt.voxelize import Grid, Viewpoint
    >>> camera = authored_camera(Viewpoint((4, 9, 4), (4, 0, 4)), Grid(3, (0, 0, 0), 1.0), (64, 48))
    >>> camera.look[:1], camera.up[0], camera.up[2] < 0
    ((0,), 0, True)
    """
    eye, target = ((np.array(point) - grid.origin) / grid.voxel_size for point in (viewpoint.eye, viewpoint.target))
    wanted: dict[str, float] = {}
    if viewpoint.field_of_view is not None:
        # Theirs is from top to bottom, look_at's across the shorter side.
        height = 2 * np.tan(np.radians(viewpoint.field_of_view) / 2)
        wanted["field_of_view"] = float(np.degrees(2 * np.arctan(height * min(size) / size[1] / 2)))
    up = _upright(_unit(target - eye, "the line of sight")) if viewpoint.up is None else np.array(viewpoint.up)
    try:
        shift = np.array(viewpoint.shift) * size[1]
        return look_at(eye, target, size=size, up=up, shift=shift, **wanted)
    except ValueError as error:
        raise ViewpointError(f"the scene's camera: {error}") from error


def orbit(rom: Rom, size: tuple[int, int], count: int = 128, *, roots: Sequence[int] = (0,)) -> list[Camera]:
    """Make cameras on a circle around a scene: the default view, turned about the vertical in equal steps.

    The first camera sees the upright cylinder around the scene, so the scene fits each picture; so do all frames of an
    animation, whose `roots` are given. The cameras, 1 ... 4096, are counterclockwise, seen from above. TypeError or
    ValueError where an argument is of the wrong type or out of range.

    Examples
    --------
    >>> import voxrt
    >>> rom = voxrt.build("examples/house.obj", depth=4).rom
    >>> cameras = orbit(rom, (640, 480), 4)
    >>> cameras[0].position[1] == cameras[2].position[1], cameras[0].look == cameras[2].look
    (True, False)
    """
    from voxrt.sim import _model  # noqa: PLC0415 - builds do without

    instance("rom", rom, Rom)
    count = whole("count", count, 1, 4096)
    width, height = whole_array("size", size, (2,), np.int64, low=1, high=1 << 14).tolist()
    points = sim.outline(rom.octree) if len(roots) == 1 else sim.outline_frames(rom.octree, roots)
    return [
        Camera(*(tuple(triple) for triple in registers))
        for registers in _model.orbit(points, width, height, count).tolist()
    ]


def stands_inside(rom: Rom, camera: Camera) -> bool:
    """Tell whether a camera stands inside a solid voxel: its picture would show nothing else."""
    return bool(octree.material_at(rom.octree, [[place >> 4 for place in camera.position]])[0])


def authored_lighting(scene: Scene, grid: Grid) -> Lighting | None:
    """Make the lighting of the scene's author: the light if there is one, mirrors if materials are mirrors.

    ViewpointError if the light is too far away for the registers.
    """
    bounces = _BOUNCES if any(material.mirror for material in scene.materials) else 0
    if scene.light is None:
        return Lighting(bounces=bounces) if bounces else None
    place = np.floor(16 * (np.array(scene.light.position) - grid.origin) / grid.voxel_size + 0.5)
    if np.abs(place).max() >= 2**31:
        raise ViewpointError("the scene's light stands too far away; move it nearer")
    x, y, z = place.astype(np.int64).tolist()
    return Lighting((x, y, z), on=True, bounces=bounces)


def _triple(name: str, value: Triple | None, limit: int = _REGISTER + 1) -> Triple | None:
    """Return three integers of a register; None stays."""
    if value is None:
        return None
    x, y, z = whole_array(name, value, (3,), np.int64, low=-limit, high=limit - 1).tolist()
    return (x, y, z)


def _sight(preferred: Vector, look: Triple | None, right: Triple | None, up: Triple | None) -> Vector:
    """Return the unit look: the given one, else the preferred one made perpendicular to the given registers."""
    if look is not None:
        return _unit(look, "look")
    if right is not None and up is not None:
        return _unit(np.cross(up, right), "up x right")
    register = up if right is None else right
    axis = np.zeros(3) if register is None else _unit(register, "up" if right is None else "right")
    return _unit(preferred - preferred @ axis * axis, "look")


def _complete(
    sight: Vector, size: tuple[int, int], look: Triple | None, right: Triple | None, up: Triple | None
) -> tuple[Triple, Triple, Triple]:
    """Return all registers: missing ones as of an upright right-handed camera that looks along `sight`."""
    register = up if right is None else right
    if register is None:  # look alone is a direction
        made = look_at(np.zeros(3), sight, size=size, up=_upright(sight))
        return made.look, made.right, made.up
    across = _unit(right if right is not None else np.cross(sight, register), "right" if right else "look x up")
    above = np.cross(across, sight)
    step = float(np.linalg.norm(register))
    reach = min(step * focal_length(size), _REGISTER / np.abs(sight).max())
    return (look or _register(sight * reach), right or _register(across * step), up or _register(above * step))


def _upright(sight: Vector) -> Vector:
    """Return what points up in the picture of a camera along a unit vector: y, or -z or z along a vertical one."""
    return _UP if abs(sight[1]) < 1 - 1e-9 else _BACK * np.sign(-sight[1])


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
