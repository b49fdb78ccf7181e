"""voxrt: meshes to voxels to an octree memory to pictures ray-traced by hardware.

The front door. Each name is imported when it is first used, so ``import voxrt`` and ``voxrt --help`` are instant::

    import voxrt

    result = voxrt.build("courtyard.glb", "out", depth=7, preview="out/courtyard.png")
    rom, warnings = voxrt.read_rom("out/courtyard.mem")
    frame = voxrt.render(rom, size=(640, 480), engine="model")

The stages behind it are packages of their own: :mod:`voxrt.voxelize`, :mod:`voxrt.octree`, :mod:`voxrt.export`,
:mod:`voxrt.sim`, :mod:`voxrt.view`.
"""

import os
import sys
from importlib import import_module

TYPE_CHECKING = False  # typing and pkgutil are slow to import: until then Ctrl-C prints a traceback

# A checkout's Python and an installed wheel's extension modules make one package.
__path__ += [
    folder
    for folder in (f"{entry}{os.sep}voxrt" for entry in sys.path if entry)
    if folder not in __path__ and os.path.isdir(folder)  # noqa: PTH112 - pathlib is slow to import as well
]

__version__ = "0.2.0"

__all__ = [
    "BOARDS",
    "WRITABLE_SUFFIXES",
    "AssetError",
    "Bake",
    "BudgetFit",
    "BuildOptions",
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
    "RayHits",
    "RayPath",
    "Region",
    "RenderOptions",
    "Rom",
    "RomError",
    "Scene",
    "SceneWarning",
    "SimulatorError",
    "ToolError",
    "ViewerError",
    "ViewpointError",
    "aim_camera",
    "animation_camera",
    "board",
    "build",
    "build_animation",
    "cast_rays",
    "check",
    "compare",
    "comparison_sheet",
    "convert",
    "diff",
    "differing_regions",
    "draw_likeness_curve",
    "export",
    "fit_grid",
    "follow_ray",
    "frame_times",
    "likeness_curve",
    "load",
    "mesh_scene",
    "octree",
    "read_any",
    "read_rom",
    "render",
    "rom_info",
    "save_animation",
    "save_picture",
    "serve",
    "shader_features",
    "sim",
    "view",
    "voxelize",
    "voxelize_mesh",
]

_HOMES = {
    "voxrt.building.animation": ("build_animation",),
    "voxrt.building.animation_takes": ("frame_times",),
    "voxrt.building.baking": ("Bake",),
    "voxrt.options.build_options": ("BuildOptions",),
    "voxrt.options.render_options": ("RenderOptions",),
    "voxrt.building.result": ("BuildResult",),
    "voxrt.export": (
        "read_any",
        "read_rom",
        "rom_info",
    ),
    "voxrt.building.fitting": (
        "BudgetFit",
        "InteriorFit",
    ),
    "voxrt.sources.from_arrays": ("mesh_scene",),
    "voxrt.views.depth_likeness": (
        "LikenessAtDepth",
        "draw_likeness_curve",
        "likeness_curve",
    ),
    "voxrt.octree": (
        "BOARDS",
        "Octree",
        "Region",
        "Rom",
        "RomError",
        "diff",
        "differing_regions",
    ),
    "voxrt.octree.camera": (
        "Camera",
        "Lighting",
    ),
    "voxrt.outputs": ("OutputError",),
    "voxrt.views.pictures": (
        "Picture",
        "animation_camera",
        "render",
        "save_animation",
        "save_picture",
    ),
    "voxrt.building.pipeline": (
        "build",
        "voxelize_mesh",
    ),
    "voxrt.errors": ("ToolError",),
    "voxrt.sim": (
        "Frame",
        "NoSuchConfigurationError",
        "RayHits",
        "RayPath",
        "SimulatorError",
        "cast_rays",
        "check",
        "compare",
        "comparison_sheet",
        "follow_ray",
        "shader_features",
    ),
    "voxrt.view": ("ViewerError",),
    "voxrt.views.viewpoint": (
        "ViewpointError",
        "aim_camera",
    ),
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
    "voxrt.views.writers": (
        "WRITABLE_SUFFIXES",
        "convert",
    ),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}
_ROOMS = ("board", "export", "octree", "serve", "sim", "view", "voxelize")

if TYPE_CHECKING:  # type checkers see these names and no others: a misspelt one is an error
    from voxrt import board, export, octree, serve, sim, view, voxelize
    from voxrt.building.animation import build_animation
    from voxrt.building.animation_takes import frame_times
    from voxrt.building.baking import Bake
    from voxrt.building.fitting import BudgetFit, InteriorFit
    from voxrt.building.pipeline import build, voxelize_mesh
    from voxrt.building.result import BuildResult
    from voxrt.errors import ToolError
    from voxrt.export import read_any, read_rom, rom_info
    from voxrt.octree import BOARDS, Octree, Region, Rom, RomError, diff, differing_regions
    from voxrt.octree.camera import Camera, Lighting
    from voxrt.options.build_options import BuildOptions
    from voxrt.options.render_options import RenderOptions
    from voxrt.outputs import OutputError
    from voxrt.sim import (
        Frame,
        NoSuchConfigurationError,
        RayHits,
        RayPath,
        SimulatorError,
        cast_rays,
        check,
        compare,
        comparison_sheet,
        follow_ray,
        shader_features,
    )
    from voxrt.sources.from_arrays import mesh_scene
    from voxrt.view import ViewerError
    from voxrt.views.depth_likeness import LikenessAtDepth, draw_likeness_curve, likeness_curve
    from voxrt.views.pictures import Picture, animation_camera, render, save_animation, save_picture
    from voxrt.views.viewpoint import ViewpointError, aim_camera
    from voxrt.views.writers import WRITABLE_SUFFIXES, convert
    from voxrt.voxelize import AssetError, DoesNotFitError, Grid, Material, Scene, SceneWarning, fit_grid, load
else:

    def __getattr__(name: str) -> object:
        if name in _HOME:
            return getattr(import_module(_HOME[name]), name)
        if name in _ROOMS:
            return import_module(f"{__name__}.{name}")
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


if "IPython" in sys.modules:  # a notebook: it finds the cards on the values' classes
    import_module("voxrt.building.cards")
