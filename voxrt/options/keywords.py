"""The options as keywords of functions, for type checkers; ``docs/make_options.py`` writes this file."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from collections.abc import Sequence
    from os import PathLike

    from voxrt.octree.camera import Lighting
    from voxrt.options.build_options import Fill, Geometry, Pow2, UpAxis
    from voxrt.options.shared import Dialect, Engine
    from voxrt.sim import Background, Dram
    from voxrt.voxelize.rules import Rule, Thin


class BuildKeywords(TypedDict, total=False):
    """:class:`BuildOptions`."""

    depth: int | None
    voxel_size: float | None
    fill: Fill
    rule: Rule
    thin: Thin
    interior: int | str
    geometry: Geometry
    pow2: Pow2
    up: UpAxis | None
    unit: float | None
    time: float | None
    animation: str | None
    variants: Sequence[str]
    opaque_from: float | None
    points: int | None
    colours: int
    bake: bool
    sun: tuple[float, float, float]
    sky: float | str
    bake_samples: int
    ignore: Sequence[str]
    bounds: tuple[float, float, float, float, float, float] | None
    budget: int | str | None
    dialect: Dialect
    lod: bool
    preview: str | PathLike[str] | bool
    size: tuple[int, int]
    camera: str | None
    samples: int | None
    background: str | tuple[int, int, int] | None
    engine: Engine
    strict: bool
    allow_empty: bool
    allow_outside: bool
    threads: int
    memory: int | None
    scheduler: str | None
    workers: int | None


class RenderKeywords(TypedDict, total=False):
    """:class:`RenderOptions`."""

    size: tuple[int, int]
    engine: Engine | None
    config: str | None
    lighting: Lighting | None
    samples: int
    background: Background | str | None
    threads: int
    dram: Dram | None
    root: int
    lod: float
