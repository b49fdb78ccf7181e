"""The verilated ray tracer and the exact model: cameras, rendering, comparison."""

from pkgutil import extend_path

__path__ = extend_path(__path__, __name__)

from voxrt.sim.bounds import solid_bounds
from voxrt.sim.camera import Camera, camera_from_registers, frame_box, frame_scene, look_at, pixel_directions
from voxrt.sim.errors import SimulatorError
from voxrt.sim.frame import FACE_NONE, Frame, RenderCost
from voxrt.sim.image import write_png
from voxrt.sim.render import Engine, EngineCheck, check, render

__all__ = [
    "FACE_NONE",
    "Camera",
    "Engine",
    "EngineCheck",
    "Frame",
    "RenderCost",
    "SimulatorError",
    "camera_from_registers",
    "check",
    "frame_box",
    "frame_scene",
    "look_at",
    "pixel_directions",
    "render",
    "solid_bounds",
    "write_png",
]
