"""One door for asset files: the suffix picks the loader, and every loader ends in the same :class:`Scene`."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

from voxrt.voxelize.errors import AssetError, DoesNotFitError, SceneWarning

if TYPE_CHECKING:
    from voxrt.voxelize.scene import Scene

UpAxis: TypeAlias = Literal["x", "y", "z"]

# Loaders are imported when a file asks for them: USD alone takes longer to import than a small scene to build. Each
# stands with what it can be told.
_LOADERS = {
    ".gltf": ("voxrt.voxelize.formats.gltf", "load_gltf", {"time", "animation", "variants", "allow_outside"}),
    ".glb": ("voxrt.voxelize.formats.gltf", "load_gltf", {"time", "animation", "variants", "allow_outside"}),
    ".usd": ("voxrt.voxelize.formats.usd", "load_usd", {"time", "variants", "allow_outside"}),
    ".usda": ("voxrt.voxelize.formats.usd", "load_usd", {"time", "variants", "allow_outside"}),
    ".usdc": ("voxrt.voxelize.formats.usd", "load_usd", {"time", "variants", "allow_outside"}),
    ".usdz": ("voxrt.voxelize.formats.usd", "load_usd", {"time", "variants", "allow_outside"}),
    ".toml": ("voxrt.voxelize.authoring.scene_toml", "load_scene_toml", {"allow_outside"}),
    ".obj": ("voxrt.voxelize.formats.obj", "load_obj", {"up", "unit", "allow_outside"}),
    ".stl": ("voxrt.voxelize.formats.stl.load", "load_stl", {"up", "unit"}),
    ".ply": ("voxrt.voxelize.formats.ply", "load_ply", {"up", "unit"}),
}

SUFFIXES = tuple(_LOADERS)
"""The suffixes :func:`load` knows, in lower case."""

_WHY_IGNORED = {
    "up": "the up axis was ignored: {} files say it themselves",
    "unit": "the unit was ignored: {} files say it themselves",
    "time": "the time was ignored: {} files have no animation",
    "animation": "the animation's name was ignored: {} files have none to choose from",
    "variants": "variants were ignored: {} files have none",
}


def load(
    path: str | Path,
    *,
    up: UpAxis | None = None,
    unit: float | None = None,
    time: float | None = None,
    animation: str | None = None,
    variants: tuple[str, ...] = (),
    allow_outside: bool = False,
) -> Scene:
    """Read an asset file into a scene (right-handed, metres, y up).

    Parameters
    ----------
    path
        A ``.gltf``, ``.glb``, ``.obj``, ``.stl``, ``.ply``, ``.usd``, ``.usda``, ``.usdc`` or ``.usdz`` file, or a
        scene written by hand, ``.toml``; the case of the suffix does not matter.
    up
        The file's up axis, for formats that do not say (OBJ, STL, PLY).
    unit
        Metres per unit of the file, for formats that do not say.
    time
        The second of its animation at which the file is shown, for formats that have some (glTF, USD).
    animation
        Which of its animations, by name or by number counted from 0 (glTF); the first where this is not given.
    variants
        What to show of what the file has in several ways: the name of one material variant (glTF), or
        ``/prim/path:set=variant`` any number of times (USD).
    allow_outside
        Whether files that the asset names may stand outside its folder and the folders in it.

    Formats ignore what is not for them, with a warning.

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
    try:
        is_file, is_folder = path.is_file(), path.is_dir()
    except OSError:  # a name longer than any file's
        is_file = is_folder = False
    if not is_file:
        problem = "is a folder, not a file" if is_folder else "no such file"
        raise AssetError(path, problem, fix="check the path")
    module, name, understood = _LOADERS[suffix]
    told = {
        option: value
        for option, value in (
            ("up", up),
            ("unit", unit),
            ("time", time),
            ("animation", animation),
            ("variants", variants),
        )
        if value not in (None, ())
    }
    options: dict[str, object] = {option: value for option, value in told.items() if option in understood}
    if "allow_outside" in understood:
        options["allow_outside"] = allow_outside
    try:
        scene: Scene = getattr(import_module(module), name)(path, **options)
    except DoesNotFitError as error:
        raise DoesNotFitError(f"{path}: {error}") from None
    ignored = tuple(
        SceneWarning("ignored-option", _WHY_IGNORED[option].format(suffix[1:]))
        for option in told
        if option not in understood
    )
    return replace(scene, warnings=scene.warnings + ignored)
