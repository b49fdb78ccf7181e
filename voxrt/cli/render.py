"""``voxrt render``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, NamedTuple

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import (
    Backdrop,
    Depth,
    Pixels,
    Reporting,
    Sight,
    cell_width,
    choice,
    picture_file,
    place,
    processes,
    whole,
)
from voxrt.cli.errors import UsageError
from voxrt.cli.messages import cache_cost, picture_cost, summarize, warn
from voxrt.cli.results import print_json, render_result
from voxrt.cli.source import read_source
from voxrt.octree import with_means
from voxrt.options.build_options import Dialect, Engine  # noqa: TC001 - cyclopts reads the signature

if TYPE_CHECKING:
    from voxrt import Camera, Frame, Lighting
    from voxrt.export import Blob
    from voxrt.octree import Animation, Rom
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
    frame: Annotated[int | None, Parameter(converter=whole, metavar="K")] = None,
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
    lod: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
    lod_cell: Annotated[float | None, Parameter(converter=cell_width, metavar="PIXELS")] = None,
    check: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
    cameras: Annotated[Path | None, Parameter(metavar="FILE")] = None,
    scheduler: Annotated[str | None, Parameter(metavar="ADDRESS")] = None,
    workers: Annotated[int | None, Parameter(converter=processes, metavar="N")] = None,
    reporting: Annotated[Reporting, Parameter(name="*", negative=(), show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Render a picture of a memory or an asset, with the same pixels as the hardware.

    Parameters
    ----------
    scene
        A memory: .mem or another format. Its manifest, the .json beside it, states materials, depth and dialect. Or an
        asset, which is built first.
    output
        The picture, a .png; or a .gif of all frames of an animation. The default is NAME.png in this folder.
    engine
        rtl: the verilated hardware, which counts its clock cycles. model: the exact C++ model, which is faster. Both
        give the same pixels.
    config
        The configuration of the hardware: its lanes, its memory, the features of its shader. The default is tiny, or
        lit if light or mirrors are asked for, or cached1 with --lod.
    size
        Width and height in pixels. [default: 640x480]
    sight
        The camera.
    frame
        Frame of an animation, counted from 0, for a .png. The camera is that of all frames. [default: 0]
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
    lod
        Level of detail: rays stop at cells that are not wider than a pixel and show the mean material of what is in
        them. A memory that was built without --lod gets its mean materials first.
    lod_cell
        With --lod: the width of the widest cell that rays stop at, in pixels. With 0.5 pictures are closest to smooth
        ones, with 2 they take the fewest cycles. [default: 1]
    check
        Render with both engines and count the pixels that differ. Any difference is an error.
    cameras
        Render a picture for each camera of a JSON file: a list of objects with position, look, right and up, three
        numbers each, as the options of these names. The pictures are NAME-0000.png and so on.
    scheduler
        With --cameras: render on the cluster of this Dask scheduler, such as tcp://host:8786.
    workers
        With --cameras: render by so many processes of this machine.
    reporting
        How results are printed.
    """
    _check_path(cameras, output, sight, scheduler, workers)
    file = picture_file(Path(f"{scene.stem}.png") if output is None else output)
    source = read_source(scene, depth, dialect, frames=True)
    blob, memory = source.blob, source.rom
    roots = _roots(blob, file, frame, check=check, background=background)
    camera = source.camera(size, sight)
    lighting = _lighting(blob.lighting, light, ambient, bounces, shading)
    if lod_cell is not None and not lod:
        raise UsageError("--lod-cell is of --lod; give both")
    if lod:
        lighting = _unlit(lighting, "--lod goes without light and mirrors", light, bounces)
        memory = _with_means(blob)
    if config is None:
        config = _default_config(lighting, lod=lod)
    elif engine == "rtl" and lighting.features - voxrt.shader_features(config) and light is None and bounces is None:
        lighting = _unlit(lighting, f"{config} has none, --config lit does")
    dram = _dram(latency, interval, jitter)
    cell = (1.0 if lod_cell is None else lod_cell) if lod else 0.0
    asked = _Asked(memory, camera, size, roots, engine, config, lighting, samples, background, dram, cell)
    if cameras is not None:
        asked.take_path(scene, cameras, file, Cluster(scheduler, workers), check=check, json=reporting.json)
        return
    shown, wrong_pixels = asked.check(file) if check else (asked.render(file, blob.animation), None)
    if reporting.json:
        print_json(render_result(voxrt.Picture(shown, camera, engine), file, wrong_pixels))
    else:
        rows = [("picture", picture_cost(shown, engine))]
        if shown.cost.cache is not None:
            rows.append(("caches", cache_cost(shown.cost.cache, shown.cost.rays)))
        if len(roots) > 1:
            rows.append(("frames", f"{len(roots)}; the cost is that of the first"))
        rows.append(("wrote", str(file)))
        if check:
            rows.append(("check", f"{wrong_pixels} pixels differ between the hardware and its model"))
        summarize(f"{scene.name}:", rows)
    _refuse_wrong(scene, wrong_pixels)


class Cluster(NamedTuple):
    """Where the pictures of a path are rendered: nowhere else, if both are None."""

    scheduler: str | None
    workers: int | None


def _refuse_wrong(scene: Path, wrong_pixels: int | None) -> None:
    if wrong_pixels:
        raise voxrt.SimulatorError(
            f"{scene}: {wrong_pixels} pixels differ between the hardware and its model; please report it with the file"
        )


