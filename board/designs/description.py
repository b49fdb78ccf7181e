"""The description of a board, ``board.json``: what it must have, and what the clock generator can make of it.

A description says by its `top` whether its part is an ECP5 or a Gowin GW2A.

``docs/board-files.md`` describes its keys.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec

if TYPE_CHECKING:
    from pathlib import Path

VCO_MHZ = 750
"""The frequency inside the PLL, of which all clocks are divided: board_pll.sv."""

BIT_MHZ = 125
"""The clock of the bits on the DVI pins, which the PLL compares with the oscillator's."""

CACHED = 2
"""The parameter MemoryForm of a core whose octree is in an external memory: rtl/voxrt_pkg.sv."""

_COMPARED_MHZ = Fraction(25, 8)  # the least that the PLL's phase detector takes: Trellis' ecppll

_Number = Annotated[str, msgspec.Meta(pattern=r"^\d{1,3}$")]
_Pin = Annotated[str, msgspec.Meta(pattern=r"^[A-Z]{1,2}\d{1,2}$")]
_Divider = Annotated[int, msgspec.Meta(ge=1, le=128)]
_Two = Annotated[tuple[_Pin, ...], msgspec.Meta(min_length=2, max_length=2)]
_Three = Annotated[tuple[_Pin, ...], msgspec.Meta(min_length=3, max_length=3)]
_Four = Annotated[tuple[_Pin, ...], msgspec.Meta(min_length=4, max_length=4)]
_Eight = Annotated[tuple[_Pin, ...], msgspec.Meta(min_length=1, max_length=8)]
_Thirteen = Annotated[tuple[_Pin, ...], msgspec.Meta(min_length=13, max_length=13)]
_Sixteen = Annotated[tuple[_Pin, ...], msgspec.Meta(min_length=16, max_length=16)]
_Some = Annotated[tuple[_Pin, ...], msgspec.Meta(min_length=1, max_length=32)]


