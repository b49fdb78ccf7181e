"""The verilated ray tracer and the exact model: cameras, rendering, comparison."""

from pkgutil import extend_path

__path__ = extend_path(__path__, __name__)

from voxrt.sim.camera import Camera
from voxrt.sim.errors import SimulatorError
from voxrt.sim.frame import FACE_NONE, Frame, RenderCost

__all__ = ["FACE_NONE", "Camera", "Frame", "RenderCost", "SimulatorError"]