def _default_config(lighting: Lighting, *, lod: bool) -> str:
    """Return the smallest configuration that has what is asked for."""
    if lod:
        return "cached1"
    return "lit" if lighting.features else "tiny"


def _with_means(blob: Blob) -> Rom:
    """Return a memory with its mean materials, whether it was built with them or not."""
    if blob.rom.octree.means is not None:
        return blob.rom
    return with_means(blob.rom, (0,) if blob.animation is None else blob.animation.roots)


def _unlit(lighting: Lighting, why: str, light: Triple | None = None, bounces: int | None = None) -> Lighting:
    """Leave the memory's light and mirrors out, with a warning if there are some; refuse those asked for."""
    if light is not None or bounces:
        raise UsageError("--lod does not go with --light or --bounces; leave them or --lod out")
    if not lighting.features:
        return lighting
    warn((voxrt.SceneWarning("light", f"the memory's light is left out: {why}"),))
    return replace(lighting, on=False, bounces=0)


def _check_path(
    cameras: Path | None, output: Path | None, sight: Sight, scheduler: str | None, workers: int | None
) -> None:
    """Refuse what does not go together with a path of cameras, or without one."""
    if scheduler is not None and workers is not None:
        raise UsageError("--scheduler and --workers exclude each other; give one of them")
    if cameras is None:
        if scheduler is not None or workers is not None:
            raise UsageError("--scheduler and --workers are for the pictures of a path: give --cameras as well")
        return
    if sight != Sight():
        raise UsageError("--cameras says where the camera stands; leave --position, --look, --right and --up out")
    if output is not None and output.suffix.lower() == ".gif":
        raise UsageError(f"{output}: the pictures of a path are PNG files; name a .png")


class _Asked(NamedTuple):
    """Frames that are asked for."""

    memory: Rom
    camera: Camera
    size: tuple[int, int]
    roots: tuple[int, ...]
    engine: Engine
    config: str
    lighting: Lighting
    samples: int
    background: tuple[int, int, int] | Literal["transparent"] | None
    dram: Dram | None
    lod: float

    def render(self, file: Path, animation: Animation | None) -> Frame:
        """Render and save them, and return the first."""
        frames = [
            voxrt.render(
                self.memory,
                self.camera,
                size=self.size,
                engine=self.engine,
                config=self.config,
                lighting=self.lighting,
                samples=self.samples,
                background=self.background,
                dram=self.dram,
                root=root,
                lod=self.lod,
            )
            for root in self.roots
        ]
        if file.suffix.lower() == ".gif":
            voxrt.save_animation([one.colour for one in frames], file, animation.period if animation else None)
        else:
            voxrt.save_picture(frames[0].colour, file)
        return frames[0]

    def take_path(self, scene: Path, cameras: Path, file: Path, cluster: Cluster, *, check: bool, json: bool) -> None:
        """Render a picture for each camera of a file, save them, and say what they cost."""
        from voxrt.building.camera_path import PictureJob, read_cameras, take_pictures  # noqa: PLC0415 - most pictures are one

        job = PictureJob(
            self.memory,
            self.size,
            self.engine,
            self.config,
            self.lighting,
            self.samples,
            self.background,
            self.dram,
            self.roots[0],
            self.lod,
            check,
        )
        path, results, wrong = read_cameras(cameras, self.memory, self.size), [], 0
        for picture in take_pictures(job, path, cluster.scheduler, cluster.workers):
            target = file.with_stem(f"{file.stem}-{picture.number:04d}")
            voxrt.save_picture(picture.frame.colour, target)
            wrong += picture.wrong_pixels or 0
            shown = voxrt.Picture(picture.frame, path[picture.number], self.engine)
            results.append(render_result(shown, target, picture.wrong_pixels))
        if json:
            print_json(results)
        else:
            rows = [("pictures", f"{len(results)}"), ("wrote", f"{file.with_stem(file.stem + '-0000')} and so on")]
            if check:
                rows.append(("check", f"{wrong} pixels differ between the hardware and its model"))
            summarize(f"{scene.name}:", rows)
        _refuse_wrong(scene, wrong)

    def check(self, file: Path) -> tuple[Frame, int]:
        """Render the first with both engines and save it; return it and the number of pixels that differ."""
        checked = voxrt.check(
            self.memory,
            self.camera,
            self.size,
            lighting=self.lighting,
            samples=self.samples,
            background=self.background,
            config=self.config,
            dram=self.dram,
            root=self.roots[0],
            lod=self.lod,
        )
        frame: Frame = getattr(checked, self.engine)
        voxrt.save_picture(frame.colour, file)
        return frame, checked.wrong_pixels


def _roots(blob: Blob, file: Path, frame: int | None, *, check: bool, background: object) -> tuple[int, ...]:
    """Return the roots of the frames that are asked for."""
    roots = (0,) if blob.animation is None else blob.animation.roots
    if file.suffix.lower() != ".gif":
        blob.frame(frame or 0)  # refuses one that is not there
        return roots[frame or 0 : (frame or 0) + 1]
    if blob.animation is None:
        raise UsageError(f"{file}: a .gif is of an animation, and the memory has one frame; name a .png")
    if frame is not None:
        raise UsageError(f"{file}: a .gif has all frames; leave --frame out, or name a .png")
    if check:
        raise UsageError("--check is of one frame: name a .png, and the frame by --frame")
    if background == "transparent":
        raise UsageError(f"{file}: a .gif has no transparent background; name another one")
    return roots


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
