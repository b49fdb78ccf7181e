"""What ships is what was placed: the records of placements, the placed designs and the descriptions agree.

The slow tests make the self-tests of the boards anew, which must give the same bytes.
"""

from __future__ import annotations

import bz2
import hashlib
import json

import pytest

from voxrt.board.designs import build
from voxrt.board.designs.placement import crossing_delays, digests_of, read_placement

ALL = sorted(build.DESIGNS.glob("*/placements/*.json.bz2"))
RECORDS = [path for path in ALL if not build.is_gowin(build.read_board(path.parents[1].name))]


def board_of(record):
    board = build.read_board(record.parents[1].name)
    return build.selftest_of(board) if record.name.startswith("selftest") else board


def stem_of(record):
    return record.name.split("-", maxsplit=1)[0]


@pytest.mark.parametrize(
    "record", sorted(set(ALL) - set(RECORDS)), ids=lambda path: f"{path.parents[1].name}-{path.name.split('.')[0]}"
)
def test_the_placement_of_a_gowin_holds_its_clocks(record):
    board, placement = board_of(record), read_placement(record)
    assert placement.sources == build.sources_digest(board)
    needed = {"system": build.clock_hz(board) / 1e6, "pixel": 25.2, "bit": 126}
    for net, clock in build.clock_names(board, placement.report).items():
        # nextpnr's timing of this family is young: a quarter is the margin.
        assert placement.report["fmax"][net]["achieved"] > 1.25 * needed[clock]
    if placement.seed != board["seed"]:
        return
    folder, stem = record.parents[1], stem_of(record)
    described = json.loads((folder / f"{stem}.json").read_text())
    bitstream = bz2.decompress((folder / f"{stem}.fs.bz2").read_bytes())
    assert hashlib.sha256(bitstream).hexdigest() == placement.digests["bitstream"]
    assert placement.sources == described["sources"]
    assert (described["seed"], described["tools"]) == (placement.seed, placement.tools)
    used = {cell: count["used"] for cell, count in placement.report["utilization"].items() if count["used"]}
    assert {cell: count for cell, (count, _) in described["utilisation"].items()} == used
    achieved = {round(found["achieved"], 2) for found in placement.report["fmax"].values()}
    assert set(described["fmax_mhz"].values()) == achieved


@pytest.mark.parametrize("record", RECORDS, ids=lambda path: f"{path.parents[1].name}-{path.name.split('.')[0]}")
def test_each_placement_holds_its_clocks_and_its_crossings(record):
    board, placement = board_of(record), read_placement(record)
    assert placement.sources == build.sources_digest(board)
    clocks = build.clock_names(board, placement.report)
    assert set(clocks.values()) == {"system", "pixel", "bit"}
    needed = {"system": build.clock_hz(board) / 1e6, "pixel": build.PIXEL_MHZ, "bit": build.BIT_MHZ}
    for net, clock in clocks.items():
        assert placement.report["fmax"][net]["achieved"] > needed[clock]
    # A value that crosses arrives within a period of the receiver, so it is still when its toggle is seen. The toggle
    # that the serializer loads by comes from a clock of the same PLL: it must arrive within a bit clock.
    delays = crossing_delays(placement.report, clocks)
    assert set(delays) >= {"pixel to bit", "pixel to system", "system to pixel"}
    for crossing, nanoseconds in delays.items():
        assert nanoseconds < 1000 / needed[crossing.split(" to ")[1]], crossing


SHIPPED = [path for path in RECORDS if path.name.split("-")[1].split(".")[0] == str(board_of(path)["seed"])]


@pytest.mark.parametrize("record", SHIPPED, ids=lambda path: f"{path.parents[1].name}-{stem_of(path)}")
def test_the_shipped_design_is_the_placed_one(record):
    board, placement, stem = board_of(record), read_placement(record), stem_of(record)
    folder = record.parents[1]
    config = bz2.decompress((folder / f"{stem}.config.bz2").read_bytes())
    described = json.loads((folder / f"{stem}.json").read_text())
    assert hashlib.sha256(config).hexdigest() == placement.digests["config"]
    assert hashlib.sha256(build.constraints(board).encode()).hexdigest() == placement.digests["constraints"]
    assert (described["sources"], described["seed"]) == (placement.sources, placement.seed)
    assert described["tools"] == placement.tools
    clocks = build.clock_names(board, placement.report)
    assert described["fmax_mhz"] == {
        clock: round(placement.report["fmax"][net]["achieved"], 2) for net, clock in clocks.items()
    }
    used = {cell: count["used"] for cell, count in placement.report["utilization"].items() if count["used"]}
    assert {cell: count for cell, (count, _) in described["utilisation"].items()} == used
    # The report is of this design: it has as many block RAMs and PLLs.
    assert config.count(b"\n.bram_init ") == used["DP16KD"]
    assert config.count(b"MODE EHXPLLL") == used["EHXPLLL"]


def test_every_self_test_has_a_record():
    names = {path.parents[1].name for path in ALL if path.name == f"selftest-{board_of(path)['seed']}.json.bz2"}
    assert names == set(build.board_names())


@pytest.mark.slow
@pytest.mark.parametrize("name", build.board_names())
def test_a_self_test_made_anew_is_the_shipped_one(name, tmp_path):
    for package in build.tools_of(build.read_board(name)):
        pytest.importorskip(package, reason="the tools that place designs are not installed")
    described = build.build(name, tmp_path, write_netlist=True, selftest=True)
    placement = read_placement(build.DESIGNS / name / "placements" / f"selftest-{described['seed']}.json.bz2")
    assert digests_of(tmp_path) == placement.digests
    assert described["structure"] == json.loads((build.DESIGNS / name / "selftest.json").read_text())["structure"]
    assert json.loads((tmp_path / "report.json").read_text()) == placement.report
