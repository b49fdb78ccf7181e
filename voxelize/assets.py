"""Loading asset files: the suffix selects the loader, and every loader returns a :class:`Scene`."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

from msgspec.structs import replace

from voxrt.voxelize import arguments
from voxrt.voxelize.errors import AssetError, DoesNotFitError, SceneWarning
from voxrt.voxelize.formats.external_files import refuse_endless
from voxrt.voxelize.point_cloud import MOST_POINTS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from voxrt.voxelize.scene import Scene

UpAxis: TypeAlias = Literal["x", "y", "z"]

UP_AXES: tuple[UpAxis, ...] = ("x", "y", "z")

# Module, function and options of each loader. Loaders are imported when needed, for importing USD takes longer than
# building a small scene.
_OF_GLTF = {"time", "animation", "variants", "allow_outside", "opaque_from"}
_OF_USD = {"time", "variants", "allow_outside", "opaque_from"}
_OF_BLENDER = {"time", "allow_outside", "opaque_from"}
_LOADERS = {
    ".gltf": ("voxrt.voxelize.formats.gltf", "load_gltf", _OF_GLTF),
    ".glb": ("voxrt.voxelize.formats.gltf", "load_gltf", _OF_GLTF),
    ".usd": ("voxrt.voxelize.formats.usd.isolated", "read_isolated", _OF_USD),
    ".usda": ("voxrt.voxelize.formats.usd.isolated", "read_isolated", _OF_USD),
    ".usdc": ("voxrt.voxelize.formats.usd.isolated", "read_isolated", _OF_USD),
    ".usdz": ("voxrt.voxelize.formats.usd.isolated", "read_isolated", _OF_USD),
    ".blend": ("voxrt.voxelize.formats.blend.isolated", "read_isolated", _OF_BLENDER),
    ".toml": ("voxrt.voxelize.authoring.scene_toml", "load_scene_toml", {"allow_outside", "opaque_from", "points"}),
    ".obj": ("voxrt.voxelize.formats.obj", "load_obj", {"up", "unit", "allow_outside", "opaque_from"}),
    ".stl": ("voxrt.voxelize.formats.stl.load", "load_stl", {"up", "unit"}),
    ".off": ("voxrt.voxelize.formats.off", "load_off", {"up", "unit"}),
    ".3mf": ("voxrt.voxelize.formats.threemf.load", "load_3mf", {"opaque_from"}),
    ".dae": ("voxrt.voxelize.formats.dae.load", "load_dae", {"allow_outside", "opaque_from"}),
    ".step": ("voxrt.voxelize.formats.step.isolated", "load_step", {"opaque_from"}),
    ".stp": ("voxrt.voxelize.formats.step.isolated", "load_step", {"opaque_from"}),
    ".vox": ("voxrt.voxelize.formats.vox.scene", "load_vox_scene", {"unit", "time"}),
    ".ply": ("voxrt.voxelize.formats.ply", "load_ply", {"up", "unit", "allow_outside", "opaque_from", "points"}),
    ".xyz": ("voxrt.voxelize.formats.points", "load_xyz", {"up", "unit", "points"}),
    ".las": ("voxrt.voxelize.formats.points", "load_las", {"unit", "points"}),
    ".laz": ("voxrt.voxelize.formats.points", "load_las", {"unit", "points"}),
}

SUFFIXES = tuple(_LOADERS)
"""The suffixes that :func:`load` reads, in lower case."""

_ADDRESS = re.compile(r"([A-Za-z][A-Za-z0-9+.-]+):/+(.*)")

_WHY_IGNORED = {
    "up": "the up axis was ignored: {} files define it",
    "unit": "the unit was ignored: {} files define it",
    "time": "the time was ignored: {} files have no animation",
    "animation": "the animation's name was ignored: {} files have no named animations",
    "variants": "variants were ignored: {} files have none",
    "opaque_from": "--opaque-from was ignored: {} files have no opacity",
    "points": "--points was ignored: {} files have no points",
}


def load(
    path: str | Path,
    *,
    up: UpAxis | None = None,
    unit: float | None = None,
    time: float | None = None,
    animation: str | None = None,
    variants: Sequence[str] = (),
    opaque_from: float | None = None,
    points: int | None = None,
    allow_outside: bool = False,
) -> Scene:
    r"""Read an asset file into a scene (right-handed, metres, y up).

    A format ignores the options that do not apply to it, with a warning.

    Parameters
    ----------
    path
        A file whose suffix is one of :data:`SUFFIXES`; the case of the suffix does not matter.
    up
        The file's up axis, for formats that do not define it; None for z with STL and XYZ, for y with OBJ and PLY.
    unit
        Metres per unit of the file, for the same formats; None for 1.
    time
        Seconds into the animation, for formats with animations (glTF, USD, Blender); None for the pose at rest.
    animation
        An animation's name or its index, counted from 0 (glTF); None for the first.
    variants
        The name of one material variant (glTF), or any number of ``/prim/path:set=variant`` (USD).
    opaque_from
        Surfaces of lower opacity are left out, 0 … 1, for formats with opacity; None for 0.5. The alpha cutoff or the
        opacity threshold that an author gave a material decides in its place.
    points
        How many points of a point cloud make a voxel solid, for formats with points (PLY, XYZ, LAS); None for 1.
    allow_outside
        Whether files that the asset names may stand outside its folder and the folders below.

    Returns
    -------
    Scene
        The file's objects, materials, viewpoint and light, with warnings about what was ignored or replaced.

    Raises
    ------
    TypeError, ValueError
        An option of the wrong kind or range.
    AssetError
        The file cannot be read, is malformed, or asks for something that is not supported.
    DoesNotFitError
        More than 255 materials.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = Path(folder, "sail.obj")
    ...     _ = path.write_text("v 0 0 0\nv 4 0 0\nv 0 2 0\nf 1 2 3\n")
    ...     scene = load(path, unit=0.01)
    >>> scene
    Scene(name='sail', objects=1, triangles=1, materials=2, warnings=1)
    >>> scene.warnings[0].message
    'faces without a material got the default one'
    """
    if not isinstance(path, (str, Path)):
        raise TypeError(f"path must be a string or a Path, not {arguments.shown(path)}")
    path = Path(path)
    chosen = _checked(up=up, unit=unit, time=time, animation=animation, variants=variants, opaque_from=opaque_from)
    if points is not None:
        chosen["points"] = arguments.whole("points", points, 1, MOST_POINTS)
    allow_outside = arguments.flag("allow_outside", allow_outside)
    suffix = _suffix(path)
    module, name, options_of = _LOADERS[suffix]
    options: dict[str, object] = {option: value for option, value in chosen.items() if option in options_of}
    if "allow_outside" in options_of:
        options["allow_outside"] = allow_outside
    try:
        scene: Scene = getattr(import_module(module), name)(path, **options)
    except DoesNotFitError as error:
        raise DoesNotFitError(f"{path}: {error}") from None
    ignored = tuple(
        SceneWarning("ignored-option", _WHY_IGNORED[option].format(suffix[1:]))
        for option in chosen
        if option not in options_of
    )
    return replace(scene, warnings=scene.warnings + ignored) if ignored else scene


def _checked(
    *, up: object, unit: object, time: object, animation: object, variants: Sequence[str], opaque_from: object
) -> dict[str, object]:
    """Return the options that are given, checked and converted."""
    chosen: dict[str, object] = {}
    if up is not None:
        chosen["up"] = arguments.choice("up", up, UP_AXES)
    if unit is not None:
        chosen["unit"] = arguments.metres_per_unit("unit", unit)
    if time is not None:
        chosen["time"] = arguments.real("time", time)
    if animation is not None:
        chosen["animation"] = arguments.text("animation", animation)
    if opaque_from is not None:
        chosen["opaque_from"] = arguments.real("opaque_from", opaque_from, low=0, high=1)
    if isinstance(variants, str):
        raise TypeError(f"variants must be a sequence of strings, not a string: pass ({variants!r},)")
    if variants:
        chosen["variants"] = tuple(arguments.text(f"variants[{index}]", one) for index, one in enumerate(variants))
    return chosen


def _suffix(path: Path) -> str:
    """Return the suffix of a file that can be loaded, in lower case."""
    if address := _ADDRESS.match(str(path)):  # a path has lost one of the slashes
        shown = f"{address[1]}://{address[2]}"
        raise AssetError(shown, "is an address, and files are read from folders alone", fix="download it first")
    refuse_endless(path)
    try:
        is_file, is_folder = path.is_file(), path.is_dir()
    except OSError:  # the name is longer than any file's
        is_file = is_folder = False
    if not is_file:
        problem = "is a folder, not a file" if is_folder else "no such file"
        raise AssetError(path, problem, fix="check the path")
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise AssetError(
            path,
            f"unknown kind of file {path.suffix!r}",
            fix=f"convert it, by Blender or MeshLab for example, to one of {', '.join(SUFFIXES)}",
        )
    return suffix
