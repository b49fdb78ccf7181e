"""``voxrt view``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

import voxrt
from voxrt import octree
from voxrt import view as drawing
from voxrt.cli.arguments import Depth, Messages, Pixel, Pixels, Sight, choice, png, whole
from voxrt.cli.errors import UsageError
from voxrt.cli.messages import summarize
from voxrt.cli.source import Source, read_source
from voxrt.cli.trace import check_pixel
from voxrt.options.build_options import PREVIEW_SIZE
from voxrt.outputs import check_folder, writing
from voxrt.sources.source import as_text
from voxrt.view.animation import ANIMATION_SUFFIXES, write_animation
from voxrt.view.plotter import check_screen
from voxrt.view.scene_overlay import find_owners, preview_of, scene_triangles
from voxrt.views.writers import PANE_WRITERS

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from cyclopts import Token

    from voxrt.view import Pane, Preview

_TURNS = 72  # pictures of a turntable
_SIZE, _WIDE = (1024, 768), (1280, 720)


def _level(kind: type, tokens: Sequence[Token]) -> int:
    number = whole(kind, tokens)
    if not 0 <= number <= octree.MAX_DEPTH:
        raise ValueError(f"{number} is not 0 to {octree.MAX_DEPTH}")
    return number


def _cuts(_type: type, tokens: Sequence[Token]) -> tuple[tuple[int, int], ...]:
    cuts = []
    for token in tokens:
        axis, _, place = token.value.partition("=")
        if axis not in {"x", "y", "z"} or not place.isdecimal() or not 1 <= int(place) <= 1 << octree.MAX_DEPTH:
            raise ValueError(f"{token.value!r} is not AXIS=VOXEL, such as x=40")
        cuts.append(("xyz".index(axis), int(place)))
    return tuple(cuts)


def view(
    scene: Annotated[Path, Parameter(metavar="ROM|ASSET")],
    other: Annotated[Path | None, Parameter(metavar="ROM|ASSET")] = None,
    /,
    *,
    by: Annotated[Literal["material", "level", "owner"], Parameter(converter=choice)] = "material",
    clip: Annotated[Literal["x", "y", "z"] | None, Parameter(converter=choice)] = None,
    slice: Annotated[  # noqa: A002 - the option's name
        tuple[tuple[int, int], ...], Parameter(converter=_cuts, n_tokens=1, metavar="AXIS=N", show_default=False)
    ] = (),
    level_limit: Annotated[int | None, Parameter(converter=_level, metavar="N")] = None,
    overlay: Annotated[bool, Parameter(show_default=False)] = False,
    ray: Pixel | None = None,
    depth: Depth = None,
    size: Pixels | None = None,
    screenshot: Annotated[Path | None, Parameter(metavar="FILE")] = None,
    turntable: Annotated[Path | None, Parameter(metavar="FILE")] = None,
    output: Annotated[Path | None, Parameter(("--output", "-o"), metavar="FILE")] = None,
    reporting: Annotated[Messages, Parameter(name="*", show_default=False)] = Messages(),  # noqa: ARG001, B008
) -> None:
    """Show the octants of a memory or of an asset, in a window or as a picture.

    Octants that others cover on all six sides are left out. In the window, a click on an octant shows its address,
    word, level, bounds and material. A slider makes small octants uniform. The key c adds a plane that cuts.

    Parameters
    ----------
    scene
        A memory (.mem or another format), or an asset, which is built first.
    other
        A second memory or asset, shown beside the first and turned with it.
    by
        What the colours show. The owners of voxels, which are the objects of the scene, are known only for assets.
    clip
        Leave out the half of the scene that is nearer to the camera along this axis. Octants stay whole.
    slice
        Cut the octants at a plane, such as x=40, and leave out what is nearer to the camera. One plane per axis.
    level_limit
        Make octants of 2**N voxels per side uniform first, so that there are fewer octants.
    overlay
        Draw the triangles of the asset over its octants.
    ray
        Show the picture of the camera, and the path of this pixel's ray through the octants: column and row of
        640x480. In the window, a click chooses another pixel.
    depth
        Levels of the octree, for an asset or for a memory without a manifest.
    size
        Width and height in pixels. [default: 1024x768; 1280x720 with --ray or a second scene]
    screenshot
        Write this .png instead of opening a window.
    turntable
        Write this .gif or .mp4 instead of opening a window. It shows the octants from all sides.
    output
        Write this file instead of opening a window: .vox (MagicaVoxel), .npz (NumPy), .ply, .glb (glTF), .vtu
        (ParaView, PyVista), or .html (a page that needs no other file).
    reporting
        How results are printed.
    """
    _check_files(screenshot, turntable, output)
    _check_company(other, ray, clip and slice, turntable, output)
    paths = [path for path in (scene, other) if path is not None]
    sources = [read_source(path, depth) for path in paths]
    if output is None and screenshot is None and turntable is None:
        check_screen(off_screen=False)
    panes = [_pane(source, as_text(path.stem), by, overlay) for source, path in zip(sources, paths, strict=True)]
    if level_limit is not None:
        panes = [pane.coarsened(level_limit) for pane in panes]
    if clip:
        panes = [replace(pane, high=_half(pane, "xyz".index(clip))) for pane in panes]
    elif slice:
        panes = [replace(pane, high=_below(pane, slice), cut=True) for pane in panes]
    size = size or (_SIZE if other is None and ray is None else _WIDE)
    preview = None if ray is None else _preview(sources[0], panes[0], ray)
    rows = _told(panes)
    writers: list[tuple[Path | None, Callable[[Path], None]]] = [
        (output, lambda file: PANE_WRITERS[file.suffix.lower()](file, panes[0])),
        (screenshot, lambda file: voxrt.save_picture(drawing.picture(panes, size, preview=preview), file)),
        (turntable, lambda file: write_animation(file, drawing.turntable(panes, size, _TURNS))),
    ]
    for file, write in writers:
        if file is not None:
            with writing(file):
                write(file)
            rows.append(("wrote", str(file)))
    summarize(f"{scene.name}:", rows)
    if output is None and screenshot is None and turntable is None:
        drawing.Window(panes, size, preview=preview).show()


def _check_files(screenshot: Path | None, turntable: Path | None, output: Path | None) -> None:
    if output is not None and output.suffix.lower() not in PANE_WRITERS:
        raise UsageError(f"{output}: octants are written to files that end in {', '.join(PANE_WRITERS)}")
    if turntable is not None and turntable.suffix.lower() not in ANIMATION_SUFFIXES:
        raise UsageError(f"{turntable}: turntables are files that end in {' or '.join(ANIMATION_SUFFIXES)}")
    for file in (output, turntable, screenshot and png(screenshot)):
        if file is not None:
            check_folder(file.parent)


def _check_company(
    other: Path | None, ray: tuple[int, int] | None, both_cuts: object, turntable: Path | None, output: Path | None
) -> None:
    for first, second, excluded in (
        ("--ray", "a second scene", ray is not None and other is not None),
        ("--ray", "--turntable", ray is not None and turntable is not None),
        ("--output", "--ray", output is not None and ray is not None),
        ("--output", "a second scene", output is not None and other is not None),
        ("--clip", "--slice", both_cuts),
    ):
        if excluded:
            raise UsageError(f"{first} and {second} exclude each other")
    if ray is not None:
        check_pixel(ray, PREVIEW_SIZE)


def _pane(source: Source, name: str, by: Literal["material", "level", "owner"], overlay: bool) -> Pane:
    lighting = source.blob.lighting
    pane = drawing.Pane(replace(source.rom, name=name), by=by, flat=lighting is not None and lighting.flat)
    if by != "owner" and not overlay:
        return pane
    if source.scene is None or source.rom.grid is None:
        raise UsageError(
            f"{name}: a memory knows no {'owners' if by == 'owner' else 'triangles'}; name the asset instead"
        )
    if by == "owner":
        pane = replace(pane, owners=find_owners(source.scene, source.rom.grid))
    if overlay:
        pane = replace(pane, triangles=scene_triangles(source.scene, source.rom.grid))
    return pane


def _preview(source: Source, pane: Pane, ray: tuple[int, int]) -> Preview:
    return preview_of(pane.rom, source.camera(PREVIEW_SIZE, Sight()), PREVIEW_SIZE, ray, flat=pane.flat)


def _told(panes: list[Pane]) -> list[tuple[str, str]]:
    rows = []
    for pane in panes:
        mesh = pane.mesh()
        if len(panes) > 1:
            rows.append(("memory", pane.rom.name))
        rows.append(("shown", f"{len(mesh.levels):,} octants"))
        rows.append(("hidden", f"{mesh.hidden:,} octants"))
    return rows


def _half(pane: Pane, axis: int) -> tuple[int, int, int] | None:
    bounds = octree.solid_bounds(pane.rom.octree)
    return bounds and _below(pane, ((axis, (bounds[0][axis] + bounds[1][axis]) // 2),))


def _below(pane: Pane, cuts: tuple[tuple[int, int], ...]) -> tuple[int, int, int]:
    high = [pane.rom.octree.size] * 3
    for axis, place in cuts:
        high[axis] = min(high[axis], place)
    x, y, z = high
    return x, y, z
