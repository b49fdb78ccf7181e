"""``voxrt build``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Pixels, Reporting, UsageError, levels, metres, png, seconds, shades, words
from voxrt.cli.messages import picture_cost, stage_bar, summarize, tabulate, warn
from voxrt.cli.results import build_report, print_json


def build(
    asset: Annotated[Path, Parameter(metavar="ASSET")],
    /,
    *,
    output: Annotated[Path, Parameter(("--output", "-o"), metavar="DIR")] = Path(),
    depth: Annotated[int | None, Parameter(converter=levels, metavar="N")] = None,
    voxel_size: Annotated[float | None, Parameter(converter=metres, metavar="METRES")] = None,
    fill: Literal["solid", "surface"] = "solid",
    interior: Annotated[str, Parameter(metavar="keep|any|MATERIAL")] = "keep",
    geometry: Literal["auto", "render", "collider"] = "auto",
    pow2: Literal["box", "none"] = "box",
    up: Literal["x", "y", "z"] | None = None,
    unit: Annotated[float | None, Parameter(converter=metres, metavar="METRES")] = None,
    time: Annotated[float | None, Parameter(converter=seconds, metavar="SECONDS")] = None,
    animation: Annotated[str | None, Parameter(metavar="NAME")] = None,
    variant: Annotated[tuple[str, ...], Parameter(metavar="NAME", show_default=False)] = (),
    allow_outside: Annotated[bool, Parameter(show_default=False)] = False,
    colours: Annotated[int, Parameter(converter=shades, metavar="K")] = 32,
    budget: Annotated[int | None, Parameter(converter=words, metavar="WORDS")] = None,
    board: Annotated[str | None, Parameter(metavar="NAME")] = None,
    preview: Annotated[str | None, Parameter(metavar="[FILE]")] = None,
    size: Pixels = (640, 480),
    engine: Literal["rtl", "model"] = "rtl",
    dialect: Literal["report", "seed-rtl", "msb"] = "report",
    strict: Annotated[bool, Parameter(show_default=False)] = False,
    profile: Annotated[bool, Parameter(show_default=False)] = False,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Build the octree memory of an asset: NAME.mem, its manifest NAME.json and a preview picture.

    Parameters
    ----------
    asset
        A glTF (.gltf .glb), OBJ, USD (.usd .usda .usdc .usdz), STL or PLY file, or a scene of some (.toml).
    output
        Folder to write to; made when it is missing.
    depth
        Levels of the octree, 1 to 16: the scene's bounding cube gets 2^N voxels a side. 7 when neither this nor
        --voxel-size is given.
    voxel_size
        Size of a voxel instead of --depth.
    fill
        Fill what closed surfaces enclose, or keep the shell only.
    interior
        What becomes of voxels that no ray from outside can reach: keep their object's material; any: each takes
        whatever makes the memory smallest; MATERIAL: all take that material, an id or a name.
    geometry
        auto: an object's colliders where it has some, else its triangles; render: always the triangles; collider:
        always colliders, the bounding box where an object has none.
    pow2
        Round box colliders up to powers of two voxels, or never.
    up
        The up axis of formats that do not say (OBJ, STL, PLY).
    unit
        Metres per unit of formats that do not say.
    time
        The second of its animation at which the asset is shown (glTF, USD).
    animation
        Which of its animations, by name or by number counted from 0 (glTF). [default: the first]
    variant
        A material variant (glTF), or /prim/path:set=variant (USD), any number of times.
    allow_outside
        Open files that the asset names outside its folder and the folders in it, too.
    colours
        Materials that textures and vertex colours are reduced to, 1 to 254; uniform materials keep their colour.
    budget
        Words that the memory may take: what is seen least is given up until it fits.
    board
        A board whose memory is the budget.
    preview
        Render a picture of the scene, to NAME.preview.png in the output folder or to FILE, a .png.
    size
        Width and height of the preview, pixels. [default: 640x480]
    engine
        What renders the preview: the verilated hardware, or the exact model of it. A light of the scene's own is
        cast by both.
    dialect
        How the memory spells a material: report is this project's; seed-rtl is what the published bitstreams read,
        msb what their C++ program reads.
    strict
        Refuse an asset of which something would not be honoured as it stands, instead of warning.
    profile
        Show where the time goes, a stage a row, what a stage consists of indented below it.
    reporting
        How to tell what was done.
    """
    if depth is not None and voxel_size is not None:
        raise UsageError("--depth and --voxel-size exclude each other; give one of them")
    if budget is not None and board is not None:
        raise UsageError("--budget and --board exclude each other; give one of them")
    if board is not None and board not in voxrt.BOARDS:
        raise UsageError(f"no board {board!r}; there are {', '.join(sorted(voxrt.BOARDS))}")
    with stage_bar(
        6 + (preview is not None) + (interior != "keep") + (budget is not None or board is not None)
    ) as progress:
        result = voxrt.build(
            asset,
            output,
            depth=depth,
            voxel_size=voxel_size,
            fill=fill,
            interior=interior,
            geometry=geometry,
            pow2=pow2,
            up=up,
            unit=unit,
            time=time,
            animation=animation,
            variants=variant,
            allow_outside=allow_outside,
            colours=colours,
            budget=board or budget,
            dialect=dialect,
            preview=png(Path(preview)) if preview else preview is not None,
            size=size,
            engine=engine,
            strict=strict,
            progress=progress,
        )
    warn(result.warnings)
    if reporting.json:
        print_json(build_report(result))
    else:
        summarize(f"{asset.name}:", _rows(result))
    if profile:
        total = sum(result.seconds.values())
        rows = [
            row
            for stage, took in result.seconds.items()
            for row in [(stage, took), *((f"  {part}", took) for part, took in result.parts.get(stage, {}).items())]
        ]
        stages = [(name, f"{1e3 * took:.1f}", f"{100 * took / total:.0f}") for name, took in rows]
        tabulate(("stage", "ms", "%"), [*stages, ("all", f"{1e3 * total:.1f}", "100")])


