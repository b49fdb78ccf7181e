"""The options of a build: the one place for their names, their defaults and what they mean.

:func:`voxrt.build` takes :class:`BuildOptions`, or the same names as keywords. The command line reads its defaults and
its help from here, so this module imports no heavy library.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence  # type hints are read at run time
from dataclasses import dataclass, fields, replace
from os import PathLike
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypedDict, get_args

from voxrt.options.backgrounds import read_background

if TYPE_CHECKING:
    from collections.abc import Callable

Fill: TypeAlias = Literal["solid", "surface", "auto"]
Geometry: TypeAlias = Literal["auto", "render", "collider"]
Pow2: TypeAlias = Literal["box", "none"]
UpAxis: TypeAlias = Literal["x", "y", "z"]
Engine: TypeAlias = Literal["rtl", "model"]
Dialect: TypeAlias = Literal["report", "seed-rtl", "msb", "lod"]

DEFAULT_DEPTH = 7
"""Levels of the octree if neither they nor the size of a voxel are given."""

PREVIEW_SIZE = (640, 480)
"""Default width and height of a picture, pixels."""

_WIDEST = 1 << 14
_MOST_THREADS = 1024
_LEAST_MEMORY = 1 << 26
_BRIGHTEST = 16


@dataclass(frozen=True, kw_only=True)
class BuildOptions:
    """How an asset is built.

    Attributes
    ----------
    depth
        Levels of the octree, 1 to 16. The grid has 2**depth voxels per side. The default is 7, unless `voxel_size` is
        given.
    voxel_size
        Side of a voxel in metres; on the command line also with a unit, such as ``5cm``. Give this or `depth`, not
        both.
    fill
        ``"solid"``: fill what surfaces enclose, small holes or not. ``"surface"``: keep only the shell. ``"auto"``, the
        default: as solid, but open pieces whose openings exceed 5 % of their area together keep only their shell, as
        clothes do.
    interior
        Material of the hidden voxels: those that no ray from outside can reach. ``"keep"``: the material of their
        object. ``"any"``: for each the material that makes the memory smallest. The name or the id of a material: that
        material for all of them.
    geometry
        What is voxelized. ``"auto"``: the colliders of an object if it has any, else its triangles. ``"render"``:
        always the triangles. ``"collider"``: always colliders; an object without one becomes its bounding box.
    pow2
        ``"box"``: round the sides of box colliders up to powers of two voxels, which saves memory. ``"none"``: keep
        them as they are.
    up
        The up axis of an asset whose format does not state it (OBJ, STL, PLY). The default is y.
    unit
        Metres per unit of an asset whose format does not state it (OBJ, STL, PLY); on the command line also the name of
        the unit, such as ``mm``. The default is 1.
    time
        Second of the animation at which the asset is built (glTF, USD).
    animation
        The animation to use, by name or by number, counted from 0 (glTF). The default is the first.
    variants
        Variants to build: the name of a material variant (glTF), or any number of ``/prim/path:set=variant`` (USD).
    ignore
        Names of objects to leave out. A prim path of a USD file leaves out all below it, too.
    bounds
        The lowest and the highest corner of what the grid holds, in metres of the scene: x, y, z, x, y, z. What lies
        outside the grid is cut off. The default is the bounds of all objects.
    allow_empty
        Accept a memory without a single solid voxel.
    allow_outside
        Also open files that the asset names outside of its own folder.
    colours
        The largest number of materials made of textures and vertex colours, 1 to 254. Materials of one colour are not
        counted and keep their colour.
    bake
        Bake light: every voxel at the surface gets the colour that it has under the sun and the sky. The memory is then
        shown flat, with up to 254 colours.
    sun
        With `bake`: the direction towards the sun, x, y and z. Zeros for no sun. The default is 1, 3, 2.
    sky
        With `bake`: the light of the sky, as a strength such as 0.4 or as a colour such as ``#9db4d0``. The default is
        0.4; the sun has 0.65.
    bake_samples
        With `bake`: rays to the sky per voxel, 1 to 4096. The default is 64.
    budget
        The largest size of the memory, in words. Detail that is seen least is given up until the memory fits. In
        Python, also the name of a board: its memory is the budget.
    dialect
        How the ``.mem`` file encodes materials. ``"report"``: for the hardware of this project. ``"seed-rtl"``: for the
        published bitstreams of the original system. ``"msb"``: for its C++ program. ``"lod"``: that of `lod`.
    lod
        Level of detail: write mean materials too, in the dialect ``lod``. Then pictures of far views can be rendered
        with fewer words.
    preview
        Render a picture of the whole scene, with the scene's own light if it has one. It goes to the given PNG file,
        or to ``NAME.preview.png`` in the output folder. In Python, True asks for the latter.
    size
        Width and height of the preview in pixels. The default is 640 x 480.
    camera
        The author's camera for the preview and for boards, by name or by number, counted from 0 (glTF, USD). The
        default is the first. Without one, pictures show the whole scene from the front right and above.
    samples
        Rays per pixel of the preview on each axis: 1, 2 or 4. More than one smooths the edges.
    background
        The background of the preview: ``"light"``, ``"dark"``, ``"transparent"``, or a colour such as ``"#204060"``.
        The default is the background of the scene.
    engine
        What renders the preview. ``"rtl"``: the verilated hardware, which counts its clock cycles. ``"model"``: the
        exact C++ model, which is faster. Both give the same pixels.
    strict
        Refuse an asset that would otherwise cause a warning.
    threads
        Threads of the native stages; 0 takes one per core. The result does not depend on it.
    memory
        Bytes that a build may take, such as ``4G`` on the command line; the default is half of what is free. Larger
        scenes are voxelized in tiles, squares of columns. Their octrees go to the folder ``NAME.tiles`` beside the
        output and are joined there to the same result; a build that was killed goes on from them.
    scheduler
        Build on the cluster of this Dask scheduler, such as ``tcp://host:8786``. Its workers open the asset and write
        tiles at the same paths as this machine. Needs the extra ``cluster``.
    workers
        Build by so many processes of this machine, 1 to 1024.

    Raises
    ------
    TypeError, ValueError
        An option has a value of the wrong type, or one that is out of range. Conversions that are exact are made:
        ``depth=7.0`` is ``depth=7``, lists become tuples.

    Examples
    --------
    >>> from voxrt import BuildOptions
    >>> options = BuildOptions(depth=8, fill="surface")
    >>> options.colours
    32
    >>> BuildOptions(engine="gpu")
    Traceback (most recent call last):
        ...
    ValueError: engine must be 'rtl' or 'model', not 'gpu'
    """

    depth: int | None = None
    voxel_size: float | None = None
    fill: Fill = "auto"
    interior: int | str = "keep"
    geometry: Geometry = "auto"
    pow2: Pow2 = "box"
    up: UpAxis | None = None
    unit: float | None = None
    time: float | None = None
    animation: str | None = None
    variants: Sequence[str] = ()
    ignore: Sequence[str] = ()
    bounds: tuple[float, float, float, float, float, float] | None = None
    allow_empty: bool = False
    allow_outside: bool = False
    colours: int = 32
    bake: bool = False
    sun: tuple[float, float, float] = (1.0, 3.0, 2.0)
    sky: float | str = 0.4
    bake_samples: int = 64
    budget: int | str | None = None
    dialect: Dialect = "report"
    lod: bool = False
    preview: str | PathLike[str] | bool = False
    size: tuple[int, int] = PREVIEW_SIZE
    camera: str | None = None
    samples: int = 1
    background: str | tuple[int, int, int] | None = None
    engine: Engine = "rtl"
    strict: bool = False
    threads: int = 0
    memory: int | None = None
    scheduler: str | None = None
    workers: int | None = None

    def __post_init__(self) -> None:
        for name, value in _checked(self).items():
            object.__setattr__(self, name, value)


class BuildKeywords(TypedDict, total=False):
    """The options of :class:`BuildOptions` as keywords, for type checkers."""

    depth: int | None
    voxel_size: float | None
    fill: Fill
    interior: int | str
    geometry: Geometry
    pow2: Pow2
    up: UpAxis | None
    unit: float | None
    time: float | None
    animation: str | None
    variants: Sequence[str]
    ignore: Sequence[str]
    bounds: tuple[float, float, float, float, float, float] | None
    allow_empty: bool
    allow_outside: bool
    colours: int
    bake: bool
    sun: tuple[float, float, float]
    sky: float | str
    bake_samples: int
    budget: int | str | None
    dialect: Dialect
    lod: bool
    preview: str | PathLike[str] | bool
    size: tuple[int, int]
    camera: str | None
    samples: int
    background: str | tuple[int, int, int] | None
    engine: Engine
    strict: bool
    threads: int
    memory: int | None
    scheduler: str | None
    workers: int | None


def merge_options(function: str, options: BuildOptions | None, keywords: BuildKeywords) -> BuildOptions:
    """Return options with the keywords of a call in their place.

    Parameters
    ----------
    function
        What was called, for errors.
    options
        None for the defaults.
    keywords
        Options by name.

    Raises
    ------
    TypeError, ValueError
        `options` are none, there is no option of such a name, or it is out of range.

    Examples
    --------
    >>> merge_options("build", None, {"depth": 5}).depth
    5
    """
    from voxrt.voxelize.arguments import instance  # noqa: PLC0415 - NumPy comes with it, and --help must be instant

    options = instance("options", BuildOptions() if options is None else options, BuildOptions)
    names = [field.name for field in fields(BuildOptions)]
    if unknown := sorted(set(keywords) - set(names)):
        raise TypeError(f"{function}() has no option {unknown[0]!r}; it has {', '.join(names)}")
    return replace(options, **keywords) if keywords else options


def _checked(given: BuildOptions) -> dict[str, object]:
    """Return the options by name, converted exactly; TypeError or ValueError if that is not possible."""
    from voxrt.octree import MAX_DEPTH  # noqa: PLC0415 - NumPy comes with it, and --help must be instant
    from voxrt.voxelize.arguments import choice, flag, real, text, vector, whole  # noqa: PLC0415

    if given.scheduler is not None and given.workers is not None:
        raise ValueError("scheduler and workers exclude each other; give one of them")
    if given.depth is not None and given.voxel_size is not None:
        raise ValueError("depth and voxel_size exclude each other; give one of them")
    if given.lod is True and given.dialect not in ("report", "lod"):
        raise ValueError(f"lod has its own dialect, and {given.dialect} has no mean materials; leave one of them out")

    def budget(name: str, value: object) -> int | str:
        if not isinstance(value, str):
            return whole(name, value, 1, 1 << 31)
        from voxrt.octree import BOARDS  # noqa: PLC0415 - slow to import

        return choice(name, value, tuple(BOARDS))

    checks: dict[str, Callable[[str, Any], object]] = {
        "depth": lambda name, value: whole(name, value, 1, MAX_DEPTH),
        "voxel_size": lambda name, value: real(name, value, above=0),
        "fill": lambda name, value: choice(name, value, get_args(Fill)),
        "interior": lambda name, value: value if isinstance(value, str) else whole(name, value, 1, 255),
        "geometry": lambda name, value: choice(name, value, get_args(Geometry)),
        "pow2": lambda name, value: choice(name, value, get_args(Pow2)),
        "up": lambda name, value: choice(name, value, get_args(UpAxis)),
        "unit": lambda name, value: real(name, value, above=0),
        "time": real,
        "animation": text,
        "variants": _texts,
        "ignore": _texts,
        "bounds": _bounds,
        "allow_empty": flag,
        "allow_outside": flag,
        "colours": lambda name, value: whole(name, value, 1, 254),
        "bake": flag,
        "sun": vector,
        "sky": _sky,
        "bake_samples": lambda name, value: whole(name, value, 1, 4096),
        "budget": budget,
        "dialect": lambda name, value: choice(name, value, get_args(Dialect)),
        "lod": flag,
        "preview": lambda name, value: value if isinstance(value, str | PathLike) else flag(name, value),
        "size": _pixels,
        "camera": text,
        "samples": _samples,
        "background": read_background,
        "engine": lambda name, value: choice(name, value, get_args(Engine)),
        "strict": flag,
        "threads": lambda name, value: whole(name, value, 0, _MOST_THREADS),
        "memory": lambda name, value: whole(name, value, _LEAST_MEMORY, 1 << 62),
        "scheduler": text,
        "workers": lambda name, value: whole(name, value, 1, _MOST_THREADS),
    }
    optional = {option.name for option in fields(BuildOptions) if option.default is None}
    values = {name: getattr(given, name) for name in checks}
    return {
        name: None if value is None and name in optional else checks[name](name, value)
        for name, value in values.items()
    }


def _sky(name: str, value: object) -> float | str:
    from voxrt.voxelize.arguments import real  # noqa: PLC0415
    from voxrt.voxelize.colour.srgb import linear_from_hex  # noqa: PLC0415

    if isinstance(value, str):
        linear_from_hex(name, value)
        return value
    strength = real(name, value)
    if not 0 <= strength <= _BRIGHTEST:
        raise ValueError(f"{name} must be a strength of 0 … {_BRIGHTEST}, or a colour like '#9db4d0', not {value!r}")
    return strength


def _texts(name: str, value: object) -> tuple[str, ...]:
    from voxrt.voxelize.arguments import shown, text  # noqa: PLC0415

    if isinstance(value, str) or not isinstance(value, Iterable):
        raise TypeError(f"{name} must be a sequence of strings, not {shown(value)}")
    return tuple(text(f"{name}[{row}]", one) for row, one in enumerate(value))


def _bounds(name: str, value: object) -> tuple[float, ...]:
    from voxrt.voxelize.arguments import real, shown  # noqa: PLC0415

    if not isinstance(value, Iterable) or len(parts := list(value)) != 6:
        raise ValueError(f"{name} must be the lowest and the highest corner, six numbers, not {shown(value)}")
    corners = tuple(real(f"{name}[{row}]", one) for row, one in enumerate(parts))
    if not all(low < high for low, high in zip(corners[:3], corners[3:], strict=True)):
        raise ValueError(f"{name} must be the lowest and then the highest corner, not {shown(value)}")
    return corners


def _samples(name: str, value: object) -> int:
    from voxrt.octree.camera import SAMPLES  # noqa: PLC0415
    from voxrt.voxelize.arguments import whole  # noqa: PLC0415

    samples = whole(name, value, 1, max(SAMPLES))
    if samples not in SAMPLES:
        raise ValueError(f"{name} must be 1, 2 or 4, not {samples}")
    return samples


def _pixels(name: str, value: object) -> tuple[int, int]:
    from voxrt.voxelize.arguments import shown, whole  # noqa: PLC0415

    if not isinstance(value, Iterable) or len(parts := list(value)) != 2:
        raise ValueError(f"{name} must be a width and a height in pixels, not {shown(value)}")
    return whole(f"{name}[0]", parts[0], 1, _WIDEST), whole(f"{name}[1]", parts[1], 1, _WIDEST)
