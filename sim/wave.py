"""The simulated signals of a lane while it traces one ray."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import Struct

from voxrt.octree.camera import Camera, Lighting
from voxrt.sim.engine_arguments import palette_of, registers_of, shading_of
from voxrt.sim.errors import SimulatorError
from voxrt.sim.hardware import check_fits
from voxrt.sim.verilated import import_verilated

if TYPE_CHECKING:
    from voxrt.octree import Rom
    from voxrt.octree.camera import Triple
    from voxrt.sim.path import RayPath

CLOCK = 10
"""Nanoseconds from one rising edge of a wave's clock to the next."""

LANE = ("voxrt_rtu", "gen_lane[0]", "u_lane", "u_lane")
"""The scope of ``voxrt_lane`` in a wave."""

_BUFFERED_LANE = LANE[:-1]
_CONFIG = "tiny"  # the configuration that is built with tracing
_RING = 12  # the lane's stages: rtl/lane/voxrt_lane.sv
_REGISTER = 1 << 15  # components of a camera's directions are below it


class Signal(Struct, frozen=True):
    """A signal of a wave.

    Attributes
    ----------
    scope
        The instances that it is in, from the outermost.
    name
        As in the SystemVerilog source; an element of an array has its index.
    width
        Bits.
    changes
        (time, value): nanoseconds, in order, and binary digits, `width` of them.
    """

    scope: tuple[str, ...]
    name: str
    width: int
    changes: tuple[tuple[int, str], ...]

    def at(self, time: int) -> int:
        """Return the value from the rising edge at `time` (nanoseconds) on."""
        return int(next((value for when, value in reversed(self.changes) if when <= time), "0"), 2)


class Wave(Struct, frozen=True):
    """The signals of a lane while it traces one ray.

    Attributes
    ----------
    signals
        Those of the lane with its buffers (``voxrt_buffered_lane``) and of their parts, in the order of the sources,
        and ``ray.stage`` and ``ray.word``: the stage of the ring that the ray is in (15: none), and how many words it
        has asked for.
    words
        The times at which the ray enters stage 0 and reads a word, nanoseconds. One per reading of the ray's path.
    end
        The time of the last sample, nanoseconds.
    rays
        The rays in the lane: 1, or more where the first ray's direction takes two registers. Signals without a stage in
        their name are those of all.
    """

    signals: tuple[Signal, ...]
    words: tuple[int, ...]
    end: int
    rays: int

    def lane(self, name: str) -> Signal:
        """Return a signal of ``voxrt_lane``, a struct's member as ``result_o.store``; KeyError if it has none such."""
        full = (*LANE, *name.split("."))
        for signal in self.signals:
            if (*signal.scope, signal.name) == full:
                return signal
        raise KeyError(name)


def record_wave(rom: Rom, path: RayPath) -> Wave:
    """Trace a ray on the verilated configuration ``tiny``, and record its lane.

    Parameters
    ----------
    rom
        The memory.
    path
        The ray, and what it reads.

    Returns
    -------
    Wave
        From the start of a frame that has this ray alone to its end.

    Raises
    ------
    SimulatorError
        The installation has no ray tracer with tracing, or the memory or the camera does not fit it.

    Examples
    --------
    >>> from voxrt.octree import Rom, from_points
    >>> from voxrt.sim import follow_ray
    >>> from voxrt.voxelize import EMPTY, Material
    >>> rom = Rom("dot", from_points([[5, 2, 2]], [1], depth=3), (EMPTY, Material("red", (255, 0, 0))))
    >>> path = follow_ray(rom.octree, (0, 40, 40), (1, 0, 0))
    >>> wave = record_wave(rom, path)
    >>> [wave.lane("mem_address_o").at(word) + 1 for word in wave.words] == [word.address for word in path.readings]
    True
    """
    _rtl = import_verilated("trace without --wave")
    if not _rtl.WAVE:
        raise SimulatorError(
            "this build has no configuration tiny, whose lane is recorded; install a released wheel, or trace without "
            "--wave"
        )
    camera, rays = _camera_of(path)
    tracer = _rtl.Tracer(_CONFIG, recorded=True)
    check_fits(tracer, _CONFIG, rom, camera=camera, size=(rays, 1), lighting=Lighting())
    tracer.load(rom.octree.words)
    tracer.render(
        registers_of(camera), rays, 1, rom.octree.depth, palette_of(rom.materials), **shading_of(rom, Lighting())
    )
    signals, end = _read(tracer.take_wave())
    return _with_ray(Wave(signals, (), end, rays), len(path.readings))


