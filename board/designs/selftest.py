"""The host's side of the self-test of a board: what its registers say, and what to do about it.

``docs/board-selftest.md`` is the reference of the registers. The design has no ray tracer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from voxrt.board.designs.boot_table import BOARD_REGISTERS
from voxrt.board.errors import DeviceError
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from voxrt.board.designs.serial_link import SerialLink

SELFTEST = int.from_bytes(b"VXST", "big")
BUTTONS = ("pause", "reverse", "step")
"""The buttons, in the order of a board's ``pins.buttons``."""

_NAMES = (
    "identity",
    "version",
    "clock",
    "echo",
    "lock",
    "bit_clocks",
    "pixel_clocks",
    "frames",
    "buttons",
    "requests",
    "bad_requests",
    "sdram",
    "sdram_lines",
    "sdram_wrong",
    "sdram_bits",
    "sdram_first",
    "pixel_clock",
    "button_count",
)
SELFTEST_REGISTERS = {name: BOARD_REGISTERS["identity"] + 4 * number for number, name in enumerate(_NAMES)}
"""Addresses by name."""

_BOARD = int.from_bytes(b"VXBD", "big")
_WINDOW = 1 << 20  # system clocks in which the other clocks are counted
_CLOCK_ERROR = 1e-3  # a count is right within this share
_ECHOES = 256
_POLLS = 2000  # reads of a register that must change meanwhile: seconds
_LAST_STAGE = 3

State = Literal["passed", "failed", "open"]


class Finding(Value, frozen=True):
    """What one part of the self-test found.

    Attributes
    ----------
    part
        Of the board.
    state
        ``open``: a person must look, or press.
    text
        What was measured, and what to do unless it passed.
    """

    part: str
    state: State
    text: str


def check_selftest(link: SerialLink, progress: Callable[[str, int, int], None]) -> list[Finding]:
    """Read the results of the self-test that runs on a board.

    Parameters
    ----------
    link
        The serial line.
    progress
        Receives what is under way, and how many of how many steps are done.

    Returns
    -------
    list of Finding
        One per part.

    Raises
    ------
    DeviceError
        The board does not answer, or no self-test runs on it.
    """
    identity = _read(link, "identity")
    if identity == _BOARD:
        raise DeviceError(
            f"{link.name}: the board shows a scene; load its self-test: voxrt bitstream --board NAME --selftest --load"
        )
    if identity != SELFTEST:
        raise DeviceError(f"{link.name}: this is no self-test of voxrt; load it again")
    return [
        _check_line(link, progress),
        _check_lock(link),
        _check_clocks(link),
        _check_frames(link),
        Finding(
            "screen",
            "open",
            "look at it: a white frame, in it eight bars from white to black, ramps of red, green and blue, and eight "
            "squares, which are the LEDs. If it is black: another cable or monitor; docs/your-board.md",
        ),
        _check_buttons(link),
        *_check_sdram(link, progress),
    ]


def _check_line(link: SerialLink, progress: Callable[[str, int, int], None]) -> Finding:
    before = _read(link, "bad_requests")
    sent: NDArray[np.uint32] = np.random.default_rng(1).integers(0, 1 << 32, _ECHOES, dtype=np.uint32)
    wrong = 0
    for number, word in enumerate(sent):
        link.write(SELFTEST_REGISTERS["echo"], [word])
        wrong += int(_read(link, "echo") != word)
        progress("serial line", number + 1, _ECHOES)
    bad = (_read(link, "bad_requests") - before) & 0xFFFFFFFF
    if wrong:
        return Finding("serial line", "failed", f"{wrong} of {_ECHOES} words came back wrong: report this, please")
    if bad:
        return Finding(
            "serial line",
            "failed",
            f"{bad} requests arrived damaged, and were sent again: use a shorter cable, without a hub",
        )
    return Finding("serial line", "passed", f"{_ECHOES} words went there and came back")


