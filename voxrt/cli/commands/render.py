"""``voxrt render``."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

import voxrt
from voxrt.cli.inputs.lighting import merge_lighting
from voxrt.cli.inputs.source import read_source
from voxrt.cli.results.build_results import print_json, render_result
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import cache_cost, picture_cost, summarize, warn
from voxrt.cli.terminal.progress import transfer_bar
from voxrt.octree import with_means
from voxrt.options.render_options import RenderOptions
from voxrt.options.view_options import CameraOptions
from voxrt.view.animation import ANIMATION_SUFFIXES
from voxrt.views.viewpoint import orbit
from voxrt.voxelize.free_memory import free_memory

if TYPE_CHECKING:
    from collections.abc import Sequence

    from voxrt import Camera, Frame, Lighting
    from voxrt.export import Blob
    from voxrt.octree import Animation, Rom
    from voxrt.options.picture_commands import RenderCommand
    from voxrt.sim import Dram

_TURNS = 72  # pictures of a turntable
_BYTES_PER_PIXEL = 9  # of an animation: colour, material and face, and what the writer of files takes


def run(command: RenderCommand) -> None:
    """Render a picture of a memory or an asset, with the same pixels as the hardware."""
    _check_path(command)
    file = command.output or Path(f"{command.scene.stem}.{'gif' if command.turntable else 'png'}")
    source = read_source(command.scene, command.depth, command.dialect, frames=True)
    blob = source.blob
    roots = _roots(blob, file, command)
    camera = source.camera(command.size, command.sight)
    memory = _with_means(blob) if command.lod else source.rom
    options = _options(command, merge_lighting(blob.lighting, command.lighting))
    engine = options.chosen_engine
    if command.cameras is not None:
        _take_path(command, memory, options, file, roots[0])
        return
    if command.turntable:
        _turn(command, memory, options, file, roots)
        return
    wrong_pixels = None
    if command.check:
        with transfer_bar() as show:
            keywords = replace(options, root=roots[0]).for_engines()
            checked = voxrt.check(memory, camera, **keywords, progress=partial(show, "check"))
        frame, wrong_pixels = getattr(checked, engine), checked.wrong_pixels
        frame.save(file)
    else:
        frame = _save(_rendered(memory, [(camera, root) for root in roots], options), file, blob.animation)
    if command.reporting.json:
        print_json(render_result(voxrt.Picture(frame, camera, engine), file, wrong_pixels))
    else:
        rows = [("picture", picture_cost(frame, engine))]
        if frame.cost.cache is not None:
            rows.append(("caches", cache_cost(frame.cost.cache, frame.cost.rays)))
        if len(roots) > 1:
            rows.append(("frames", f"{len(roots)}; the cost is that of the first"))
        rows.append(("wrote", str(file)))
        if command.check:
            rows.append(("check", f"{wrong_pixels} pixels differ between the hardware and its model"))
        summarize(f"{command.scene.name}:", rows)
    _refuse_wrong(command.scene, wrong_pixels)


def _options(command: RenderCommand, lighting: Lighting) -> RenderOptions:
    """Return what a command line says of a picture; of the memory's light, what the hardware can show."""
    if command.lod_cell is not None and not command.lod:
        raise UsageError("--lod-cell is of --lod; give both")
    is_lit = command.lighting.light is not None or command.lighting.bounces is not None
    if command.lod:
        if command.lighting.light is not None or command.lighting.bounces:
            raise UsageError("--lod does not go with --light or --bounces; leave them or --lod out")
        lighting = _unlit(lighting, "--lod goes without light and mirrors")
    dram = _dram(command)
    is_hardware = command.check or dram is not None or command.config is not None
    engine = command.engine or ("rtl" if is_hardware else "model")
    config = command.config or ("cached1" if command.lod else "lit" if lighting.features else "tiny")
    if (
        engine == "rtl"
        and not (command.config is None or command.lod or is_lit)
        and (lighting.features - voxrt.shader_features(config))
    ):
        lighting = _unlit(lighting, f"{config} has none, --config lit does")
    return RenderOptions(
        size=command.size,
        engine=engine,
        config=config,
        lighting=lighting,
        samples=command.samples,
        background=command.background,
        dram=dram,
        lod=(1.0 if command.lod_cell is None else command.lod_cell) if command.lod else 0.0,
    )


def _unlit(lighting: Lighting, why: str) -> Lighting:
    """Leave the memory's light and mirrors out, with a warning if there are some."""
    if not lighting.features:
        return lighting
    warn((voxrt.SceneWarning("light", f"the memory's light is left out: {why}"),))
    return lighting.within(set())


def _with_means(blob: Blob) -> Rom:
    """Return a memory with its mean materials, whether it was built with them or not."""
    if blob.rom.octree.means is not None:
        return blob.rom
    return with_means(blob.rom, blob.roots)


def _refuse_wrong(scene: Path, wrong_pixels: int | None) -> None:
    if wrong_pixels:
        raise voxrt.SimulatorError(
            f"{scene}: {wrong_pixels} pixels differ between the hardware and its model; please report it with the file"
        )


def _check_path(command: RenderCommand) -> None:
    """Refuse what does not go together with a path of cameras, or without one."""
    if command.scheduler is not None and command.workers is not None:
        raise UsageError("--scheduler and --workers exclude each other; give one of them")
    if command.cameras is None:
        if command.scheduler is not None or command.workers is not None:
            raise UsageError("--scheduler and --workers are for the pictures of a path: give --cameras as well")
        return
    if command.sight != CameraOptions():
        raise UsageError("--cameras says where the camera stands; leave --position, --look, --right and --up out")
    if command.turntable:
        raise UsageError("--turntable and --cameras exclude each other; give one of them")
    if command.output is not None and _is_animated(command.output):
        raise UsageError(f"{command.output}: the pictures of a path are PNG files; name a .png")


