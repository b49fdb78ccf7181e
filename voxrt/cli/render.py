"""``voxrt render``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Depth, Pixels, Reporting, Sight, UsageError, place, png, whole
from voxrt.cli.messages import cache_cost, picture_cost, summarize, warn
from voxrt.cli.results import print_json, render_result
from voxrt.cli.source import aim

if TYPE_CHECKING:
    from voxrt import Lighting
    from voxrt.sim import Dram

Triple = tuple[int, int, int]


def render(
    rom: Annotated[Path, Parameter(metavar="ROM")],
    /,
    *,
    output: Annotated[Path | None, Parameter(("--output", "-o"), metavar="FILE")] = None,
    engine: Literal["rtl", "model"] = "rtl",
    config: Annotated[str | None, Parameter(metavar="NAME")] = None,
    size: Pixels = (640, 480),
    sight: Annotated[Sight, Parameter(name="*")] = Sight(),  # noqa: B008
    depth: Depth = None,
    dialect: Literal["report", "seed-rtl", "msb"] | None = None,
    light: Annotated[
        Triple | None, Parameter(converter=place, n_tokens=1, metavar="X,Y,Z", allow_leading_hyphen=True)
    ] = None,
    ambient: Annotated[int | None, Parameter(converter=whole, metavar="N")] = None,
    bounces: Annotated[int | None, Parameter(converter=whole, metavar="N")] = None,
    flat: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
    latency: Annotated[int | None, Parameter(converter=whole, metavar="CLOCKS")] = None,
    interval: Annotated[int | None, Parameter(converter=whole, metavar="CLOCKS")] = None,
    jitter: Annotated[int | None, Parameter(converter=whole, metavar="CLOCKS")] = None,
    check: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
    reporting: Annotated[Reporting, Parameter(name="*", negative=(), show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Render a picture of a memory, with the same pixels as the hardware.

    Parameters
    ----------
    rom
        A memory: .mem or another format. Its manifest, the .json beside it, states materials, depth and dialect.
    output
        The picture, a .png. The default is NAME.png in this folder.
    engine
        rtl: the verilated hardware, which counts its clock cycles. model: the exact C++ model, which is faster. Both
        give the same pixels.
    config
        The configuration of the hardware: its lanes, its memory, the features of its shader. The default is tiny, or
        lit if light, mirrors or flat colours are asked for.
    size
        Width and height in pixels. [default: 640x480]
    sight
        The camera.
    depth
        Levels of the octree, for a memory without a manifest.
    dialect
        How the memory encodes materials, for a memory without a manifest.
    light
        Position of a light that casts shadows, in voxels, in steps of 1/16. The default is the light of the memory. If
        it has none, the light is in the camera.
    ambient
        The brightness of shadows, 0 to 255. [default: 32]
    bounces
        The most reflections of a ray by mirrors, 0 to 15. With 0, mirrors are like other materials. The default is
        that of the memory, or 0.
    flat
        Show materials in their own colour, whatever the angle.
    latency
        Of the external memory of a configuration with caches, such as cached16: clocks from an address to the first
        word. [default: 50]
    interval
        Of the external memory: clocks from one line of 32 bytes to the next. [default: 3]
    jitter
        Of the external memory: up to so many clocks more for each line, at random. [default: 0]
    check
        Render with both engines and count the pixels that differ. Any difference is an error.
    reporting
        How results are printed.
    """
    file = png(Path(f"{rom.stem}.png") if output is None else output)
    blob, warnings = voxrt.read_any(rom, depth=depth, dialect=dialect)
    warn(warnings)
    memory = blob.rom
    camera = aim(memory, blob.view, size, sight)
    lighting = _lighting(blob.lighting, light, ambient, bounces, flat=flat)
    if config is None:
        config = "tiny" if lighting is None else "lit"
    elif (
        engine == "rtl" and lighting and lighting == blob.lighting and lighting.features - voxrt.shader_features(config)
    ):
        warn((voxrt.SceneWarning("light", f"the memory's light is left out: {config} has none, --config lit does"),))
        lighting = None
    dram = _dram(latency, interval, jitter)
    wrong_pixels = None
    if check:
        checked = voxrt.check(memory, camera, size, lighting=lighting or voxrt.Lighting(), config=config, dram=dram)
        frame, wrong_pixels = getattr(checked, engine), checked.wrong_pixels
    else:
        frame = voxrt.render(memory, camera, size=size, engine=engine, config=config, lighting=lighting, dram=dram)
    voxrt.save_picture(frame.colour, file)
    if reporting.json:
        print_json(render_result(voxrt.Picture(frame, camera, engine), file, wrong_pixels))
    else:
        rows = [("picture", picture_cost(frame, engine))]
        if frame.cost.cache is not None:
            rows.append(("caches", cache_cost(frame.cost.cache, frame.cost.rays)))
        rows.append(("wrote", str(file)))
        if check:
            rows.append(("check", f"{wrong_pixels} pixels differ between the hardware and its model"))
        summarize(f"{rom.name}:", rows)
    if wrong_pixels:
        raise voxrt.SimulatorError(
            f"{rom}: {wrong_pixels} pixels differ between the hardware and its model; please report it with the file"
        )


def _dram(latency: int | None, interval: int | None, jitter: int | None) -> Dram | None:
    """Give the external memory that the command line describes; None where it says nothing of one."""
    said = {"latency": latency, "interval": interval, "jitter": jitter}
    known = {name: value for name, value in said.items() if value is not None}
    try:
        return voxrt.sim.Dram(**known, seed=1 if jitter else 0) if known else None
    except ValueError as error:
        raise UsageError(f"--{error}") from error


def _lighting(
    authored: Lighting | None, light: Triple | None, ambient: int | None, bounces: int | None, *, flat: bool
) -> Lighting | None:
    """Give the memory's lighting with what the command line says in its place; None where nothing is wanted."""
    lighting = authored or voxrt.Lighting()
    if light is not None:
        lighting = replace(lighting, position=light, on=True, ambient=voxrt.Lighting().ambient)
    if ambient is not None:
        lighting = replace(lighting, ambient=ambient)
    if bounces is not None:
        lighting = replace(lighting, bounces=bounces)
    if flat:
        lighting = replace(lighting, flat=True)
    return lighting if lighting.on or lighting.bounces or lighting.flat else None
