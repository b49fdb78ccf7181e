"""The files of a wave: values as VCD or FST, and what GTKWave and Surfer show of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from voxrt.export.outputs import check_file
from voxrt.sim.errors import SimulatorError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from voxrt.sim.wave import Signal, Wave

GTKWAVE_MARKERS = 26
"""GTKWave marks so many times, A to Z."""

_SURFER_MARKERS = 255

# GTKWave's trace flags: how values are shown.
_HEXADECIMAL, _UNSIGNED, _BINARY = 0x22, 0x24, 0x28
_SHOWN = (
    ("clk_i", _BINARY),
    ("active_q", _BINARY),
    ("mem_read_o", _BINARY),
    ("mem_address_o", _HEXADECIMAL),
    ("mem_word_i", _HEXADECIMAL),
    ("leaf", _BINARY),
    ("action", _UNSIGNED),
    ("size2", _BINARY),
    ("time6[0]", _UNSIGNED),
    ("time6[1]", _UNSIGNED),
    ("time6[2]", _UNSIGNED),
    ("key_time6_q", _UNSIGNED),
    ("key_face6_q", _UNSIGNED),
    ("exit_face9", _UNSIGNED),
    ("corner11[0]", _UNSIGNED),
    ("corner11[1]", _UNSIGNED),
    ("corner11[2]", _UNSIGNED),
    ("octant11", _BINARY),
    ("material9_q", _UNSIGNED),
    ("result_o.store", _BINARY),
)
"""The signals of the lane that the viewers show, by stages."""


def check_wave(path: Path) -> None:
    """Refuse a file before any work is done for it: OutputError, or SimulatorError where pylibfst is needed."""
    check_file(path)
    if path.suffix.lower() == ".fst":
        _import_pylibfst()


def write_wave(wave: Wave, path: Path) -> dict[str, Path]:
    """Write a wave (.vcd or .fst) and its view files, and return the files by kind: `wave`, `gtkwave`, `surfer`.

    SimulatorError for ``.fst`` without the package pylibfst; OSError if a file cannot be written.
    """
    if path.suffix.lower() == ".fst":
        _write_fst(wave, path)
    else:
        path.write_text("".join(_vcd(wave)), encoding="ascii")
    files = {"wave": path, "gtkwave": path.with_suffix(".gtkw"), "surfer": path.with_suffix(".sucl")}
    shown = _shown_signals(wave)
    files["gtkwave"].write_text(_gtkwave_view(wave, path, shown), encoding="utf-8")
    files["surfer"].write_text(_surfer_view(wave, [signal for signal, _ in shown]), encoding="utf-8")
    return files


def _import_pylibfst() -> Any:  # noqa: ANN401 - it has no types
    """Import the package that writes FST files; SimulatorError where it is not installed."""
    try:
        import pylibfst  # noqa: PLC0415 - only .fst needs it
    except ImportError as error:
        raise SimulatorError("a .fst needs pylibfst: pip install pylibfst; or name a .vcd") from error
    return pylibfst


def _shown_signals(wave: Wave) -> list[tuple[Signal, int]]:
    rays = [(signal, _UNSIGNED) for signal in wave.signals if signal.scope == ("ray",)]
    return rays + [(wave.lane(name), base) for name, base in _SHOWN]


def _scopes(wave: Wave) -> Iterator[tuple[int, tuple[str, ...], Signal | None]]:
    """Yield how many scopes to leave, which to enter, and the signal that stands there; None at the end."""
    inside: tuple[str, ...] = ()
    for signal in [*wave.signals, None]:
        scope = signal.scope if signal else ()
        common = next((n for n, (a, b) in enumerate(zip(inside, scope, strict=False)) if a != b), None)
        common = min(len(inside), len(scope)) if common is None else common
        yield len(inside) - common, scope[common:], signal
        inside = scope


def _events(wave: Wave) -> list[tuple[int, int, str]]:
    """Return (time, number of the signal, value) in order of time."""
    return sorted((time, number, value) for number, signal in enumerate(wave.signals) for time, value in signal.changes)


def _vcd(wave: Wave) -> Iterator[str]:
    yield "$timescale 1ns $end\n"
    for number, (leaves, enters, signal) in enumerate(_scopes(wave)):
        yield "$upscope $end\n" * leaves
        yield from (f"$scope module {name} $end\n" for name in enters)
        if signal:
            bits = f" [{signal.width - 1}:0]" if signal.width > 1 else ""
            yield f"$var wire {signal.width} {_code(number)} {signal.name}{bits} $end\n"
    yield "$enddefinitions $end\n"
    last = -1
    for time, number, value in _events(wave):
        if time != last:
            yield f"#{time}\n"
            last = time
        yield f"{value}{_code(number)}\n" if len(value) == 1 else f"b{value} {_code(number)}\n"
    if last != wave.end:
        yield f"#{wave.end}\n"


def _code(number: int) -> str:
    """Return the short name of a signal: printable characters, the lowest digit first."""
    code = ""
    while True:
        code += chr(33 + number % 94)
        number //= 94
        if not number:
            return code


def _write_fst(wave: Wave, path: Path) -> None:
    fst = _import_pylibfst()
    api, text = fst.lib, fst.ffi.new
    context = api.fstWriterCreate(bytes(path), 1)
    if context == fst.ffi.NULL:
        raise OSError(f"{path}: cannot be written")
    api.fstWriterSetTimescale(context, -9)
    api.fstWriterSetDate(context, b"")  # the same wave gives the same bytes
    handles = []
    for leaves, enters, signal in _scopes(wave):
        for _ in range(leaves):
            api.fstWriterSetUpscope(context)
        for name in enters:
            api.fstWriterSetScope(context, api.FST_ST_VCD_MODULE, name.encode(), fst.ffi.NULL)
        if signal:
            bits = f" [{signal.width - 1}:0]" if signal.width > 1 else ""
            name = text("char[]", f"{signal.name}{bits}".encode())
            handles.append(
                api.fstWriterCreateVar(context, api.FST_VT_VCD_WIRE, api.FST_VD_IMPLICIT, signal.width, name, 0)
            )
    last = -1
    for time, number, value in _events(wave):
        if time != last:
            api.fstWriterEmitTimeChange(context, time)
            last = time
        api.fstWriterEmitValueChange(context, handles[number], text("char[]", value.encode()))
    api.fstWriterEmitTimeChange(context, wave.end)
    api.fstWriterClose(context)


def _gtkwave_view(wave: Wave, path: Path, shown: list[tuple[Signal, int]]) -> str:
    marked = wave.words[:GTKWAVE_MARKERS]
    times = [*marked, *[-1] * (GTKWAVE_MARKERS - len(marked))]
    lines = [
        f'[dumpfile] "{path.name}"',
        "[timestart] 0",
        f"*-6.0 {wave.words[0] if wave.words else -1} {' '.join(map(str, times))}",
        *(f"[markername] {chr(ord('A') + number)}word {number + 1}" for number in range(len(marked))),
    ]
    for signal, base in shown:
        bits = f"[{signal.width - 1}:0]" if signal.width > 1 else ""
        lines += [f"@{base:x}", f"{'.'.join(signal.scope)}.{signal.name}{bits}"]
    return "\n".join(lines) + "\n"


def _surfer_view(wave: Wave, shown: list[Signal]) -> str:
    # Its reader takes an array for a scope, in which the elements are [0], [1] and so on.
    lines = [f"variable_add {'.'.join(signal.scope)}.{signal.name.replace('[', '.[')}" for signal in shown]
    lines += [f"marker_set word_{number} {time}" for number, time in enumerate(wave.words[:_SURFER_MARKERS], 1)]
    lines += [f"cursor_set {wave.words[0]}"] if wave.words else []
    return "\n".join([*lines, "zoom_fit"]) + "\n"
