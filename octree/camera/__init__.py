"""What a picture of an octree needs besides its words: a camera and the lighting, in the grid frame."""

from voxrt.octree.camera.aim import (
    FIELD_OF_VIEW,
    THREE_QUARTER,
    eye_that_sees,
    focal_length,
    frame_points,
    frame_world,
    look_at,
    refit,
)
from voxrt.octree.camera.camera import (
    DIRECTION_LIMIT,
    POSITION_UNITS,
    Camera,
    Triple,
    camera_from_registers,
    pixel_directions,
)
from voxrt.octree.camera.lighting import BOUNCE_LIMIT, FACES, FEATURES, PLAIN_LIGHTING, Faces, Lighting, Shading
from voxrt.octree.camera.lod import LOD_SCALE_BITS, lod_scale
from voxrt.octree.camera.samples import SAMPLES, average_cut_out, average_samples, sample_cameras

__all__ = [
    "BOUNCE_LIMIT",
    "DIRECTION_LIMIT",
    "FACES",
    "FEATURES",
    "FIELD_OF_VIEW",
    "LOD_SCALE_BITS",
    "PLAIN_LIGHTING",
    "POSITION_UNITS",
    "SAMPLES",
    "THREE_QUARTER",
    "Camera",
    "Faces",
    "Lighting",
    "Shading",
    "Triple",
    "average_cut_out",
    "average_samples",
    "camera_from_registers",
    "eye_that_sees",
    "focal_length",
    "frame_points",
    "frame_world",
    "lod_scale",
    "look_at",
    "pixel_directions",
    "refit",
    "sample_cameras",
]
