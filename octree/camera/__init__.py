"""What a picture of an octree needs besides its words: a camera and the lighting, in the grid frame.

Needs NumPy and Python 3.10 alone: the boards' own package takes this folder too.
"""

from .aim import FIELD_OF_VIEW, THREE_QUARTER, eye_that_sees, focal_length, frame_points, frame_world, look_at, refit
from .camera import DIRECTION_LIMIT, POSITION_UNITS, Camera, Triple, camera_from_registers, pixel_directions
from .lighting import BOUNCE_LIMIT, CAMERA_LIGHT, FEATURES, Lighting

__all__ = [
    "BOUNCE_LIMIT",
    "CAMERA_LIGHT",
    "DIRECTION_LIMIT",
    "FEATURES",
    "FIELD_OF_VIEW",
    "POSITION_UNITS",
    "THREE_QUARTER",
    "Camera",
    "Lighting",
    "Triple",
    "camera_from_registers",
    "eye_that_sees",
    "focal_length",
    "frame_points",
    "frame_world",
    "look_at",
    "pixel_directions",
    "refit",
]
