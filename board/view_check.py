"""The check of a view before a device renders it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.board.errors import Refused
from voxrt.octree.camera import DIRECTION_LIMIT

if TYPE_CHECKING:
    from voxrt.board.device import Identity
    from voxrt.board.view import View


def check_view(view: View, identity: Identity) -> None:
    """Refuse a view that the device cannot render.

    Raises
    ------
    Refused
        The frame is too large or has an unsupported width, the camera or the light is too far away, a direction is too
        long, or the device lacks a feature.
    """
    columns, rows = view.size
    if columns > identity.size[0] or rows > identity.size[1]:
        raise Refused(
            f"{columns}x{rows} pixels are more than {identity.name} renders: {identity.size[0]}x{identity.size[1]}; "
            "choose a smaller size"
        )
    if columns % identity.width_step:
        raise Refused(
            f"{columns} columns are no multiple of {identity.width_step}, which {identity.name} needs; change the size"
        )
    missing = view.lighting.features - identity.features
    if missing:
        raise Refused(f"{identity.name} has no {', '.join(sorted(missing))}; switch it off")
    for name, position in (("camera", view.camera.position), ("light", view.lighting.position)):
        if not all(-identity.position_limit <= value < identity.position_limit for value in position):
            limit = identity.position_limit // 16
            raise Refused(f"the {name} is more than {limit} voxels from the corner of the world; move it closer")
    longest = max(_longest(view, axis) for axis in range(3))
    if longest >= DIRECTION_LIMIT:
        raise Refused(
            f"the camera's directions reach {longest} at the frame's corners, which is not below {DIRECTION_LIMIT}; "
            "scale look, right and up down together"
        )


def _longest(view: View, axis: int) -> int:
    # Directions are linear in the pixel, so the largest ones are in the corners of the frame.
    columns, rows = view.size
    camera = view.camera
    return max(
        abs(camera.look[axis] + camera.right[axis] * column + camera.up[axis] * row)
        for column in (-(columns // 2), columns - 1 - columns // 2)
        for row in (rows // 2, rows // 2 - rows + 1)
    )
