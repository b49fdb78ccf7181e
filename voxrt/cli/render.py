"""``voxrt render``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Pixels, Reporting, levels, place, png, register, whole
from voxrt.cli.messages import picture_cost, summarize, warn
from voxrt.cli.results import print_json, render_result

Triple = tuple[int, int, int]
_register = Parameter(converter=register, n_tokens=1, metavar="X,Y,Z", allow_leading_hyphen=True)


def render(
    rom: Annotated[Path, Parameter(metavar="ROM")],
    /,
    *,
    output: Annotated[Path | None, Parameter(("--output", "-o"), metavar="FILE")] = None,
    engine: Literal["rtl", "model"] = "rtl",
    config: Annotated[str, Parameter(metavar="NAME")] = "tiny",
    size: Pixels = (640, 480),
    position: Annotated[
        Triple | None, Parameter(converter=place, n_tokens=1, metavar="X,Y,Z", allow_leading_hyphen=True)
    ] = None,
    look: Annotated[Triple | None, _register] = None,
    right: Annotated[Triple | None, _register] = None,
    up: Annotated[Triple | None, _register] = None,
    depth: Annotated[int | None, Parameter(converter=levels, metavar="N")] = None,
    dialect: Literal["report", "seed-rtl", "msb"] | None = None,
    light: Annotated[
        Triple | None, Parameter(converter=place, n_tokens=1, metavar="X,Y,Z", allow_leading_hyphen=True)
    ] = None,
    ambient: Annotated[int, Parameter(converter=whole, metavar="N")] = 32,
    bounces: Annotated[int, Parameter(converter=whole, metavar="N")] = 0,
    flat: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
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
        The configuration of the hardware: how many lanes, which memory, which features of the shader.
    size
        Width and height, pixels. [default: 640x480]
    position
        Where the camera stands, voxels, in steps of 1/16; may be outside the scene. Not given, it stands where the
        whole scene is in the picture.
    look
        Register: the direction of the picture's middle. Given without --right and --up it is a direction of any length;
        not given, the camera looks at the scene.
    right
        Register: the step of direction from a pixel to the one on its right. Not given: right = look x up.
    up
        Register: the step of direction from a pixel to the one above it. Not given: upright.
    depth
        Levels of the octree, where no manifest says.
    dialect
        How the memory spells a material, where no manifest says.
    light
        Where a light stands that casts shadows, voxels, in steps of 1/16. Without it the camera is the light.
    ambient
        The brightness of shadows, 0 to 255.
    bounces
        How often mirrors reflect a ray, 0 to 15; with 0 they are like all other materials.
    flat
        Show materials in their own colour, whatever the angle.
    check
        Render with both engines, count the pixels on which they differ, fail if there are any.
    reporting
        How to tell what was done.
    """
    file = png(Path(f"{rom.stem}.png") if output is None else output)
    blob, warnings = voxrt.read_any(rom, depth=depth, dialect=dialect)
    warn(warnings)
    memory, view = blob.rom, blob.view
    if view is not None and (position, look, right, up) == (None, None, None, None):
        camera = voxrt.Camera(view.position, view.look, view.right, view.up)
    else:
        camera = voxrt.aim_camera(memory, size, position=position, look=look, right=right, up=up)
    shading = voxrt.Shading(flat, None if light is None else voxrt.Light(light, ambient), bounces)
    wrong_pixels = None
    if check:
        checked = voxrt.check(memory, camera, size, shading=shading, config=config)
        frame, wrong_pixels = getattr(checked, engine), checked.wrong_pixels
    else:
        frame = voxrt.render(memory, camera, size=size, engine=engine, shading=shading, config=config)
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
