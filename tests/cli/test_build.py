"""``voxrt build``: the files, the JSON and the summary that it promises."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import msgspec
import numpy as np
import pytest
from PIL import Image

from voxrt.cli.results.build_results import BuildReport
from voxrt.options.notations import BACKGROUNDS
from voxrt.voxelize import DEFAULT_COLOURS


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def without_seconds(manifest: bytes) -> dict:
    return {key: value for key, value in json.loads(manifest).items() if key != "seconds"}


def test_writes_memory_and_manifest_and_tells_people(voxrt, folder):
    finished = voxrt.succeeds("build", "house.obj", "-o", "out", "--depth", "5")
    assert finished.out == ""
    assert sorted(files(folder / "out")) == ["house.json", "house.mem"]
    assert "32 voxels per side (depth 5)" in finished.err
    assert "out/house.mem" in finished.err


def test_the_default_depth_is_7_and_the_default_folder_is_here(voxrt, folder):
    assert voxrt("build", "house.obj").code == 0
    assert json.loads((folder / "house.json").read_bytes())["depth"] == 7


def test_a_voxel_size_instead_of_a_depth(voxrt, folder):
    assert voxrt("build", "house.obj", "--voxel-size", "0.5").code == 0
    manifest = json.loads((folder / "house.json").read_bytes())
    assert manifest["depth"] == 4
    assert manifest["world"]["voxel_size"] == 0.5


def test_json_is_all_that_stdout_gets_and_keeps_its_promise(process, folder):
    finished = process.succeeds("build", "house.obj", "-o", "out", "--depth", "5", "--preview", "--no-check", "--json")
    report = msgspec.json.decode(finished.out, type=BuildReport, strict=True)
    result = json.loads(finished.out)
    keys = {"outputs", "depth", "words", "blocks", "voxels", "materials", "warnings", "seconds", "render"}
    assert keys <= set(result)
    assert {"rays", "cycles", "words_read", "cycles_per_pixel", "words_per_ray", "seconds"} <= set(result["render"])
    assert report.outputs == {"mem": "out/house.mem", "manifest": "out/house.json", "preview": "out/house.preview.png"}
    manifest = json.loads((folder / "out/house.json").read_bytes())
    for key in ("depth", "words", "blocks", "voxels"):
        assert result[key] == manifest[key], key
    assert report.words == 1 + 8 * report.blocks == len((folder / "out/house.mem").read_text().split())
    assert [material.name for material in report.materials[1:]] == ["timber", "glass", "brick", "plaster", "tiles"]
    assert list(report.seconds) == [
        "start", "load", "fit", "colour", "voxelize", "octree", "write", "preview", "rest",
    ]  # fmt: skip
    assert report.render is not None
    assert report.render.rays == 16 * 640 * 480
    assert report.render.cycles is None
    assert report.render.words_per_ray is None


def test_without_preview_render_is_null(voxrt):
    assert voxrt.json("build", "house.obj", "--depth", "3")["render"] is None


@pytest.mark.parametrize("asset", ["house.obj", "dog.usda"])
def test_the_same_input_gives_the_same_bytes(process, folder, asset):
    for out in ("one", "two"):
        arguments = ("build", asset, "-o", out, "--depth", "6", "--preview", "--engine", "model", "--size", "80x60")
        assert process(*arguments, env={"PYTHONHASHSEED": str(len(out) + ord(out[0]))}).code == 0
    one, two = files(folder / "one"), files(folder / "two")
    name = asset.split(".")[0]
    assert one[f"{name}.mem"] == two[f"{name}.mem"]
    assert one[f"{name}.preview.png"] == two[f"{name}.preview.png"]
    assert without_seconds(one[f"{name}.json"]) == without_seconds(two[f"{name}.json"])


def test_preview_may_stand_before_the_asset_and_may_have_a_file(voxrt, folder):
    assert voxrt("build", "--preview", "house.obj", "--depth", "3", "--engine", "model").code == 0
    assert (folder / "house.preview.png").is_file()
    arguments = ("--preview", "new/picture.png", "house.obj", "--depth", "3", "--engine", "model", "--size", "32x20")
    assert voxrt("build", *arguments).code == 0
    with Image.open(folder / "new/picture.png") as picture:
        assert picture.size == (32, 20)


def test_the_preview_shows_the_scene(voxrt, folder):
    assert voxrt("build", "house.obj", "--depth", "6", "--preview", "--no-check").code == 0
    with Image.open(folder / "house.preview.png") as picture:
        pixels = np.asarray(picture)
    assert pixels[0, 0].tolist() == list(BACKGROUNDS["light"])
    tiles = (pixels[..., 0] > 2.0 * pixels[..., 2]) & (pixels[..., 0] > 100)
    assert 0.03 < tiles.mean() < 0.5
    drawn = (pixels != pixels[0, 0]).any(axis=2)
    assert not drawn[0].any()
    assert not drawn[-1].any()
    assert not drawn[:, 0].any()
    assert not drawn[:, -1].any()
    assert drawn.any(axis=1).mean() > 0.7 or drawn.any(axis=0).mean() > 0.7


@pytest.mark.parametrize(("dialect", "empty"), [("report", "FFFFFF00"), ("seed-rtl", "FFFFFFF0"), ("msb", "80000000")])
def test_dialects(voxrt, folder, dialect, empty):
    assert voxrt("build", "house.obj", "--depth", "4", "--dialect", dialect).code == 0
    assert empty in (folder / "house.mem").read_text().split()
    assert json.loads((folder / "house.json").read_bytes())["dialect"] == dialect
    assert voxrt("render", "house.mem", "--engine", "model", "--size", "8x8").code == 0


def test_options_reach_their_stage(voxrt, folder):
    def built(*options: str) -> dict:
        return voxrt.json("build", "house.obj", "--depth", "5", *options)

    plain = built()
    assert built("--fill", "surface")["voxels"] < plain["voxels"]
    assert built("--geometry", "collider")["voxels"] > plain["voxels"]
    built("--up", "z")
    assert json.loads((folder / "house.json").read_bytes())["source"]["settings"]["up"] == "z"
    built("--unit", "0.01")
    assert json.loads((folder / "house.json").read_bytes())["world"]["voxel_size"] == pytest.approx(0.0775 / 32)
    rounded, exact = voxrt.json("build", "dog.usda"), voxrt.json("build", "dog.usda", "--pow2", "none")
    assert rounded["voxels"] > exact["voxels"]
    assert rounded["words"] < exact["words"]


def test_interiors_are_made_what_is_asked(voxrt, folder):
    """A cube of 16 voxels: its shell is brick, which none of its inside need be."""

    def built(*options: str) -> dict:
        return voxrt.json("build", "cube.obj", "--depth", "4", *options)

    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
    text += "".join(
        f"usemtl {name}\nf {' '.join(map(str, face))}\n"
        for name, face in zip(["brick", "slate", *["brick"] * 4], faces, strict=True)
    )
    (folder / "cube.obj").write_text(text)
    kept = built()
    assert kept["interior"] is None
    for option, number in (("slate", 2), ("2", 2), ("brick", 1)):
        made = built("--interior", option, "--profile")
        assert made["interior"] == {"material": number, "hidden": 14**3, "words_before": kept["words"]}
        assert made["seconds"]["interior"] > 0
        manifest = json.loads((folder / "cube.json").read_bytes())
        assert manifest["source"]["settings"]["interior"] == option
        assert manifest["materials"][number]["voxels"] >= 14**3
    shared = built("--interior", "any")
    assert shared["interior"]["material"] is None
    assert shared["words"] <= kept["words"]
    assert shared["voxels"] == kept["voxels"] == 16**3
    assert built("--interior", "any", "--budget", str(shared["words"]))["budget"]["recoloured"] == 0
    assert "interior" in voxrt("build", "cube.obj", "--interior", "any", "--depth", "4", "--profile").err


@pytest.mark.parametrize("material", ["marble", "0", "9", "-1"])
def test_interiors_of_no_material(voxrt, material):
    voxrt.fails(
        3,
        f"has no material {material!r} for its interior; name one of: 1 timber, 2 glass",
        "build",
        "house.obj",
        f"--interior={material}",
    )


def test_warnings_go_to_people_and_to_programs(voxrt):
    finished = voxrt.succeeds("build", "dog.usda", "--depth", "5", "--unit", "2", "--json")
    assert "voxrt: warning: " in finished.err
    assert "ignored-option" in [warning["kind"] for warning in json.loads(finished.out)["warnings"]]


@pytest.mark.parametrize(
    "name", [b"with space.obj", b"caf\xc3\xa9.obj", b"caf\xe9.obj", b"back\\slash.obj", b"-dash.obj"]
)
def test_names(process, folder, name):
    shutil.copy(folder / "house.obj", folder / os.fsdecode(name))
    finished = process.succeeds(
        "build", "--depth", "3", "-o", "out", "--preview", "--engine", "model", "--json", "--", os.fsdecode(name)
    )
    outputs = json.loads(finished.out)["outputs"]
    assert all((folder / output).is_file() for output in outputs.values()), outputs
    stem = name.removesuffix(b".obj").decode("utf-8", "replace").replace("\ufffd", "_").replace("\\", "_")
    assert outputs["mem"] == f"out/{stem}.mem"


def test_build_is_one_command_with_three_names(folder):
    scripts = Path(sys.executable).parent
    outputs = []
    for command in ([scripts / "voxrt-build"], [scripts / "voxrt", "build"], [sys.executable, "-m", "voxrt", "build"]):
        subprocess.run([*command, "house.obj", "--depth", "4"], cwd=folder, check=True, capture_output=True)
        outputs.append((folder / "house.mem").read_bytes())
        (folder / "house.mem").unlink()
    assert outputs[0] == outputs[1] == outputs[2]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_permission(voxrt, folder):
    (folder / "out").mkdir(mode=0o500)
    voxrt.fails(2, "no permission to write in out", "build", "house.obj", "-o", "out")


def test_a_target_that_is_a_folder(voxrt, folder):
    (folder / "house.mem").mkdir()
    voxrt.fails(2, "cannot be written", "build", "house.obj", "--depth", "3")


def test_strict_makes_warnings_errors(voxrt, folder):
    before = sorted(folder.iterdir())
    voxrt.fails(3, "voxrt: error: dog.usda: ", "build", "dog.usda", "--depth", "5", "--unit", "2", "--strict")
    assert sorted(folder.iterdir()) == before
    assert voxrt("build", "dog.usda", "--depth", "5", "--strict").code == 0


def test_a_budget_is_kept_and_its_price_told(voxrt, folder):
    arguments = ("build", "house.obj", "--depth", "6")
    whole = voxrt.json(*arguments)
    assert whole["budget"] is None
    fitted = voxrt.json(*arguments, "--budget", whole["words"] // 2)
    assert fitted["words"] <= whole["words"] // 2
    assert fitted["voxels"] >= whole["voxels"]
    assert fitted["budget"]["words_before"] == whole["words"]
    assert 0 < fitted["budget"]["percent_changed"] < 50
    assert 0 < fitted["budget"]["ssim"] < 1
    assert len((folder / "house.mem").read_text().split()) == fitted["words"]
    assert "% of the surface changed" in voxrt(*arguments, "--budget", whole["words"] // 2).err
    enough = voxrt.json(*arguments, "--board", "pynq-z1")
    assert enough["words"] == whole["words"]
    assert enough["budget"]["psnr"] is None


def test_a_budget_that_cannot_be_met(voxrt):
    voxrt.fails(4, "give it at least", "build", "house.obj", "--depth", "6", "--budget", "5")


def test_time_and_variants_reach_the_loader(voxrt):
    result = voxrt.json("build", "house.obj", "--depth", "3", "--time", "1", "--variant", "red")
    kinds = [warning["kind"] for warning in result["warnings"]]
    assert kinds.count("ignored-option") == 2


def test_an_image_of_fractions_is_refused_before_the_build(voxrt, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyvista", None)
    build = ("build", "house.obj", "-o", "out", "--fractions", "a.VTI", "--depth")
    voxrt.fails(4, "at most 256 voxels per side", *build, 9)
    voxrt.fails(5, "needs PyVista, which is not installed; pip install pyvista", *build, 4)
    assert not Path("out").exists()


def test_profile_has_a_row_a_stage(voxrt):
    finished = voxrt.succeeds("build", "house.obj", "--depth", "3", "--profile", "--json")
    lines = [line[2:] for line in finished.err.splitlines()]
    stages = [line.split()[0] for line in lines if not line.startswith(" ")]
    assert stages == ["stage", *json.loads(finished.out)["seconds"], "all"]
    first = next(i for i, line in enumerate(lines) if line.startswith("voxelize")) + 1
    parts = ["analysis", "bin", "coverage", "fill", "holes", "order", "gather"]
    assert [line.split()[0] for line in lines[first : first + len(parts)]] == parts


PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 1
property list uchar int vertex_indices
end_header
0 0 0 255 0 0
1 0 0 0 255 0
0 1 0 0 0 255
3 0 1 2
"""


def test_colours_bound_what_paint_is_reduced_to(voxrt, folder):
    (folder / "rainbow.ply").write_text(PLY)
    for options, most in ((("--colours", "5"), 5), ((), DEFAULT_COLOURS)):
        assert voxrt("build", "rainbow.ply", "--depth", "6", *options).code == 0
        manifest = json.loads((folder / "rainbow.json").read_bytes())
        names = [material["name"] for material in manifest["materials"][1:]]
        assert names[0] == "vertex colours"
        assert most * 0.8 < len(names) - 1 <= most
        assert all(name.startswith("vertex colours #") for name in names[1:])
        assert manifest["source"]["settings"]["colours"] == most
    voxrt.fails(2, "--colours must be an integer 1 … 254, not 255", "build", "rainbow.ply", "--colours", "255")
