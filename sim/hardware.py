"""Frames of the verilated ray tracer."""

from __future__ import annotations

import threading
import time
from typing import TYPE_CHECKING, Any

from voxrt.octree import Rom, encode
from voxrt.octree.camera import DIRECTION_LIMIT, POSITION_UNITS
from voxrt.sim.engine_arguments import palette_of, registers_of, shading_of
from voxrt.sim.errors import NoSuchConfigurationError, SimulatorError
from voxrt.sim.external_memory import CacheCost, Dram
from voxrt.sim.frame import Frame, RenderCost
from voxrt.sim.verilated import import_verilated

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.octree.camera import Camera, Lighting

_FRAME_LIMIT = (1 << 12) - 1
_CACHE_COUNTS = ("words_read", "word_requests", "line_requests", "lines_read")


class _LastTracer(threading.local):
    """The ray tracer that a thread simulated last: to make one takes as long as 50,000 clocks of it."""

    def __init__(self) -> None:
        self._kept: tuple[str, Any] = "", None

    def take(self, config: str, _rtl: Any) -> Any:  # noqa: ANN401 - of the native module
        """Return it if it has that configuration, else a new one. It is not the last one any more."""
        (name, tracer), self._kept = self._kept, ("", None)
        return tracer if name == config else _rtl.Tracer(config)

    def put_back(self, config: str, tracer: Any) -> None:  # noqa: ANN401
        """Keep one whose frame is complete. Frames begin with a reset, which leaves words in caches."""
        if not tracer.cached:
            self._kept = config, tracer


_LAST_TRACER = _LastTracer()


def shader_features(config: str) -> frozenset[str]:
    """Return the shading features that a configuration of the ray tracer has built in.

    Parameters
    ----------
    config
        The configuration's name.

    Returns
    -------
    frozenset[str]
        Some of ``"light"``, ``"mirrors"`` and ``"lod"``.

    Raises
    ------
    NoSuchConfigurationError
        The installation has no ray tracer of that configuration.
    SimulatorError
        The ray tracer is not in this installation.

    Examples
    --------
    >>> sorted(shader_features("lit"))
    ['light', 'mirrors']
    """
    return frozenset(_ray_tracer(config).FEATURES[config])


def render_hardware(
    rom: Rom,
    camera: Camera,
    size: tuple[int, int],
    lighting: Lighting,
    *,
    config: str,
    dram: Dram | None,
    root: int,
    scale: int,
    lod: float,
    progress: Callable[[int], None] | None,
) -> Frame:
    """Render a frame on the verilated ray tracer.

    Arguments and errors are those of :func:`voxrt.sim.render`, checked. `scale` is the register ``lod.scale``; 0
    without level of detail. `progress` is called with the rows done.
    """
    started = time.perf_counter()
    _rtl = _ray_tracer(config)
    tracer = _LAST_TRACER.take(config, _rtl)
    if absent := lighting.features - shader_features(config):
        raise SimulatorError(
            f"ray tracer configuration {config!r} is built without {' and '.join(sorted(absent))}; "
            "take configuration 'lit' or render with --engine model"
        )
    if lod and "lod" not in shader_features(config):
        raise SimulatorError(
            f"ray tracer configuration {config!r} is built without level of detail; take one with caches, such as "
            "'cached1', or render with --engine model"
        )
    check_fits(tracer, config, rom, camera=camera, size=size, lighting=lighting)
    if dram is not None and not tracer.cached:
        raise SimulatorError(
            f"ray tracer configuration {config!r} has its memory on the chip, without latency or interval; "
            "take one with caches, such as 'cached4'"
        )
    memory = Dram() if dram is None else dram
    words = encode(rom.octree.words, "lod", rom.octree.means) if lod else rom.octree.words
    tracer.load(words, lod_words=bool(lod))
    pixels = tracer.render(
        registers_of(camera),
        size[0],
        size[1],
        rom.octree.depth,
        palette_of(rom.materials),
        **shading_of(rom, lighting),
        latency=memory.latency,
        interval=memory.interval,
        jitter=memory.jitter,
        dram_seed=memory.seed,
        lod_scale=scale,
        root=root,
        progress=progress,
    )
    if pixels["errors"] == ["direction overflow"]:  # the camera's directions fit: it is the light's
        raise SimulatorError(
            f"the light is {DIRECTION_LIMIT // (2 * POSITION_UNITS)} voxels or more from what it should light: "
            "too far for the ray tracer; move it nearer or render with --engine model"
        )
    if pixels["errors"]:
        raise SimulatorError(f"the ray tracer reports {', '.join(pixels['errors'])} in its frame of {rom.name}")
    _LAST_TRACER.put_back(config, tracer)
    return Frame(
        colour=pixels["colour"],
        material=pixels["material"],
        face=pixels["face"],
        cost=RenderCost(
            size[0] * size[1],
            pixels["words_read"],
            pixels["cycles"],
            time.perf_counter() - started,
            CacheCost(*(pixels[count] for count in _CACHE_COUNTS)) if tracer.cached else None,
        ),
    )


def check_fits(
    tracer: Any,  # noqa: ANN401 - of the native module
    config: str,
    rom: Rom,
    *,
    camera: Camera,
    size: tuple[int, int],
    lighting: Lighting,
) -> None:
    """Refuse what a ray tracer's memory or registers do not hold, by a SimulatorError."""
    place = tuple(value / POSITION_UNITS for value in camera.position)
    for misfit, problem in (
        (len(rom.octree.words) > tracer.memory_words, f"{len(rom.octree.words)} words; it holds {tracer.memory_words}"),
        (rom.octree.depth > tracer.max_depth, f"a depth of {rom.octree.depth}; it goes to {tracer.max_depth}"),
        (
            not all(-tracer.position_limit <= value < tracer.position_limit for value in camera.position),
            f"a camera at {place} voxels; it reaches ±{tracer.position_limit // POSITION_UNITS}",
        ),
        (
            lighting.on and not all(-tracer.light_limit <= value < tracer.light_limit for value in lighting.position),
            f"a light outside of ±{tracer.light_limit // POSITION_UNITS} voxels",
        ),
        (max(size) > _FRAME_LIMIT, f"a frame of {size[0]}x{size[1]} pixels; it counts to {_FRAME_LIMIT}"),
    ):
        if misfit:
            raise SimulatorError(
                f"{rom.name} does not fit ray tracer configuration {config!r}: {problem}; render it with --engine model"
            )


def _ray_tracer(config: str) -> Any:  # noqa: ANN401 - the native module may be absent
    _rtl = import_verilated("render with --engine model")
    if config not in _rtl.CONFIGS:
        raise NoSuchConfigurationError(config, _rtl.CONFIGS, complete=_rtl.COMPLETE)
    return _rtl
