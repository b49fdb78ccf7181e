"""The verilated ray tracer and the exact model: cameras, rendering, comparison."""

from importlib import import_module
from pkgutil import extend_path
from typing import TYPE_CHECKING

__path__ = extend_path(__path__, __name__)

__all__ = [
    "FACE_NONE",
    "Background",
    "CacheCost",
    "Camera",
    "Comparison",
    "Dram",
    "Engine",
    "EngineCheck",
    "Frame",
    "Lighting",
    "Likeness",
    "NoSuchConfigurationError",
    "PixelColour",
    "RayHits",
    "RayPath",
    "Reading",
    "RenderCost",
    "SimulatorError",
    "View",
    "camera_from_registers",
    "cast_rays",
    "check",
    "compare",
    "comparison_sheet",
    "explain_colour",
    "follow_pixel",
    "follow_ray",
    "frame_animation",
    "frame_points",
    "frame_scene",
    "look_at",
    "outline",
    "outline_frames",
    "peak_signal_to_noise",
    "pixel_directions",
    "render",
    "shader_features",
    "structural_similarity",
    "write_png",
]

# Imported when first used: a build without a preview renders nothing.
_HOMES = {
    "voxrt.octree.camera": (
        "Camera",
        "Lighting",
        "camera_from_registers",
        "frame_points",
        "look_at",
        "pixel_directions",
    ),
    "voxrt.sim.errors": ("NoSuchConfigurationError", "SimulatorError"),
    "voxrt.sim.external_memory": ("CacheCost", "Dram"),
    "voxrt.sim.frame": ("FACE_NONE", "Frame", "RenderCost"),
    "voxrt.sim.framing": ("frame_animation", "frame_scene", "outline", "outline_frames"),
    "voxrt.sim.hardware": ("shader_features",),
    "voxrt.sim.image": ("write_png",),
    "voxrt.sim.likeness": ("Comparison", "Likeness", "View", "compare", "comparison_sheet"),
    "voxrt.sim.pixel_colour": ("PixelColour", "explain_colour"),
    "voxrt.sim.path": ("RayPath", "Reading", "follow_pixel", "follow_ray"),
    "voxrt.sim.ray_query": ("RayHits", "cast_rays"),
    "voxrt.sim.rendering": ("Engine", "EngineCheck", "check", "render"),
    "voxrt.sim.samples": ("Background",),
    "voxrt.sim.similarity": ("peak_signal_to_noise", "structural_similarity"),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

if TYPE_CHECKING:  # type checkers see these names and no others
    from voxrt.octree.camera import (
        Camera,
        Lighting,
        camera_from_registers,
        frame_points,
        look_at,
        pixel_directions,
    )
    from voxrt.sim.errors import NoSuchConfigurationError, SimulatorError
    from voxrt.sim.external_memory import CacheCost, Dram
    from voxrt.sim.frame import FACE_NONE, Frame, RenderCost
    from voxrt.sim.framing import frame_animation, frame_scene, outline, outline_frames
    from voxrt.sim.hardware import shader_features
    from voxrt.sim.image import write_png
    from voxrt.sim.likeness import Comparison, Likeness, View, compare, comparison_sheet
    from voxrt.sim.path import RayPath, Reading, follow_pixel, follow_ray
    from voxrt.sim.pixel_colour import PixelColour, explain_colour
    from voxrt.sim.ray_query import RayHits, cast_rays
    from voxrt.sim.rendering import Engine, EngineCheck, check, render
    from voxrt.sim.samples import Background
    from voxrt.sim.similarity import peak_signal_to_noise, structural_similarity
else:

    def __getattr__(name: str) -> object:
        if name in _HOME:
            return getattr(import_module(_HOME[name]), name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
