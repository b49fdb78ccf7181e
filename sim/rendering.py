"""Frames from the verilated ray tracer or from the exact model, and the two held against each other."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING, Literal, TypeAlias, get_args

import numpy as np
from msgspec.structs import replace

from voxrt.octree import Rom, frame_octree
from voxrt.octree.camera import BOUNCE_LIMIT, DIRECTION_LIMIT, PLAIN_LIGHTING, SAMPLES, lod_scale, sample_cameras
from voxrt.sim import _model
from voxrt.sim.engine_arguments import palette_of, registers_of, shading_of
from voxrt.sim.errors import SimulatorError
from voxrt.sim.frame import Frame, RenderCost
from voxrt.sim.hardware import render_hardware
from voxrt.sim.samples import join_samples, put_background
from voxrt.voxelize.arguments import choice, real, text, whole, whole_array
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from voxrt.octree.camera import Camera, Lighting
    from voxrt.sim.external_memory import Dram
    from voxrt.sim.samples import Background

Engine: TypeAlias = Literal["rtl", "model"]

_FACES = 6
_FRAME_LIMIT = 1 << 14
_WIDEST_CELL = 1024.0  # in pixels


class EngineCheck(Value, frozen=True, eq=False):
    """The same view from both engines, as :func:`check` returns it.

    Attributes
    ----------
    rtl, model
        The two frames.
    wrong
        bool, shape (H, W): pixels of which a sample differs in colour, material or face.
    """

    rtl: Frame
    model: Frame
    wrong: NDArray[np.bool_]

    @property
    def wrong_pixels(self) -> int:
        """The number of pixels that differ."""
        return int(np.count_nonzero(self.wrong))


def render(
    rom: Rom,
    camera: Camera,
    size: tuple[int, int],
    *,
    engine: Engine,
    lighting: Lighting = PLAIN_LIGHTING,
    samples: int = 1,
    background: Background | None = None,
    threads: int = 0,
    config: str = "tiny",
    dram: Dram | None = None,
    root: int = 0,
    lod: float = 0.0,
    progress: Callable[[int, int], None] | None = None,
) -> Frame:
    """Render a frame.

    Parameters
    ----------
    rom
        The memory and its materials. The colour of entry 0 is the background.
    camera
        The camera.
    size
        Columns and rows, 1 … 16384 each.
    engine
        ``"rtl"`` is the verilated ray tracer, which counts its clock cycles. ``"model"`` is the exact C++ model. Both
        give the same pixels.
    lighting
        Brightness of faces, point light and mirrors.
    samples
        Rays per pixel on each axis, 1, 2 or 4, averaged in linear light. Each is a frame of its own, of a camera moved
        by a part of a pixel: :func:`~voxrt.octree.camera.sample_cameras`.
    background
        sRGB, 0 … 255 each, in place of the colour of entry 0; or ``"transparent"``.
    threads
        Threads of the model; 0 takes one per core. The frame does not depend on it.
    config
        The configuration of the ray tracer for ``"rtl"``.
    dram
        The external memory of a configuration that has caches; None takes ``Dram()``.
    root
        The word of the memory that is the root of what is rendered: the register ``root``. The frames of an animation
        (:class:`~voxrt.octree.Animation`) have roots of their own.
    lod
        Level of detail: the width in pixels of the widest cell that rays stop at, below 1024; True is 1. 0: they go
        down to the leaves. The memory needs mean materials: :func:`~voxrt.octree.with_means`. Not with a light or
        mirrors.
    progress
        Called now and then with the rows that are done and those of all samples. The model does a sample at once.

    Returns
    -------
    Frame
        The pixels and what they cost. `material` and `face` are those of the first sample.

    Raises
    ------
    TypeError, ValueError
        An argument of the wrong type or out of range.
    NoSuchConfigurationError
        The installation has no ray tracer of that configuration.
    SimulatorError
        The ray tracer is not in this installation, cannot hold the memory or the camera, or has no such shading or no
        level of detail. A direction or the light is out of range. The memory has no mean materials.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.octree import Rom, from_points
    >>> from voxrt.sim import frame_scene
    >>> from voxrt.voxelize import EMPTY, Material
    >>> rom = Rom("dot", from_points([[1, 1, 1]], [1], depth=2), (EMPTY, Material("red", (255, 0, 0))))
    >>> frame = render(rom, frame_scene(rom, (32, 32)), (32, 32), engine="model")
    >>> frame.colour.shape, frame.cost.rays, bool(frame.material.any())
    ((32, 32, 3), 1024, True)
    """
    choice("engine", engine, get_args(Engine))
    if engine == "model" and dram is not None:
        raise SimulatorError("the model has no external memory: leave dram out, or render with --engine rtl")
    shown = put_background(rom, background)
    frames = _prepare(
        shown, camera, size, lighting=lighting, samples=samples, threads=threads, config=config, root=root, lod=lod
    )
    return join_samples(frames(engine, dram, progress), background)


def check(
    rom: Rom,
    camera: Camera,
    size: tuple[int, int],
    *,
    lighting: Lighting = PLAIN_LIGHTING,
    samples: int = 1,
    background: Background | None = None,
    threads: int = 0,
    config: str = "tiny",
    dram: Dram | None = None,
    root: int = 0,
    lod: float = 0.0,
    progress: Callable[[int, int], None] | None = None,
) -> EngineCheck:
    """Render with both engines and compare every sample of every pixel.

    Parameters
    ----------
    rom, camera, size, lighting, samples, background, threads, config, dram, root, lod
        As for :func:`render`.
    progress
        As for :func:`render`: the rows of the ray tracer, since the model takes no time beside it.

    Returns
    -------
    EngineCheck
        Both frames, and the pixels that differ.

    Raises
    ------
    TypeError, ValueError, NoSuchConfigurationError, SimulatorError
        As :func:`render` does.

    Examples
    --------
    >>> from voxrt.octree import Rom, from_points
    >>> from voxrt.sim import frame_scene
    >>> from voxrt.voxelize import EMPTY, Material
    >>> rom = Rom("dot", from_points([[1, 1, 1]], [1], depth=2), (EMPTY, Material("red", (255, 0, 0))))
    >>> check(rom, frame_scene(rom, (32, 32)), (32, 32)).wrong_pixels
    0
    """
    shown = put_background(rom, background)
    frames = _prepare(
        shown, camera, size, lighting=lighting, samples=samples, threads=threads, config=config, root=root, lod=lod
    )
    rtl, model = frames("rtl", dram, progress), frames("model", None, None)
    wrong = np.any([_apart(hardware, exact) for hardware, exact in zip(rtl, model, strict=True)], axis=0)
    return EngineCheck(rtl=join_samples(rtl, background), model=join_samples(model, background), wrong=wrong)


def _prepare(
    rom: Rom,
    camera: Camera,
    size: tuple[int, int],
    *,
    lighting: Lighting,
    samples: int,
    threads: int,
    config: str,
    root: int,
    lod: float,
) -> Callable[[Engine, Dram | None, Callable[[int, int], None] | None], list[Frame]]:
    """Check what both engines are asked; return what renders the samples of a frame by one of them."""
    width, height = whole_array("size", size, (2,), np.int64, low=1, high=_FRAME_LIMIT).tolist()
    size = width, height
    if whole("samples", samples, 1, max(SAMPLES)) not in SAMPLES:
        raise ValueError(f"samples must be {', '.join(map(str, SAMPLES))}, not {samples}")
    _check_directions(camera, size)
    check_lighting(lighting)
    cameras = sample_cameras(camera, size, samples)
    for one in cameras[1:]:
        _check_directions(one, size)
    root = whole("root", root, 0, len(rom.octree.words) - 1)
    lod = _checked_lod(rom, lighting, lod)

    def frames(engine: Engine, dram: Dram | None, progress: Callable[[int, int], None] | None) -> list[Frame]:
        def report(rows: int) -> None:
            if progress is not None:
                progress(len(done) * height + rows, len(cameras) * height)

        done: list[Frame] = []
        if engine == "model":
            alone = replace(rom, octree=frame_octree(rom.octree, root))
            draw = partial(_render_model, alone, threads=whole("threads", threads, 0, 1024))
        else:
            draw = partial(
                render_hardware, rom, config=text("config", config), dram=dram, root=root, lod=lod, progress=report
            )
        for one in cameras:
            done.append(draw(one, size, lighting, scale=lod_scale(one, lod) if lod else 0))
            report(0)
        return done

    return frames


def _apart(one: Frame, other: Frame) -> NDArray[np.bool_]:
    colour = np.any(one.colour != other.colour, axis=2)
    apart: NDArray[np.bool_] = colour | (one.material != other.material) | (one.face != other.face)
    return apart


def _render_model(
    rom: Rom, camera: Camera, size: tuple[int, int], lighting: Lighting, *, threads: int, scale: int
) -> Frame:
    started = time.perf_counter()
    pixels = _model.Memory(rom.octree.words, rom.octree.depth).render(
        palette_of(rom.materials),
        registers_of(camera),
        size[0],
        size[1],
        threads,
        **shading_of(rom, lighting),
        means=rom.octree.means if scale else None,
        lod_scale=scale,
    )
    return Frame(
        colour=pixels.colour,
        material=pixels.material,
        face=pixels.face,
        cost=RenderCost(size[0] * size[1], None, None, time.perf_counter() - started),
    )


def _check_directions(camera: Camera, size: tuple[int, int]) -> None:
    # Directions are linear in the pixel: the largest stand in the corners.
    largest = max(
        abs(look + right * column + up * row)
        for look, right, up in zip(camera.look, camera.right, camera.up, strict=True)
        for column in (-(size[0] // 2), size[0] - 1 - size[0] // 2)
        for row in (size[1] // 2, size[1] // 2 + 1 - size[1])
    )
    if largest >= DIRECTION_LIMIT:
        raise SimulatorError(
            f"the camera's directions reach {largest} at the frame's corners, which is not below 2**20; "
            "scale look, right and up down together"
        )


def _checked_lod(rom: Rom, lighting: Lighting, lod: float) -> float:
    if not lod:
        return 0.0
    lod = 1.0 if lod is True else real("lod", lod, above=0.0, below=_WIDEST_CELL)
    if lighting.on or lighting.bounces:
        raise SimulatorError("level of detail does not go with a light or mirrors; render without them, or without lod")
    if rom.octree.means is None:
        raise SimulatorError(f"{rom.name} has no mean materials; build it with --lod")
    return lod


def check_lighting(lighting: Lighting) -> None:
    """Refuse a lighting that the engines cannot have; SimulatorError says why."""
    if not 0 <= lighting.bounces <= BOUNCE_LIMIT:
        raise SimulatorError(f"{lighting.bounces} reflections are not 0 … {BOUNCE_LIMIT}")
    if lighting.faces is not None and not (
        len(lighting.faces) == _FACES and all(0 <= face <= 255 for face in lighting.faces)
    ):
        raise SimulatorError(f"the brightness of faces {lighting.faces} is not six numbers of 0 … 255")
    if not lighting.on:
        return
    if not 0 <= lighting.ambient <= 255:
        raise SimulatorError(f"an ambient brightness of {lighting.ambient} is not 0 … 255")
    if max(abs(value) for value in lighting.position) >= 1 << 31:
        raise SimulatorError(f"the light at {lighting.position} is not within signed 32 bits of 1/16 voxel")