class _Part(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A part of a description: a key that it does not have is an error."""


class Pll(_Part, frozen=True):
    """Oscillator / input x feedback = 125 MHz; the system clock is 750 MHz / system."""

    input_divider: _Divider
    feedback_divider: _Divider
    system_divider: _Divider


class Sdram(_Part, frozen=True):
    """Pins of an SDRAM chip of 32 MB, lowest bit first."""

    clk: _Pin
    cke: _Pin
    csn: _Pin
    rasn: _Pin
    casn: _Pin
    wen: _Pin
    ba: _Two
    a: _Thirteen
    dqm: _Two
    d: _Sixteen


class Pins(_Part, frozen=True):
    """Where the ports of the design are."""

    clk: _Pin
    uart_rx: _Pin
    uart_tx: _Pin
    dvi: _Four
    buttons: _Three
    buttons_low: bool
    leds: _Eight
    high: _Some
    sdram: Sdram | None = None


class Description(_Part, frozen=True):
    """All of a ``board.json``."""

    title: str
    device: Literal["12k", "25k", "45k", "85k"]
    package: str
    speed: Literal[6, 7, 8]
    idcode: str | None
    openfpgaloader: str
    clock_mhz: Annotated[float, msgspec.Meta(gt=0)]
    pll: Pll
    core: dict[str, int]
    octree_blocks: Annotated[int, msgspec.Meta(ge=1)]
    pins: Pins
    seed: int
    line_bits: Annotated[int, msgspec.Meta(ge=4, le=7)] | None = None
    boot_block_bits: Annotated[int, msgspec.Meta(ge=1)] | None = None
    top: Literal["ecp5_top", "ecp5_top_sdram"] = "ecp5_top"
    placer: str | None = None
    revision: str | None = None
    other_revisions: str | None = None


class GowinPll(_Part, frozen=True):
    """The system clock is 756 MHz / system."""

    system_divider: Literal[10, 12, 14, 16, 18, 20, 21, 24]


class GowinPins(_Part, frozen=True):
    """Where the ports of the design are, by the package's numbers."""

    clk: _Number
    uart_rx: _Number
    uart_tx: _Number
    dvi: Annotated[tuple[_Number, ...], msgspec.Meta(min_length=4, max_length=4)]
    dvi_n: Annotated[tuple[_Number, ...], msgspec.Meta(min_length=4, max_length=4)]
    buttons: Annotated[tuple[_Number, ...], msgspec.Meta(min_length=1, max_length=3)]
    buttons_low: bool
    leds: Annotated[tuple[_Number, ...], msgspec.Meta(min_length=1, max_length=8)]
    leds_low: bool


class GowinDescription(_Part, frozen=True):
    """All of a ``board.json`` of a board with a Gowin GW2A."""

    title: str
    top: Literal["gowin_top"]
    device: str
    part: Literal["GW2A-18", "GW2A-18C"]
    openfpgaloader: str
    clock_mhz: Literal[27]
    pll: GowinPll
    core: dict[str, int]
    octree_blocks: Annotated[int, msgspec.Meta(ge=1)]
    line_bits: Annotated[int, msgspec.Meta(ge=4, le=7)]
    column_bits: Annotated[int, msgspec.Meta(ge=9, le=10)]
    pins: GowinPins
    seed: int


GOWIN_TOP = "gowin_top"
"""The top of designs for a Gowin GW2A."""


def read_description(path: Path) -> dict[str, Any]:
    """Read a ``board.json``, as it is.

    Raises
    ------
    ValueError
        It is no description of a board, or its PLL does not give the clocks; one line, with the file and the remedy.
    """
    try:
        text = path.read_bytes()
        board: dict[str, Any] = msgspec.json.decode(text)
        if isinstance(board, dict) and board.get("top") == GOWIN_TOP:
            _check_blocks(msgspec.json.decode(text, type=GowinDescription))
        else:
            described = msgspec.json.decode(text, type=Description)
            _check_clocks(described)
            _check_blocks(described)
            _check_sdram(described)
    except OSError as error:
        raise ValueError(f"{path}: cannot be read: {error.strerror}; name the board.json of your board") from error
    except msgspec.ValidationError as error:
        raise ValueError(f"{path}: {error}; docs/board-files.md describes each key") from error
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise ValueError(f"{path}: is not JSON: {error}; begin with a board.json of board/designs") from error
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from error
    return board


def _check_clocks(board: Description) -> None:
    pll, oscillator = board.pll, Fraction(str(board.clock_mhz))
    bit = oscillator / pll.input_divider * pll.feedback_divider
    if bit != BIT_MHZ:
        raise ValueError(
            f"the PLL gives a bit clock of {float(bit):g} MHz, not {BIT_MHZ}: clock_mhz {float(oscillator):g} / "
            f"input_divider {pll.input_divider} x feedback_divider {pll.feedback_divider}; {_remedy(oscillator)}"
        )
    if oscillator / pll.input_divider < _COMPARED_MHZ:
        raise ValueError(
            f"clock_mhz {float(oscillator):g} / input_divider {pll.input_divider} is below "
            f"{float(_COMPARED_MHZ):g} MHz, the least that the PLL takes; {_remedy(oscillator)}"
        )


def _check_blocks(board: Description | GowinDescription) -> None:
    on_chip, bits = board.core.get("MemoryForm", 0) != CACHED, board.core.get("BlockBits", -1)
    if bits < 0:
        raise ValueError("core has no BlockBits: the octree memory holds 2**BlockBits blocks")
    if board.octree_blocks > 1 << bits or (on_chip and board.octree_blocks != 1 << bits):
        raise ValueError(f"octree_blocks {board.octree_blocks} does not go with BlockBits {bits}; take {1 << bits}")


def _check_sdram(board: Description) -> None:
    if (board.pins.sdram is None) == (board.top == "ecp5_top_sdram"):
        raise ValueError("pins.sdram goes with the top ecp5_top_sdram, and with no other")


def _remedy(oscillator: Fraction) -> str:
    """Say which dividers make 125 MHz of an oscillator, if any."""
    feedback, divider = (BIT_MHZ / oscillator).as_integer_ratio()
    if max(feedback, divider) > 128 or oscillator / divider < _COMPARED_MHZ:
        return "no dividers make 125 MHz of this oscillator"
    return f"take input_divider {divider} and feedback_divider {feedback}"
