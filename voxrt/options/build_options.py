"""The options of a build: the one place for their names, their defaults and what they mean.

:func:`voxrt.build` takes :class:`BuildOptions`, or the same names as keywords. The command line has them from here, so
this module imports no heavy library.
"""

from __future__ import annotations

from collections.abc import Sequence  # type hints are read at run time
from os import PathLike
from typing import Literal, TypeAlias, get_args

from voxrt.options import notations
from voxrt.options.kinds import FLAG, one_of, real, text, texts, whole
from voxrt.options.option import OptionConflictError, OptionTable, check_options, documented, option
from voxrt.options.shared import (
    ALLOW_OUTSIDE,
    BACKGROUND,
    DEPTH,
    DIALECT,
    ENGINE,
    MEMORY,
    RUNNING,
    SAMPLES,
    SCHEDULER,
    SIZE,
    WORKERS,
    Dialect,
    Engine,
)
from voxrt.voxelize.rules import RULES, THIN_CHOICES, ObjectFill, Rule, Thin

Fill: TypeAlias = Literal[ObjectFill, "together"]
Geometry: TypeAlias = Literal["auto", "render", "collider"]
Pow2: TypeAlias = Literal["box", "none"]
UpAxis: TypeAlias = Literal["x", "y", "z"]

DEFAULT_DEPTH = 7
"""Levels of the octree if neither they nor the size of a voxel are given."""

GRID, CONTENT, COLOUR, PREVIEW = "Grid", "What is voxelized", "Colours and light", "Preview"