def _camera_of(path: RayPath) -> tuple[Camera, int]:
    """Return a camera whose first pixel is the ray, and the columns of its frame of one row."""
    columns = 1
    # The first of 2 n columns looks along look - n * right.
    while any(abs(part) >= _REGISTER * (columns // 2 + 1) for part in path.direction):
        columns *= 2
    steps = columns // 2
    right = tuple(-int(part / (steps + 1)) if steps else 0 for part in path.direction)
    look = tuple(part + steps * step for part, step in zip(path.direction, right, strict=True))
    return Camera(path.origin, _triple(look), _triple(right), (0, 0, 0)), columns


def _triple(parts: tuple[int, ...]) -> Triple:
    x, y, z = parts
    return x, y, z


def _read(text: str) -> tuple[tuple[Signal, ...], int]:
    """Read a VCD file as Verilator writes it, two samples per clock."""
    head, body = text.split("$enddefinitions $end", 1)
    scope: list[str] = []
    found: list[tuple[tuple[str, ...], str, int, str]] = []
    for line in head.splitlines():
        match line.split():
            case ["$scope", _, name, *_]:
                scope.append(name)
            case ["$upscope", *_]:
                scope.pop()
            case ["$var", _, width, code, name, *_] if _is_shown(tuple(scope[1:]), name):
                found.append((tuple(scope[1:]), name, int(width), code))  # without Verilator's own TOP
    changes: dict[str, list[tuple[int, str]]] = {code: [] for *_, code in found}
    time = 0
    for line in body.split("\n"):
        if line.startswith("#"):
            # Samples 0 and 1 are of a clock's low and high level: its rising edge is at a multiple of CLOCK.
            time = (int(line[1:]) + 1) * CLOCK // 2
        elif line:
            value, code = line[1:].split() if line[0] == "b" else (line[0], line[1:])
            if code in changes:
                changes[code].append((time, value))
    signals = tuple(
        Signal(place, name, width, tuple((when, value.zfill(width)) for when, value in changes[code]))
        for place, name, width, code in found
    )
    return signals, time


def _is_shown(scope: tuple[str, ...], name: str) -> bool:
    """Whether a signal is of the lane, and neither a parameter nor of an assertion."""
    of_assertion = any(part.startswith("gen_assert") for part in scope) or name == "reset_seen_q"
    return scope[: len(_BUFFERED_LANE)] == _BUFFERED_LANE and not name[0].isupper() and not of_assertion


def _with_ray(wave: Wave, readings: int) -> Wave:
    """Find the ray in the ring, and add its stage and the number of its words."""
    reads, active = wave.lane("mem_read_o"), wave.lane("active_q")
    edges = range(CLOCK, wave.end + 1, CLOCK)
    first = next((time for time in edges if reads.at(time)), None)
    if first is None:
        return wave
    words = tuple(time for time in range(first, wave.end + 1, _RING * CLOCK) if reads.at(time))[:readings]
    stages, numbers = [(0, "1111")], [(0, "0" * 16)]
    for time in edges:
        stage = (time - first) // CLOCK % _RING
        is_there = time >= first - 2 * CLOCK and time <= words[-1] + 9 * CLOCK and active.at(time) >> stage & 1
        value = f"{stage if is_there else 15:04b}"
        if value != stages[-1][1]:
            stages.append((time, value))
        if time in words:
            numbers.append((time, f"{words.index(time) + 1:016b}"))
    ray = (Signal(("ray",), "stage", 4, tuple(stages)), Signal(("ray",), "word", 16, tuple(numbers)))
    return Wave((*ray, *wave.signals), words, wave.end, wave.rays)
