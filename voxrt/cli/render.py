"""``voxrt render``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

import voxrt
from voxrt.build_options import Dialect, Engine  # noqa: TC001 - cyclopts reads the signature
from voxrt.cli.arguments import Backdrop, Depth, Pixels, Reporting, Sight, UsageError, choice, place, png, whole
from voxrt.cli.messages import cache_cost, picture_cost, summarize, warn
from voxrt.cli.results import print_json, render_result
from voxrt.cli.source import read_source

if TYPE_CHECKING:
    from voxrt import Lighting
    from voxrt.octree.camera import Shading
    from voxrt.sim import Dram

Triple = tuple[int, int, int]


def render(
    scene: Annotated[Path, Parameter(metavar="ROM|ASSET")],
    /,
    *,
    output: Annotated[Path | None, Parameter(("--output", "-o"), metavar="FILE")] = None,
    engine: Annotated[Engine, Parameter(converter=choice)] = "rtl",
    config: Annotated[str | None, Parameter(metavar="NAME")] = None,
    size: Pixels = (640, 480),
    sight: Annotated[Sight, Parameter(name="*")] = Sight(),  # noqa: B008
    depth: Depth = None,
    dialect: Annotated[Dialect | None, Parameter(converter=choice)] = None,
    light: Annotated[
        Triple | None, Parameter(converter=place, n_tokens=1, metavar="X,Y,Z", allow_leading_hyphen=True)
    ] = None,
    ambient: Annotated[int | None, Parameter(converter=whole, metavar="N")] = None,
    bounces: Annotated[int | None, Parameter(converter=whole, metavar="N")] = None,
    shading: Annotated[Literal["faces", "report", "flat"] | None, Parameter(converter=choice)] = None,
    samples: Literal[1, 2, 4] = 1,
    background: Backdrop = None,
    latency: Annotated[int | None, Parameter(converter=whole, metavar="CLOCKS")] = None,
    interval: Annotated[int | None, Parameter(converter=whole, metavar="CLOCKS")] = None,
    jitter: Annotated[int | None, Parameter(converter=whole, metavar="CLOCKS")] = None,
    check: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
    reporting: Annotated[Reporting, Parameter(name="*", negative=(), show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Render a picture of a memory or an asset, with the same pixels as the hardware.

    Parameters
    ----------
    scene
        A memory: .mem or another format. Its manifest, the .json beside it, states materials, depth and dialect. Or an
        asset, which is built first.
    output
        The picture, a .png. The default is NAME.png in this folder.
    engine
        rtl: the verilated hardware, which counts its clock cycles. model: the exact C++ model, which is faster. Both
        give the same pixels.
    config
        The configuration of the hardware: its lanes, its memory, the features of its shader. The default is tiny, or
        lit if light or mirrors are asked for.
    size
        Width and height in pixels. [default: 640x480]
    sight
        The camera.
    depth
        Levels of the octree, for an asset or for a memory without a manifest.
    dialect
        How the memory encodes materials, for a memory without a manifest.
    light
        Position of a light that casts shadows, in voxels, in steps of 1/16. The default is the light of the memory, if
        it has one.
    ambient
        The brightness of shadows, 0 to 255. [default: 90]
    bounces
        The most reflections of a ray by mirrors, 0 to 15. With 0, mirrors are like other materials. The default is
        that of the memory, or 0.
    shading
        What brightness depends on. faces: each side of a block has its own; the top is the brightest. report: the angle
        to the camera or to the light, as in the report on the original hardware. flat: materials show their own colour.
        The default is that of the memory, or faces.
    samples
        Rays per pixel on each axis. More than one smooths the edges; it takes as many frames as rays per pixel.
    background
        light, dark, transparent, or a colour such as #204060. The default is the background of the memory. A
        transparent picture suits pages of any colour.
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
    file = png(Path(f"{scene.stem}.png") if output is None else output)
    source = read_source(scene, depth, dialect)
    blob, memory = source.blob, source.rom
    camera = source.camera(size, sight)
    lighting = _lighting(blob.lighting, light, ambient, bounces, shading)
    if config is None:
        config = "lit" if lighting.features else "tiny"
    elif engine == "rtl" and blob.lighting and light is None and bounces is None:
        absent = lighting.features - voxrt.shader_features(config)
        if absent:
            warn(
                (voxrt.SceneWarning("light", f"the memory's light is left out: {config} has none, --config lit does"),)
            )
            lighting = replace(lighting, on=False, bounces=0)
    dram = _dram(latency, interval, jitter)
    wrong_pixels = None
    if check:
        checked = voxrt.check(
            memory, camera, size, lighting=lighting, samples=samples, background=background, config=config, dram=dram
        )
        frame, wrong_pixels = getattr(checked, engine), checked.wrong_pixels
    else:
        frame = voxrt.render(
            memory,
            camera,
            size=size,
            engine=engine,
            config=config,
            lighting=lighting,
            samples=samples,
            background=background,
            dram=dram,
        )
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
        summarize(f"{scene.name}:", rows)
    if wrong_pixels:
        raise voxrt.SimulatorError(
            f"{scene}: {wrong_pixels} pixels differ between the hardware and its model; please report it with the file"
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
    authored: Lighting | None, light: Triple | None, ambient: int | None, bounces: int | None, shading: Shading | None
) -> Lighting:
    """Give the memory's lighting with what the command line says in its place."""
    lighting = authored or voxrt.Lighting()
    if light is not None:
        lighting = replace(lighting, position=light, on=True, ambient=voxrt.Lighting().ambient)
    if ambient is not None:
        lighting = replace(lighting, ambient=ambient)
    if bounces is not None:
        lighting = replace(lighting, bounces=bounces)
    return lighting if shading is None else lighting.shaded(shading)
