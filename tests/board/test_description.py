"""What a board.json must have, and which clocks its PLL must give."""

from __future__ import annotations

import json

import pytest

from voxrt.board.designs import build
from voxrt.octree import BOARDS


@pytest.fixture
def written(tmp_path):
    """Write the description of a board, changed; give its path."""

    def write(change):
        board = json.loads(build.board_file("ulx3s-12f").read_text())
        change(board)
        (tmp_path / "board.json").write_text(json.dumps(board))
        return str(tmp_path / "board.json")

    return write


@pytest.mark.parametrize("name", build.board_names())
def test_the_boards_of_ours_are_read_as_they_are(name):
    board = build.read_board(name)
    assert board == json.loads((build.DESIGNS / name / "board.json").read_text())
    if not build.is_gowin(board):
        pll = board["pll"]
        assert board["clock_mhz"] * pll["feedback_divider"] == 125 * pll["input_divider"]


def test_a_board_with_a_gowin_is_refused_with_what_is_wrong(tmp_path):
    board = build.read_board("tang-nano-20k")
    path = tmp_path / "board.json"
    for change, problem in (
        ({"pll": {"system_divider": 13}}, r"Invalid enum value 13 - at `\$\.pll\.system_divider`"),
        ({"clock_mhz": 25}, r"Invalid enum value 25 - at `\$\.clock_mhz`"),
        ({"octree_blocks": 1024}, "octree_blocks 1024 does not go with BlockBits 11; take 2048"),
    ):
        path.write_text(json.dumps(board | change))
        with pytest.raises(ValueError, match=problem):
            build.read_board(str(path))


def test_no_other_list_has_the_boards():
    assert set(BOARDS) == {*build.board_names(), "pynq-z1"}


@pytest.mark.parametrize(
    ("clock", "dividers", "problem"),
    [
        (48, (2, 5), "the PLL gives a bit clock of 120 MHz, not 125: clock_mhz 48 / .*; no dividers make 125 MHz"),
        (50, (1, 5), "a bit clock of 250 MHz, not 125: .*; take input_divider 2 and feedback_divider 5"),
        (12, (1, 10), "a bit clock of 120 MHz, not 125: .*; no dividers make 125 MHz of this oscillator"),
        (403.125, (128, 40), "a bit clock of 125.977 MHz, not 125: .*; no dividers make 125 MHz of this oscillator"),
        (100, (4, 5), None),
        (62.5, (1, 2), None),
        (25, (16, 80), "clock_mhz 25 / input_divider 16 is below 3.125 MHz, .*; take input_divider 1 and feedback_"),
    ],
)  # fmt: skip
def test_a_pll_that_does_not_give_125_mhz_is_refused(written, clock, dividers, problem):
    def change(board):
        board["clock_mhz"] = clock
        board["pll"] |= dict(zip(("input_divider", "feedback_divider"), dividers, strict=True))

    path = written(change)
    if problem is None:
        assert build.clock_hz(build.read_board(path)) == 75_000_000
        return
    with pytest.raises(ValueError, match=problem) as found:
        build.read_board(path)
    assert str(found.value).startswith(path)
    assert "\n" not in str(found.value)


def test_the_system_clock_is_what_the_divider_gives(written):
    path = written(lambda board: board["pll"].update(system_divider=13))
    assert build.clock_hz(build.read_board(path)) == 750_000_000 // 13


@pytest.mark.parametrize(
    ("change", "problem"),
    [
        (lambda b: b.pop("clock_mhz"), "Object missing required field `clock_mhz`"),
        (lambda b: b.update(colour="red"), "Object contains unknown field `colour`"),
        (lambda b: b["pins"].pop("dvi"), r"missing required field `dvi` - at `\$.pins`"),
        (lambda b: b["pins"].update(leds=["B2"] * 9), r"Expected `array` of length <= 8 - at `\$.pins.leds`"),
        (lambda b: b["pins"].update(clk="pin 1"), r"matching regex .* - at `\$.pins.clk`"),
        (lambda b: b["pll"].update(system_divider=0), r"Expected `int` >= 1 - at `\$.pll.system_divider`"),
        (lambda b: b.update(device="lfe5u"), r"Invalid enum value 'lfe5u' - at `\$.device`"),
        (lambda b: b.update(octree_blocks=5), "octree_blocks 5 does not go with BlockBits 11; take 2048"),
        (lambda b: b.update(top="ecp5_top_sdram"), "pins.sdram goes with the top ecp5_top_sdram"),
        (lambda b: b["core"].clear(), "core has no BlockBits"),
    ],
)  # fmt: skip
def test_a_description_with_a_mistake_is_refused_in_one_line(written, change, problem):
    path = written(change)
    with pytest.raises(ValueError, match=problem) as found:
        build.read_board(path)
    assert str(found.value).startswith(f"{path}: ")
    assert "\n" not in str(found.value)


def test_an_sdram_may_hold_fewer_blocks_than_its_addresses_reach_and_not_more(tmp_path):
    board = build.read_board("ulx3s-85f-sdram")
    path = tmp_path / "board.json"
    path.write_text(json.dumps(board | {"octree_blocks": 1 << 20}))
    assert build.read_board(str(path))["octree_blocks"] == 1 << 20
    path.write_text(json.dumps(board | {"octree_blocks": (1 << 20) + 1}))
    with pytest.raises(ValueError, match="octree_blocks 1048577 does not go with BlockBits 20; take 1048576"):
        build.read_board(str(path))


def test_a_file_that_is_not_json(tmp_path):
    path = tmp_path / "board.json"
    for text in (b"", b'{"title": "U', b'{"title": "\xff"}'):
        path.write_bytes(text)
        with pytest.raises(ValueError, match=r"board\.json: is not JSON: .*; begin with a board\.json of") as found:
            build.read_board(str(path))
        assert "\n" not in str(found.value)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(ValueError, match=r"board\.json: cannot be read: No such .*; name the board\.json of"):
        build.read_board(str(tmp_path / "board.json"))
    with pytest.raises(KeyError, match="there is no board 'abacus'; there are icepi-zero, "):
        build.read_board("abacus")
