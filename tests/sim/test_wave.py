"""The wave of a ray, read back by other people's readers, against the words that the exact model reads."""

from __future__ import annotations

import re
import signal

import numpy as np
import pytest

from voxrt.octree import Rom, from_points
from voxrt.sim import SimulatorError, follow_ray
from voxrt.sim.wave import record_wave
from voxrt.sim.wave_files import write_wave
from voxrt.voxelize import EMPTY, Material

_rtl = pytest.importorskip("voxrt.sim._rtl")

# It lets a broken pipe end the process, which a worker of pytest does not survive.
_at_broken_pipe = signal.getsignal(signal.SIGPIPE)
VCDVCD = pytest.importorskip("vcdvcd").VCDVCD
signal.signal(signal.SIGPIPE, _at_broken_pipe)
LANE = "voxrt_rtu.gen_lane[0].u_lane.u_lane"
CLOCK = 10  # of a wave, nanoseconds
STAGES = 12


@pytest.fixture(scope="module")
def rom():
    points = np.random.default_rng(3).integers(0, 32, (150, 3))
    return Rom("points", from_points(points, np.full(150, 1, np.uint8), depth=5), (EMPTY, Material("red", (255, 0, 0))))


RAYS = {
    "a miss that reads words": ((-40, 90, 100), (90, 3, 4)),
    "from within": ((200, 300, 150), (-3, 5, 7)),
    "the longest direction of a register": ((-40, 200, 200), (32_767, 469, -938)),
    "a direction of 17 bits": ((-40, 200, 200), (70_001, 1_003, -2_005)),
    "a direction of 20 bits": ((900, 200, 200), (-1_048_575, 77_777, 2)),
    "along an axis": ((-16, 72, 72), (1, 0, 0)),
}


def signal(wave, name):
    """Return (time, digits), whatever the reader calls the range of bits."""
    return next(wave[full].tv for full in wave.signals if re.fullmatch(rf"{re.escape(name)}(\[\d+:0\])?", full))


def at(changes, time):
    return int(next(value for when, value in reversed(changes) if when <= time), 2)


@pytest.mark.parametrize("ray", RAYS)
def test_the_lane_reads_the_words_of_the_model(rom, tmp_path, ray):
    path = follow_ray(rom.octree, *RAYS[ray])
    assert len(path.readings) > 2
    wave = record_wave(rom, path)
    assert (wave.rays > 1) == ("bits" in ray)
    files = write_wave(wave, tmp_path / "ray.vcd")
    read = VCDVCD(str(files["wave"]))
    words, address = signal(read, "ray.word"), signal(read, f"{LANE}.mem_address_o")
    found = [(time, int(value, 2)) for time, value in words if int(value, 2)]
    assert [number for _, number in found] == list(range(1, len(path.readings) + 1))
    times = [time for time, _ in found]
    assert np.diff(times).tolist() == [STAGES * CLOCK] * (len(times) - 1)
    # Address 0 of the memory is the word behind the root.
    assert [at(address, time) + 1 for time in times] == [reading.address for reading in path.readings]
    leaf, size = signal(read, f"{LANE}.leaf"), signal(read, f"{LANE}.size2")
    two_stages = 2 * CLOCK
    assert [at(leaf, time + two_stages) for time in times] == [reading.is_leaf for reading in path.readings]
    assert [at(size, time + two_stages) for time in times] == [1 << reading.level for reading in path.readings]
    # The key at the sixth stage is the plane that the ray crossed last; a ray that starts inside has none yet.
    time6, face6 = signal(read, f"{LANE}.key_time6_q"), signal(read, f"{LANE}.key_face6_q")
    crossed = [(time + 6 * CLOCK, one) for time, one in zip(times, path.readings, strict=True) if one.axis < 3]
    assert [(at(time6, time), at(face6, time)) for time, _ in crossed] == [(one.time, one.axis) for _, one in crossed]
    assert at(signal(read, f"{LANE}.material9_q"), times[-1] + 9 * CLOCK) == path.material
    stage = signal(read, "ray.stage")
    for number in range(STAGES):
        assert at(stage, times[0] + number * CLOCK) == number
    assert [at(stage, times[0] - clocks * CLOCK) for clocks in (3, 2, 1)] == [15, 10, 11]
    # The ray retires at stage 9.
    assert [at(stage, times[-1] + clocks * CLOCK) for clocks in (8, 9, 10)] == [8, 9, 15]
    clock = signal(read, f"{LANE}.clk_i")
    rises = [time for time, value in clock if value == "1"]
    assert all(time % CLOCK == 0 for time in rises)
    assert set(np.diff(rises)) == {CLOCK}
    assert read.endtime == wave.end >= rises[-1]


