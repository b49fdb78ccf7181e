"""``voxrt render``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Depth, Pixels, Reporting, Sight, png
from voxrt.cli.messages import picture_cost, summarize, warn
from voxrt.cli.results import print_json, render_result
from voxrt.cli.source import aim


def render(
    rom: Annotated[Path, Parameter(metavar="ROM")],
    /,
    *,
    output: Annotated[Path | None, Parameter(("--output", "-o"), metavar="FILE")] = None,
    engine: Literal["rtl", "model"] = "rtl",
    config: Annotated[str, Parameter(metavar="NAME")] = "tiny",
    size: Pixels = (640, 480),
    sight: Annotated[Sight, Parameter(name="*")] = Sight(),  # noqa: B008
    depth: Depth = None,
    dialect: Literal["report", "seed-rtl", "msb"] | None = None,
    check: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
    reporting: Annotated[Reporting, Parameter(name="*", negative=(), show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Render a picture of a memory, as the hardware does.

    Parameters
    ----------
    rom
        A .mem file or a memory in another format. Its manifest, the .json beside it, gives materials, depth and
        dialect.
    output
        The picture, a .png; NAME.png in this folder when not given.
    engine
        The verilated hardware, or the exact model of it. Both give the same pixels.
    config
        The configuration of the hardware: how many lanes, which memory.
    size
        Width and height, pixels. [default: 640x480]
    sight
        Where the camera stands.
    depth
        Levels of the octree, where no manifest says.
    dialect
        How the memory spells a material, where no manifest says.
    check
        Render with both engines, count the pixels on which they differ, fail if there are any.
    reporting
        How to tell what was done.
    """
    file = png(Path(f"{rom.stem}.png") if output is None else output)
    blob, warnings = voxrt.read_any(rom, depth=depth, dialect=dialect)
    warn(warnings)
    memory = blob.rom
    camera = aim(memory, blob.view, size, sight)
    wrong_pixels = None
    if check:
        checked = voxrt.check(memory, camera, size, config=config)
        frame, wrong_pixels = getattr(checked, engine), checked.wrong_pixels
    else:
        lighting = blob.lighting
        if engine == "rtl" and lighting is not None and lighting.on:
            warn((voxrt.SceneWarning("light", "the memory's light is left out: --engine model casts it"),))
            lighting = None
        frame = voxrt.render(memory, camera, size=size, engine=engine, config=config, lighting=lighting)
    voxrt.save_picture(frame.colour, file)
    if reporting.json:
        print_json(render_result(voxrt.Picture(frame, camera, engine), file, wrong_pixels))
    else:
        rows = [("picture", picture_cost(frame, engine)), ("wrote", str(file))]
        if check:
            rows.append(("check", f"{wrong_pixels} pixels differ between the hardware and its model"))
        summarize(f"{rom.name}:", rows)
    if wrong_pixels:
        raise voxrt.SimulatorError(
            f"{rom}: {wrong_pixels} pixels differ between the hardware and its model; please report it with the file"
        )
