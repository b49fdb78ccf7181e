"""One door for asset files: the suffix picks the loader, and every loader ends in the same :class:`Scene`."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

from voxrt.voxelize.errors import AssetError, SceneWarning

if TYPE_CHECKING:
    from voxrt.voxelize.scene import Scene

UpAxis: TypeAlias = Literal["x", "y", "z"]

# Loaders are imported when a file asks for them: USD alone takes longer to import than a small scene to build.
_SELF_DESCRIBING = {
    ".gltf": ("voxrt.voxelize.gltf", "load_gltf"),
    ".glb": ("voxrt.voxelize.gltf", "load_gltf"),
    ".usd": ("voxrt.voxelize.usd", "load_usd"),
    ".usda": ("voxrt.voxelize.usd", "load_usd"),
    ".usdc": ("voxrt.voxelize.usd", "load_usd"),
    ".usdz": ("voxrt.voxelize.usd", "load_usd"),
}
_UP_AND_UNIT_UNKNOWN = {
    ".obj": ("voxrt.voxelize.obj", "load_obj"),
    ".stl": ("voxrt.voxelize.stl", "load_stl"),
    ".ply": ("voxrt.voxelize.ply", "load_ply"),
}

SUFFIXES = tuple(_SELF_DESCRIBING | _UP_AND_UNIT_UNKNOWN)
"""The suffixes :func:`load` knows, in lower case."""


def load(path: str | Path, *, up: UpAxis | None = None, unit: float | None = None) -> Scene:
    """Read an asset file into a scene (right-handed, metres, y up).

    Parameters
    ----------
    path
        A ``.gltf``, ``.glb``, ``.obj``, ``.stl``, ``.ply``, ``.usd``, ``.usda``, ``.usdc`` or ``.usdz`` file; the case
        of the suffix does not matter.
    up
        The file's up axis, for formats that do not say (OBJ, STL, PLY); others ignore it with a warning.
    unit
        Metres per unit of the file, for formats that do not say; others ignore it with a warning.

    Raises
    ------
    AssetError
        The file cannot be read, is malformed, or says something that cannot be honoured.
    DoesNotFitError
        More than 255 materials.
    """
    path = Path(path)
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise AssetError(path, f"unknown kind of file {path.suffix!r}", fix=f"give one of {', '.join(SUFFIXES)}")
    if not path.is_file():
        problem = "is a folder, not a file" if path.is_dir() else "no such file"
        raise AssetError(path, problem, fix="check the path")
    if suffix in _UP_AND_UNIT_UNKNOWN:
        module, name = _UP_AND_UNIT_UNKNOWN[suffix]
        scene: Scene = getattr(import_module(module), name)(path, up=up, unit=unit)
        return scene
    module, name = _SELF_DESCRIBING[suffix]
    scene = getattr(import_module(module), name)(path)
    ignored = tuple(
        SceneWarning("ignored-option", f"{option} was ignored: {suffix[1:]} files say it themselves")
        for option, value in (("up axis", up), ("unit", unit))
        if value is not None
    )
    return replace(scene, warnings=scene.warnings + ignored)