def test_the_signals_bear_the_names_of_the_source(rom):
    wave = record_wave(rom, follow_ray(rom.octree, *RAYS["from within"]))
    names = {signal.name for signal in wave.signals if ".".join(signal.scope) == LANE}
    assert {"slot_q[0]", "active_q", "mem_word_i", "action6_q", "key_time_q[11]"} <= names
    assert wave.lane("decision.issues").width == 1
    scopes = {signal.scope[-1] for signal in wave.signals}
    assert {"u_lane", "u_times", "u_next_cell", "u_scheduler", "ray"} <= scopes
    everything = {part for signal in wave.signals for part in (*signal.scope, signal.name)}
    assert not [part for part in everything if "assert" in part or part == "reset_seen_q" or part[0].isupper()]


def test_both_formats_hold_the_same(rom, tmp_path):
    pylibfst = pytest.importorskip("pylibfst")
    wave = record_wave(rom, follow_ray(rom.octree, *RAYS["from within"]))
    first = write_wave(wave, tmp_path / "ray.fst")
    again = write_wave(wave, tmp_path / "again.fst")
    assert first["wave"].read_bytes() == again["wave"].read_bytes()
    context = pylibfst.lib.fstReaderOpen(bytes(first["wave"]))
    _, signals = pylibfst.get_scopes_signals2(context)
    handle = next(
        found.handle for name, found in signals.by_name.items() if re.match(rf"{re.escape(LANE)}\.time6\[1\]", name)
    )
    pylibfst.lib.fstReaderSetFacProcessMask(context, handle)
    values = []

    def store(_, time, __, value):
        values.append((time, pylibfst.string(value)))

    pylibfst.fstReaderIterBlocks(context, store)
    pylibfst.lib.fstReaderClose(context)
    written = VCDVCD(str(write_wave(wave, tmp_path / "ray.vcd")["wave"]))
    expected = [(time, int(value, 2)) for time, value in signal(written, f"{LANE}.time6[1]")]
    assert len(expected) > 3
    assert [(time, int(value, 2)) for time, value in values] == expected


def test_the_views_show_signals_of_the_file_and_mark_each_word(rom, tmp_path):
    wave = record_wave(rom, follow_ray(rom.octree, *RAYS["from within"]))
    files = write_wave(wave, tmp_path / "ray.vcd")
    names = VCDVCD(str(files["wave"])).signals
    gtkwave = files["gtkwave"].read_text().splitlines()
    shown = [line for line in gtkwave if line.startswith(("ray.", LANE))]
    assert len(shown) > 15
    assert set(shown) <= set(names)
    markers = next(line for line in gtkwave if line.startswith("*")).split()[2:]
    assert len(markers) == 26
    assert [int(time) for time in markers if time != "-1"] == list(wave.words[:26])
    surfer = files["surfer"].read_text().splitlines()
    assert [line for line in surfer if line.startswith("marker_set")] == [
        f"marker_set word_{number} {time}" for number, time in enumerate(wave.words, 1)
    ]
    added = {line.removeprefix("variable_add ") for line in surfer if line.startswith("variable_add")}
    assert len(added) == len(shown)
    pywellen = pytest.importorskip("pywellen", reason="Surfer's reader is not installed")
    assert added <= {variable.full_name for variable in pywellen.Waveform(str(files["wave"])).all_vars()}


def test_a_ray_that_misses_the_world_reads_nothing(rom, tmp_path):
    wave = record_wave(rom, follow_ray(rom.octree, (-40, -40, -40), (-1, -1, -1)))
    assert wave.words == ()
    assert set(write_wave(wave, tmp_path / "ray.vcd")) == {"wave", "gtkwave", "surfer"}


def test_what_does_not_fit_is_refused(rom):
    with pytest.raises(SimulatorError, match=r"points does not fit ray tracer configuration 'tiny': a camera at"):
        record_wave(rom, follow_ray(rom.octree, (1 << 30, 0, 0), (-1, 0, 0)))
    with pytest.raises(ValueError, match="no wave of the configuration lit: only of tiny"):
        _rtl.Tracer("lit", recorded=True)