def _rows(result: voxrt.BuildResult) -> list[tuple[str, str]]:
    rom, total = result.rom, sum(result.seconds.values())
    size, shown = len(rom.octree.words), rom.materials[1:5]
    voxel = f", {rom.grid.voxel_size:.4g} m each" if rom.grid else ""
    names = ", ".join(material.name for material in shown) + (", ..." if len(rom.materials) > 5 else "")
    stages = ", ".join(f"{stage} {took:.2f}" for stage, took in result.seconds.items() if took >= 0.005)
    return [
        ("grid", f"{1 << rom.octree.depth} voxels a side (depth {rom.octree.depth}){voxel}"),
        ("solid", f"{result.solid_voxels:,} voxels"),
        ("memory", f"{size:,} words, {size * 4 / 1024:,.1f} KiB"),
        *([("interior", _interior(result.interior, rom))] if result.interior else []),
        *([("budget", _budget(result.budget))] if result.budget else []),
        ("materials", f"{len(rom.materials) - 1}" + (f": {names}" if shown else "")),
        *([("preview", picture_cost(result.preview.frame, result.preview.engine))] if result.preview else []),
        ("seconds", f"{total:.2f}" + (f": {stages}" if stages else "")),
        *(("wrote", str(path)) for path in result.outputs.values()),
    ]


def _interior(interior: voxrt.InteriorFit, rom: voxrt.Rom) -> str:
    made = "what shares most" if interior.material is None else rom.materials[interior.material].name
    return f"{interior.hidden:,} hidden voxels are {made}; the memory took {interior.words_before:,} words before"


def _budget(budget: voxrt.BudgetFit) -> str:
    fit = budget.fit
    if not (fit.changed or fit.appeared or fit.recoloured):
        return f"{budget.words:,} words are enough, nothing is given up"
    return (
        f"{budget.words:,} of {fit.words_shared:,} words: {fit.percent_changed:.2f} % of the surface changed, "
        f"PSNR {budget.psnr:.1f} dB, SSIM {budget.ssim:.3f}"
    )