# A table: an option is its kind, its default and its group, then its text.
# fmt: off
@documented
class BuildOptions(OptionTable, frozen=True, kw_only=True):
    """How an asset is built.

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

    depth: int | None = DEPTH.field(group=GRID,
        help="Levels of the octree, 1 to 16; 7 unless {voxel_size} is given.",
        details="The grid has 2**depth voxels per side.")
    voxel_size: float | None = option(notations.LENGTH, None, GRID,
        "Side of a voxel in metres; on the command line also with a unit, such as 5cm.",
        details="Give this or {depth}, not both.")
    fill: Fill = option(one_of(get_args(Fill)), "auto", CONTENT,
        "solid: fill what surfaces enclose, small holes or not. surface: keep only the shell. auto, the default: "
        "as solid, but keep only the shell of open pieces. together: as auto, but open objects that close one "
        "another, such as a box and its lid, are one object.",
        details="Open are pieces whose openings exceed 5 % of their area together, such as clothes.",
        manifest="always")
    rule: Rule = option(one_of(RULES), "touch", CONTENT,
        "Which voxels solids fill. touch, the default: all that they touch. centre: those whose centre they hold. "
        "half: those that they fill by half.",
        details="A surface that encloses nothing keeps each voxel that it touches.", manifest="always")
    thin: Thin = option(one_of(THIN_CHOICES), "keep", CONTENT,
        "Parts too thin for {rule}. keep: some of the voxels that they touch stay, so that none gets lost or breaks. "
        "drop: no more than the rule gives.", is_rare=True, manifest="always")
    interior: int | str = option(notations.INTERIOR, "keep", CONTENT,
        "Material of the hidden voxels: those that no ray from outside can reach. keep: the material of their "
        "object. any: for each the material that makes the memory smallest. The name or the id of a material: that "
        "material for all of them.", is_rare=True, manifest="always")
    geometry: Geometry = option(one_of(get_args(Geometry)), "auto", CONTENT,
        "What is voxelized. auto: the colliders of an object if it has any, else its triangles. render: always the "
        "triangles. collider: always colliders; an object without one becomes its bounding box.",
        is_rare=True, manifest="always")
    pow2: Pow2 = option(one_of(get_args(Pow2)), "box", CONTENT,
        "box: round the sides of box colliders up to powers of two voxels, which saves memory. none: keep them as "
        "they are.", is_rare=True, manifest="always")
    up: UpAxis | None = option(one_of(get_args(UpAxis)), None, CONTENT,
        "The up axis of an asset whose format does not state it. The default is z for STL, y for OBJ and PLY.",
        is_rare=True, manifest="always")
    unit: float | None = option(notations.UNIT, None, CONTENT,
        "Metres per unit of an asset whose format does not state it (OBJ, STL, PLY). The default is 1.",
        details="On the command line also the name of the unit: mm, cm, m, in or ft.", manifest="always")
    time: float | None = option(real("SECONDS"), None, CONTENT,
        "Second of the animation at which the asset is built (glTF, USD, Blender).", is_rare=True, manifest="always")
    animation: str | None = option(text("NAME"), None, CONTENT,
        "The animation to use, by name or by number, counted from 0 (glTF). The default is the first.",
        is_rare=True, manifest="always")
    variants: Sequence[str] = option(texts("NAME"), (), CONTENT,
        "Variants to build: the name of a material variant (glTF), or any number of /prim/path:set=variant (USD).",
        flags=("--variant",), is_rare=True, manifest="always")
    opaque_from: float | None = option(real("A", low=0, high=1), None, CONTENT,
        "Surfaces of lower opacity are left out, 0 to 1. The default is 0.5.",
        details="The alpha cutoff or opacity threshold that an author gave a material decides in its place.",
        is_rare=True, manifest="changed")
    points: int | None = option(whole(1, 1 << 31), None, CONTENT,
        "How many points of a point cloud make a voxel solid (PLY, XYZ, LAS). The default is 1.",
        is_rare=True, manifest="changed")
    colours: int = option(whole(1, 254, "K"), 32, COLOUR,
        "The largest number of materials made of textures and vertex colours, 1 to 254.",
        details="Materials of one colour are not counted and keep their colour.", manifest="always")
    bake: bool = option(FLAG, False, COLOUR,
        "Bake light: every voxel at the surface gets the colour that it has under the sun and the sky. The memory "
        "is then shown flat, with up to 254 colours.", is_rare=True, manifest="always")
    sun: tuple[float, float, float] = option(notations.DIRECTION, (1.0, 3.0, 2.0), COLOUR,
        "With {bake}: the direction towards the sun, x, y and z. Zeros for no sun.", is_rare=True, goes_with="bake")
    sky: float | str = option(notations.SKY, 0.4, COLOUR,
        "With {bake}: the light of the sky, as a strength such as 0.4 or as a colour such as #9db4d0. The sun has "
        "0.65.", is_rare=True, goes_with="bake")
    bake_samples: int = option(whole(1, 4096), 64, COLOUR,
        "With {bake}: rays to the sky per voxel, 1 to 4096.", is_rare=True, goes_with="bake")
    ignore: Sequence[str] = option(texts("NAME"), (), CONTENT,
        "Names of objects to leave out. A prim path of a USD file leaves out all below it, too.",
        is_rare=True, manifest="changed")
    bounds: tuple[float, float, float, float, float, float] | None = option(notations.CORNERS, None, GRID,
        "The lowest and the highest corner of what the grid holds, in metres of the scene: x, y, z, x, y, z. What "
        "lies outside the grid is cut off. The default is the bounds of all objects.",
        is_rare=True, manifest="changed")
    budget: int | str | None = option(notations.BUDGET, None, MEMORY,
        "The largest size of the memory, in words.",
        details="Detail that is seen least is given up until the memory fits.",
        python="In Python, also the name of a board: its memory is the budget.")
    dialect: Dialect = DIALECT.field(default="report", is_rare=True,
        help="How the .mem file encodes materials. report: for the hardware of this project. seed-rtl: for the "
        "published bitstreams of the original system. msb: for its C++ program. lod: that of {lod}.")
    lod: bool = option(FLAG, False, MEMORY,
        "Level of detail: write mean materials too, in the dialect lod. Then pictures of far views can be rendered "
        "with fewer words.", is_rare=True)
    preview: str | PathLike[str] | bool = option(notations.PREVIEW, False, PREVIEW,
        "Render a picture of the whole scene to the given PNG file, or to NAME.preview.png in the output folder.",
        details="It has the scene's own light if there is one.",
        python="In Python, True asks for NAME.preview.png.")
    size: tuple[int, int] = SIZE.field(group=PREVIEW, is_rare=True, goes_with="preview",
        help="Width and height of the preview in pixels.")
    camera: str | None = option(text("NAME"), None, PREVIEW,
        "The author's camera for the preview and for boards, by name or by number, counted from 0 (glTF, USD). The "
        "default is the first. Without one, pictures show the whole scene from the front right and above.",
        is_rare=True)
    samples: int | None = SAMPLES.field(group=PREVIEW, default=None, is_rare=True, goes_with="preview",
        help="Rays per pixel of the preview on each axis: 1, 2 or 4. More than one smooths the edges. The default is "
        "4, or 1 with rtl.")
    background: str | tuple[int, int, int] | None = BACKGROUND.field(group=PREVIEW, is_rare=True, goes_with="preview",
        help="The background of the preview: light, dark, transparent, or a colour such as #204060. The default is "
        "the background that the scene names, or light.")
    engine: Engine = ENGINE.field(group=PREVIEW, default="model", is_rare=True, goes_with="preview",
        help="What renders the preview. model: the exact C++ model, which is fast. rtl: the verilated hardware, which "
        "counts its clock cycles. Both give the same pixels.")
    strict: bool = option(FLAG, False, RUNNING, "Refuse an asset that would otherwise cause a warning.", is_rare=True)
    allow_empty: bool = option(FLAG, False, RUNNING, "Accept a memory without a single solid voxel.", is_rare=True)
    allow_outside: bool = ALLOW_OUTSIDE.field(is_rare=True)
    threads: int = option(whole(0, 1024), 0, None,
        "Threads of the native stages; 0 takes one per core. The result does not depend on it.")
    memory: int | None = option(notations.BYTES, None, RUNNING,
        "Bytes that a build may take, such as 4G on the command line; the default is half of what is free. Larger "
        "scenes are voxelized in tiles, squares of columns. Their octrees go to the folder NAME.tiles beside the "
        "output and are joined there to the same result; a build that was killed goes on from them.", is_rare=True)
    scheduler: str | None = SCHEDULER.field(is_rare=True,
        help="Build on the cluster of this Dask scheduler, such as tcp://host:8786. Its workers open the asset and "
        "write tiles at the same paths as this machine. Needs the extra cluster.")
    workers: int | None = WORKERS.field(help="Build by so many processes of this machine, 1 to 1024.", is_rare=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.scheduler is not None and self.workers is not None:
            raise OptionConflictError("{scheduler} and {workers} exclude each other; give one of them")
        if self.depth is not None and self.voxel_size is not None:
            raise OptionConflictError("{depth} and {voxel_size} exclude each other; give one of them")
        if self.lod is True and self.dialect not in ("report", "lod"):
            raise OptionConflictError(
                f"{{lod}} has its own dialect, and {self.dialect} has no mean materials; leave one of them out"
            )
        check_options(self)

    @property
    def fill_per_object(self) -> ObjectFill:
        """How objects are filled, after those that are filled together became one."""
        return "auto" if self.fill == "together" else self.fill