def _check_room(pictures: int, size: tuple[int, int]) -> None:
    """Refuse an animation whose pictures do not fit the free memory."""
    taken = pictures * size[0] * size[1] * _BYTES_PER_PIXEL
    if taken > free_memory() // 2:
        raise UsageError(
            f"{pictures} pictures of {size[0]}x{size[1]} take {taken / (1 << 30):.1f} GB of memory, which is too much; "
            "choose a smaller --size"
        )


def _is_animated(file: Path) -> bool:
    return file.suffix.lower() in ANIMATION_SUFFIXES


def _turn(command: RenderCommand, memory: Rom, options: RenderOptions, file: Path, roots: tuple[int, ...]) -> None:
    """Save pictures from all around a scene as one file, and say what they cost."""
    excluded = {
        "--check": command.check,
        "--json": command.reporting.json,
        "a camera": command.sight != CameraOptions(),
    }
    for name, is_given in excluded.items():
        if is_given:
            raise UsageError(f"--turntable and {name} exclude each other; leave one of them out")
    if not _is_animated(file):
        raise UsageError(f"{file}: a turntable is a .gif, .webp or .mp4; name one of these")
    if command.background == "transparent":
        raise UsageError(f"{file}: a {file.suffix} has no transparent background; name another one")
    _check_room(_TURNS, options.size)
    cameras = orbit(memory, options.size, _TURNS, roots=roots)
    frames = _rendered(memory, [(camera, roots[0]) for camera in cameras], options)
    voxrt.save_animation([one.colour for one in frames], file)
    seconds = sum(one.cost.seconds for one in frames)
    width, height = options.size
    rows = [
        ("pictures", f"{_TURNS}, {width}x{height} by {options.chosen_engine}: {seconds:.2f} s"),
        ("wrote", str(file)),
    ]
    summarize(f"{command.scene.name}:", rows)


def _rendered(memory: Rom, views: Sequence[tuple[Camera, int]], options: RenderOptions) -> list[Frame]:
    """Render a memory from some cameras, each with the root of its frame, and show the rows that are done."""
    if len(views) == 1 and options.chosen_engine == "model":  # sooner done than a bar is shown
        return [voxrt.render(memory, views[0][0], options, root=views[0][1])]
    frames: list[Frame] = []
    with transfer_bar() as show:

        def report(done: int, total: int) -> None:
            show("render", len(frames) * total + done, len(views) * total)

        for camera, root in views:
            frames.append(voxrt.render(memory, camera, options, root=root, progress=report))
    return frames


def _save(frames: list[Frame], file: Path, animation: Animation | None) -> Frame:
    """Save frames, and return the first."""
    if _is_animated(file):
        voxrt.save_animation([one.colour for one in frames], file, animation.period if animation else None)
    else:
        frames[0].save(file)
    return frames[0]


def _take_path(command: RenderCommand, memory: Rom, options: RenderOptions, file: Path, root: int) -> None:
    """Render a picture for each camera of a file, save them, and say what they cost."""
    from voxrt.building.camera_path import PictureJob, read_cameras, take_pictures  # noqa: PLC0415 - most pictures are one

    assert command.cameras is not None
    job = PictureJob(memory, replace(options, root=root), command.check)
    path, results, wrong = read_cameras(command.cameras, memory, command.size), [], 0
    for picture in take_pictures(job, path, command.scheduler, command.workers):
        target = file.with_stem(f"{file.stem}-{picture.number:04d}")
        picture.frame.save(target)
        wrong += picture.wrong_pixels or 0
        view = voxrt.Picture(picture.frame, path[picture.number], options.chosen_engine)
        results.append(render_result(view, target, picture.wrong_pixels))
    if command.reporting.json:
        print_json(results)
    else:
        rows = [("pictures", f"{len(results)}"), ("wrote", f"{file.with_stem(file.stem + '-0000')} and so on")]
        if command.check:
            rows.append(("check", f"{wrong} pixels differ between the hardware and its model"))
        summarize(f"{command.scene.name}:", rows)
    _refuse_wrong(command.scene, wrong)


def _roots(blob: Blob, file: Path, command: RenderCommand) -> tuple[int, ...]:
    """Return the roots of the frames that are asked for."""
    roots, frame = blob.roots, command.frame
    if command.turntable or not _is_animated(file):
        blob.frame(frame or 0)  # refuses one that is not there
        return roots[frame or 0 : (frame or 0) + 1]
    if blob.animation is None:
        raise UsageError(
            f"{file}: a {file.suffix} is of an animation, and the memory has one frame; "
            "name a .png, or give --turntable"
        )
    if frame is not None:
        raise UsageError(f"{file}: a {file.suffix} has all frames; leave --frame out, or name a .png")
    if command.check:
        raise UsageError("--check is of one frame: name a .png, and the frame by --frame")
    if command.background == "transparent":
        raise UsageError(f"{file}: a {file.suffix} has no transparent background; name another one")
    _check_room(len(roots), command.size)
    return roots


def _dram(command: RenderCommand) -> Dram | None:
    """Give the external memory that the command line describes; None where it says nothing of one."""
    clocks = {name: getattr(command, name) for name in ("latency", "interval", "jitter")}
    known = {name: value for name, value in clocks.items() if value is not None}
    try:
        return voxrt.sim.Dram(**known, seed=1 if command.jitter else 0) if known else None
    except ValueError as error:
        raise UsageError(f"--{error}") from error