def _check_lock(link: SerialLink) -> Finding:
    lock = _read(link, "lock")
    mhz = _read(link, "clock") / 1e6
    if lock >> 8:
        return Finding(
            "PLL",
            "failed",
            f"it lost its lock {lock >> 8} times since the bitstream was loaded: use another supply or USB port",
        )
    if not lock & 1:
        return Finding("PLL", "failed", "it is not locked now: load the bitstream again, and report this, please")
    return Finding("PLL", "passed", f"locked since the bitstream was loaded; the system clock is {mhz:.4g} MHz")


def _check_clocks(link: SerialLink) -> Finding:
    clock = _read(link, "clock")
    for _ in range(_POLLS):
        if _read(link, "pixel_clocks") and _read(link, "bit_clocks"):
            break
    measured, right, pixel_mhz = [], True, _read(link, "pixel_clock") / 1e6
    for name, mhz in (("bit", 5 * pixel_mhz), ("pixel", pixel_mhz)):
        found = _read(link, f"{name}_clocks") * clock / _WINDOW / 1e6
        measured.append(f"{name} clock {found:.2f} MHz")
        right = right and abs(found / mhz - 1) < _CLOCK_ERROR
    text = f"{measured[0]}, {measured[1]}, by the system clock"
    if right:
        return Finding("clocks", "passed", text)
    wanted = (
        f"they must be {5 * pixel_mhz:g} and {pixel_mhz:g} MHz: the PLL does not work as it should; report this, please"
    )
    return Finding("clocks", "failed", f"{text}; {wanted}")


def _check_frames(link: SerialLink) -> Finding:
    before = _read(link, "frames")
    for _ in range(_POLLS):
        if _read(link, "frames") != before:
            return Finding("picture", "passed", "the board draws frames")
    return Finding("picture", "failed", "no frame is drawn: the pixel clock stands still; load the bitstream again")


def _check_buttons(link: SerialLink) -> Finding:
    word, buttons = _read(link, "buttons"), BUTTONS[: _read(link, "button_count")]
    held = [name for bit, name in enumerate(buttons) if not word >> (16 + bit) & 1]
    missing = [name for bit, name in enumerate(buttons) if not word >> (8 + bit) & 1]
    if held:
        return Finding("buttons", "failed", f"always pressed: {', '.join(held)}; is this the board's revision?")
    if missing:
        return Finding(
            "buttons",
            "open",
            f"press each of them, and see LED 3; then check again. Not seen yet: {', '.join(missing)}",
        )
    return Finding("buttons", "passed", "each was pressed and let go")


def _check_sdram(link: SerialLink, progress: Callable[[str, int, int], None]) -> list[Finding]:
    if not _read(link, "sdram") & 1:
        return []
    lines, still = -1, 0
    while (stage := _read(link, "sdram") >> 8 & 3) < _LAST_STAGE and still < _POLLS:
        progress("SDRAM", stage, _LAST_STAGE)
        now = _read(link, "sdram_lines")
        still = still + 1 if now == lines else 0
        lines = now
    lines, wrong = _read(link, "sdram_lines"), _read(link, "sdram_wrong")
    if wrong:
        word = _read(link, "sdram_bits")
        bits = [str(bit) for bit in range(16) if word >> bit & 1]
        first = _read(link, "sdram_first")
        which = "all data bits" if len(bits) == 16 else f"data bits {', '.join(bits)}"
        remedy = (
            "the data are taken too early or too late: rebuild with another ChipDelay; docs/your-board.md"
            if len(bits) == 16
            else "these pins do not reach the chip, or its supply is poor"
        )
        return [
            Finding(
                "SDRAM", "failed", f"{wrong:,} of {lines:,} lines are wrong, the first is {first}, {which}: {remedy}"
            )
        ]
    if stage < _LAST_STAGE:
        return [Finding("SDRAM", "failed", f"the test stands still after {lines:,} lines: report this, please")]
    return [Finding("SDRAM", "passed", f"{lines:,} lines of 32 bytes hold two patterns")]


def _read(link: SerialLink, name: str) -> int:
    return int(link.read(SELFTEST_REGISTERS[name], 1)[0])
