"""voxrt: meshes to voxels to an octree memory to pictures ray-traced by hardware.

The front door. Each name is imported when it is first used, so that ``import voxrt`` and ``voxrt --help`` are instant::

    import voxrt

    result = voxrt.build("courtyard.glb", "out", depth=7, preview="out/courtyard.png")
    rom, warnings = voxrt.read_rom("out/courtyard.mem")
    frame = voxrt.render(rom, size=(640, 480), engine="model")

The stages behind it are packages of their own: :mod:`voxrt.voxelize`, :mod:`voxrt.octree`, :mod:`voxrt.export`,
:mod:`voxrt.sim`.
"""

import sys
from importlib import import_module
from pkgutil import extend_path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from voxrt.export import WRITABLE_SUFFIXES, convert, read_any, read_rom, rom_info
    from voxrt.fitting import BudgetFit, InteriorFit
    from voxrt.likeness_curve import LikenessAtDepth, draw_likeness_curve, likeness_curve
    from voxrt.octree import BOARDS, Octree, Region, Rom, RomError, diff, differing_regions
    from voxrt.octree.camera import Camera, Lighting
    from voxrt.outputs import OutputError
    from voxrt.pipeline import BuildResult, Picture, build, render, save_picture
    from voxrt.plain_verilog import ToolError
    from voxrt.sim import (
        Frame,
        NoSuchConfigurationError,
        SimulatorError,
        check,
        compare,
        comparison_sheet,
        shader_features,
    )
    from voxrt.view import ViewerError
    from voxrt.viewpoint import ViewpointError, aim_camera
    from voxrt.voxelize import AssetError, DoesNotFitError, Grid, Material, Scene, SceneWarning, fit_grid, load

# A checkout's Python and an installed wheel's extension modules make one package.
__path__ = extend_path(__path__, __name__)

__version__ = "0.1.0"

__all__ = [
    "BOARDS",
    "WRITABLE_SUFFIXES",
    "AssetError",
    "BudgetFit",
    "BuildResult",
    "Camera",
    "DoesNotFitError",
    "Frame",
    "Grid",
    "InteriorFit",
    "Lighting",
    "LikenessAtDepth",
    "Material",
    "NoSuchConfigurationError",
    "Octree",
    "OutputError",
    "Picture",
    "Region",
    "Rom",
    "RomError",
    "Scene",
    "SceneWarning",
    "SimulatorError",
    "ToolError",
    "ViewerError",
    "ViewpointError",
    "aim_camera",
    "build",
    "check",
    "compare",
    "comparison_sheet",
    "convert",
    "diff",
    "differing_regions",
    "draw_likeness_curve",
    "fit_grid",
    "likeness_curve",
    "load",
    "read_any",
    "read_rom",
    "render",
    "rom_info",
    "save_picture",
    "shader_features",
]

_HOMES = {
    "voxrt.export": ("WRITABLE_SUFFIXES", "convert", "read_any", "read_rom", "rom_info"),
    "voxrt.likeness_curve": ("LikenessAtDepth", "draw_likeness_curve", "likeness_curve"),
    "voxrt.octree": ("BOARDS", "Octree", "Region", "Rom", "RomError", "diff", "differing_regions"),
    "voxrt.octree.camera": ("Camera", "Lighting"),
    "voxrt.outputs": ("OutputError",),
    "voxrt.fitting": ("BudgetFit", "InteriorFit"),
    "voxrt.pipeline": ("BuildResult", "Picture", "build", "render", "save_picture"),
    "voxrt.plain_verilog": ("ToolError",),
    "voxrt.sim": (
        "Camera",
        "Frame",
        "NoSuchConfigurationError",
        "SimulatorError",
        "check",
        "compare",
        "comparison_sheet",
        "shader_features",
    ),
    "voxrt.view": ("ViewerError",),
    "voxrt.viewpoint": ("ViewpointError", "aim_camera"),
    "voxrt.voxelize": (
        "AssetError",
        "DoesNotFitError",
        "Grid",
        "Material",
        "Scene",
        "SceneWarning",
        "fit_grid",
        "load",
    ),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


if "IPython" in sys.modules:  # a notebook: it finds the cards on the values' classes
    import_module("voxrt.view.cards")
