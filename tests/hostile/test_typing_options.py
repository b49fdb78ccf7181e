"""What people type: units, names in any case, several assets, assets where memories may stand."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest
from PIL import Image

from voxrt import BuildOptions, build, export
from voxrt.building.fitting import fit_budget
from voxrt.cli.terminal import progress
from voxrt.plans.estimate import BuildEstimate, estimate_build

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@pytest.fixture
def typed(voxrt):
    """Runs a command line in a folder with house.obj and dog.usda."""
    return voxrt


def names(folder: str = ".") -> list[str]:
    return sorted(path.name for path in Path(folder).iterdir())


def manifest(name: str = "house.json") -> dict:
    return json.loads(Path(name).read_bytes())


@pytest.mark.parametrize(
    ("typed_unit", "metres"),
    [
        ("mm", 0.001),
        ("cm", 0.01),
        ("m", 1.0),
        ("in", 0.0254),
        ("ft", 0.3048),
        ("MM", 0.001),
        ("0.5", 0.5),
        ("2cm", 0.02),
    ],
)
def test_units(typed, typed_unit, metres):
    assert typed("build", "house.obj", "--depth", "2", "--unit", typed_unit).code == 0
    assert manifest()["source"]["settings"]["unit"] == metres


@pytest.mark.parametrize(("length", "metres"), [("50cm", 0.5), ("0.5", 0.5), ("0.5 m", 0.5), ("1.5FT", 0.4572)])
def test_lengths(typed, length, metres):
    assert typed("build", "house.obj", "--voxel-size", length).code == 0
    assert manifest()["world"]["voxel_size"] == pytest.approx(metres, abs=0)


def test_names_in_any_case(typed):
    arguments = ("--depth", "3", "--up", "Z", "--fill", "Surface", "--board", "PYNQ_Z1", "--dialect", "SEED_RTL")
    assert typed("build", "house.obj", *arguments).code == 0
    document = manifest()
    assert (document["source"]["settings"]["up"], document["source"]["settings"]["fill"]) == ("z", "surface")
    assert document["dialect"] == "seed-rtl"


@pytest.mark.parametrize(
    ("size", "pixels"),
    [("64", (64, 48)), ("64x32", (64, 32)), ("64X32", (64, 32)), ("64,32", (64, 32)), ("64 x 32", (64, 32))],
)
def test_sizes(typed, size, pixels):
    assert typed("render", "house.obj", "--depth", "3", "--engine", "Model", "--size", size).code == 0
    with Image.open("house.png") as picture:
        assert picture.size == pixels


@pytest.mark.parametrize("position", ["-1,2.5,30", "-1 2.5 30", "-1, 2.5, 30", "(-1, 2.5, 30)"])
def test_positions(typed, position):
    finished = typed("trace", "house.obj", "--depth", "3", "--pixel", "1 2", "--position", position, "--json")
    assert finished.code == 0, finished.err
    assert json.loads(finished.out)["camera"]["position"] == [-1, 2.5, 30]


@pytest.mark.parametrize("version", ["-V", "--version"])
def test_version(typed, version):
    assert typed(version).out == typed("--version").out != ""


def test_help_is_a_command(typed):
    assert typed("help").out == typed("--help").out
    assert typed("help", "info").out == typed("info", "--help").out
    finished = typed("help", "frob")
    assert (finished.code, "name one of build, " in finished.err) == (2, True)


def test_quiet_and_verbose(typed):
    assert typed("build", "house.obj", "--depth", "3", "-q") == (0, "", "")
    assert "took" in typed("build", "house.obj", "--depth", "3", "-v").err
    assert "solid" in typed("info", "house.mem", "-q").out


def test_several_assets(typed):
    finished = typed("build", "house.obj", "dog.usda", "-o", "out", "--depth", "3", "--json")
    assert finished.code == 0, finished.err
    assert [report["outputs"]["mem"] for report in json.loads(finished.out)] == ["out/house.mem", "out/dog.mem"]
    assert names("out") == ["dog.json", "dog.mem", "house.json", "house.mem"]
    for wrong in (("-o", "one.mem"), ("--preview", "one.png")):
        finished = typed("build", "house.obj", "dog.usda", *wrong)
        assert (finished.code, finished.out) == (2, "")


@pytest.mark.parametrize("suffix", [".mem", ".coe", ".mif", ".bin"])
def test_the_file_of_words_by_its_name(typed, suffix):
    assert typed("build", "house.obj", "-o", f"new/yard{suffix}", "--depth", "3").code == 0
    assert names("new") == sorted(["yard.json", f"yard{suffix}"])
    assert manifest("new/yard.json")["name"] == "yard"
    assert export.read_any(f"new/yard{suffix}")[0].rom.octree.depth == 3


def test_assets_where_memories_may_stand(typed):
    assert typed("build", "house.obj", "--depth", "4").code == 0
    before = names()
    of_memory, of_asset = (typed("info", *scene).out for scene in (("house.mem",), ("house.obj", "--depth", "4")))
    assert of_memory.splitlines()[1:] == of_asset.splitlines()[1:]
    same = typed("diff", "house.obj", "house.mem")
    assert (same.code, same.out.splitlines()) == (0, ["house.obj to house.mem:", "  differ     0 voxels"])
    traces = [typed("trace", *s, "--pixel", "320,240").out for s in (("house.mem",), ("house.obj", "--depth", "4"))]
    assert traces[0].splitlines()[1:] == traces[1].splitlines()[1:] != []
    assert names() == before
    assert typed("convert", "house.obj", "two.coe", "--depth", "4").code == 0
    assert manifest("two.json")["objects"] == manifest()["objects"]
    assert manifest("two.json")["source"] == manifest()["source"]


def test_answers_go_to_standard_output_and_warnings_do_not(typed):
    for arguments in (("info", "dog.usda", "--depth", "3"), ("diff", "dog.usda", "house.obj", "--depth", "3")):
        finished = typed(*arguments)
        assert finished.code == 0
        assert finished.out.count("\n") > 1
        assert all(line.startswith("voxrt: warning: ") for line in finished.err.splitlines())


def test_lists_are_whole(typed):
    lines = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "mtllib many.mtl"]
    Path("many.mtl").write_text("".join(f"newmtl colour{number}\nKd 0.{number} 0 0\n" for number in range(10, 40)))
    lines += [line for number in range(10, 40) for line in (f"usemtl colour{number}", "f 1 2 3")]
    Path("many.obj").write_text("\n".join(lines) + "\n")
    finished = typed("build", "many.obj", "--depth", "3", "--interior", "gold")
    assert finished.code == 3
    assert all(f"colour{number}" in finished.err for number in range(10, 40))


def test_a_board_that_takes_much_of_the_surface_names_the_depth_that_fits(typed, monkeypatch):
    monkeypatch.setitem(sys.modules["voxrt.octree"].BOARDS, "pynq-z1", 500)
    finished = typed("build", "house.obj", "--depth", "6", "--board", "pynq-z1")
    assert finished.code == 0, finished.err
    assert "% of the surface; --depth 3 fits without loss, in 161 words" in finished.err
    assert "nothing is given up" in typed("build", "house.obj", "--depth", "3", "--board", "pynq-z1").err


def test_the_depth_that_fits_is_the_greatest():
    built = build(EXAMPLES / "house.obj", depth=6, budget=500)
    assert built.budget is not None
    assert built.budget.fit.percent_changed > 10
    sizes = {depth: len(build(EXAMPLES / "house.obj", depth=depth).octree.words) for depth in (3, 4)}
    assert built.budget.lossless == (3, sizes[3])
    assert sizes[4] > 500
    assert fit_budget(built.rom, 10**6, (64, 48), 0)[1].lossless is None


def test_an_estimate_before_a_long_build(capfd):
    bar = progress.BuildBar()
    bar.estimate(BuildEstimate(59.0, 1 << 30))
    assert capfd.readouterr().err == ""
    bar.estimate(BuildEstimate(200.0, 1 << 30))
    assert "this will take about 3 minutes and 1.0 GB of memory" in capfd.readouterr().err
    bar.estimate(BuildEstimate(5.0, 6 << 30))
    assert "this will take about 5 seconds and 6.0 GB of memory" in capfd.readouterr().err


def test_estimates_grow_with_the_surface():
    results = []
    for depth in (6, 8, 14):
        built: list[BuildEstimate] = []
        scene = build(EXAMPLES / "house.obj", depth=4).scene
        from voxrt import fit_grid

        built.append(estimate_build(scene, fit_grid(scene, depth=depth), BuildOptions(depth=depth)))
        results += built
    assert results[0].seconds < results[1].seconds < 10
    assert results[2].seconds > 60
    large = BuildOptions(preview=True, engine="rtl", size=(8192, 8192))
    assert estimate_build(scene, fit_grid(scene, depth=4), large).seconds > 60


def test_the_bar_of_a_picture_counts_its_rows(monkeypatch):
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    with progress.build_bar() as bar:
        bar.estimate(BuildEstimate(100.0, 0))
        bar.rows(3, 10)
        bar._progress.refresh()
        (task,) = bar._progress.tasks
        assert (task.completed, task.total) == (3, 10)
