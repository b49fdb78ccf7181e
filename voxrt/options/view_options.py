"""What several commands take to look at a memory: the camera and the light."""

from __future__ import annotations

from typing import Literal

from voxrt.options import notations
from voxrt.options.kinds import INTEGER, one_of
from voxrt.options.option import OptionTable, option
from voxrt.options.shared import Triple

CAMERA, LIGHT = "Camera", "Light and shading"


# A table: an option is its kind, its default and its group, then its text.
# fmt: off
class CameraOptions(OptionTable, frozen=True, kw_only=True):
    """The camera. What is not given is chosen to show the whole scene."""

    position: Triple | None = option(notations.PLACE, None, CAMERA,
        "Position of the camera in voxels, in steps of 1/16. The default shows the whole scene.",
        details="It may lie outside the scene.")
    look: Triple | None = option(notations.REGISTER, None, CAMERA,
        "Register: direction of the centre of the picture. The default looks at the scene.",
        details="Without {right} and {up}, its length does not matter.")
    right: Triple | None = option(notations.REGISTER, None, CAMERA,
        "Register: step of the direction from a pixel to its right neighbour. The default is look x up.",
        is_rare=True)
    up: Triple | None = option(notations.REGISTER, None, CAMERA,
        "Register: step of the direction from a pixel to the one above it. The default is upright.", is_rare=True)


class LightOptions(OptionTable, frozen=True, kw_only=True):
    """The light of a picture. What is not given is that of the memory."""

    light: Triple | None = option(notations.PLACE, None, LIGHT,
        "Position of a light that casts shadows, in voxels. The default is the light of the memory, if it has one.",
        details="Steps are of 1/16 voxel.")
    ambient: int | None = option(INTEGER, None, LIGHT,
        "The brightness of shadows, 0 to 255. The default is 90.", is_rare=True)
    bounces: int | None = option(INTEGER, None, LIGHT,
        "The most reflections of a ray by mirrors, 0 to 15. With 0, mirrors are like other materials. The default "
        "is that of the memory, or 0.", is_rare=True)
    shading: Literal["faces", "report", "flat"] | None = option(one_of(("faces", "report", "flat")), None, LIGHT,
        "What brightness depends on: the side of a block, an angle, or nothing. The default is that of the memory, "
        "or faces.",
        details="faces: each side of a block has its own; the top is the brightest. report: the angle to the "
        "camera or to the light, as in the report on the original hardware. flat: materials show their own colour.")
