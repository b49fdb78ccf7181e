"""``voxrt render``: cameras from all, some or no registers; memories with and without manifest; both engines."""

from __future__ import annotations

import json
import sys

import msgspec
import numpy as np
import pytest
from PIL import Image

from voxrt.cli.results.build_results import RenderResult

MODEL = ("--engine", "model", "--size", "64x48")
PLAIN = ("--samples", "1", "--background", "dark")


def test_json(voxrt, built):
    finished = voxrt.succeeds("render", "house.mem", "-o", "out/picture.png", *MODEL, "--json")
    result = msgspec.json.decode(finished.out, type=RenderResult, strict=True)
    keys = {"rays", "cycles", "words_read", "cycles_per_pixel", "words_per_ray", "seconds"}
    assert keys <= set(json.loads(finished.out))
    assert result.rays == 64 * 48
    assert result.size == (64, 48)
    assert result.outputs == {"picture": "out/picture.png"}
    assert "wrong_pixels" not in json.loads(finished.out)
    with Image.open(built / "out/picture.png") as picture:
        assert picture.size == (64, 48)


def test_the_picture_has_the_memorys_name_and_the_previews_pixels(voxrt, built):
    assert voxrt("render", "house.mem", *MODEL).code == 0
    assert voxrt("build", "house.obj", "--depth", "5", *MODEL, *PLAIN, "--preview").code == 0
    assert (built / "house.png").read_bytes() == (built / "house.preview.png").read_bytes()


@pytest.mark.usefixtures("built")
def test_registers_are_taken_as_they_are(voxrt):
    registers = ("--look", "3,-2,-90", "--right", "1,0,0", "--up", "-0,1,0")
    result = voxrt.json("render", "house.mem", *MODEL, "--position", "-5,3.0625,-2", *registers)
    assert result["camera"] == {"position": [-5, 3.0625, -2], "look": [3, -2, -90], "right": [1, 0, 0], "up": [0, 1, 0]}


@pytest.mark.usefixtures("built")
def test_registers_that_make_no_camera(voxrt):
    for registers in (["--look", "0,0,0"], ["--look", "0,0,9", "--right", "0,0,1"], ["--up", "0,0,0"]):
        voxrt.fails(2, "", "render", "house.mem", *MODEL, *registers)


def test_without_manifest(voxrt, built):
    (built / "house.json").unlink()
    finished = voxrt.succeeds("render", "house.mem", *MODEL)
    assert "no manifest" in finished.err
    voxrt.succeeds("render", "house.mem", *MODEL, "--depth", "6", "--dialect", "report")
    voxrt.fails(3, "", "render", "house.mem", *MODEL, "--depth", "1")


def test_a_damaged_memory(voxrt, built):
    memory = built / "house.mem"
    memory.write_text(memory.read_text().replace("FFFFFF00", "00000002", 1))
    (built / "house.json").unlink()
    voxrt.fails(3, "voxrt: error: house.mem: ", "render", "house.mem", *MODEL)


def test_memory_and_manifest_of_different_builds(voxrt, built):
    memory = built / "house.mem"
    memory.write_text(memory.read_text() + "FFFFFF00\n" * 8)
    voxrt.fails(3, "house.json", "render", "house.mem", *MODEL)


@pytest.mark.usefixtures("built")
def test_directions_out_of_range(voxrt):
    registers = ("--right", "32000,0,0", "--look", "0,0,-9", "--up", "0,9,0")
    voxrt.fails(5, "2**20", "render", "house.mem", "--engine", "model", "--size", "640x480", *registers)


def test_an_installation_without_the_ray_tracer_says_the_way_out(voxrt, folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "voxrt.sim._rtl", None)
    build = ("build", "house.obj", "--depth", "3", "--preview")
    for arguments in ((*build, "--engine", "rtl"), ("render", "house.mem", "--engine", "rtl")):
        finished = voxrt.fails(5, "no verilated ray tracer", *arguments)
        assert "--engine model" in finished.error
    assert {"house.mem", "house.json"} <= {path.name for path in folder.iterdir()}
    assert not list(folder.glob("*.png"))
    voxrt.fails(5, "no verilated ray tracer", *build, "--check")
    assert (folder / "house.preview.png").exists()
    assert "checked" not in voxrt.succeeds(*build).err


@pytest.fixture
def ray_tracer():
    pytest.importorskip("voxrt.sim._rtl", reason="this build has no verilated ray tracer")


@pytest.mark.usefixtures("ray_tracer")
def test_the_ray_tracer_counts_its_clocks(voxrt, built):
    result = voxrt.json("render", "house.mem", "--size", "64x48", "--engine", "rtl")
    for options in (["--config", "tiny"], ["--check"]):
        assert voxrt.json("render", "house.mem", "--size", "64x48", *options)["engine"] == "rtl"
    assert voxrt.json("render", "house.mem", "--size", "64x48")["engine"] == "model"
    assert result["cycles"] > result["rays"]
    assert result["cycles_per_pixel"] == pytest.approx(result["cycles"] / result["rays"])
    hardware = (built / "house.png").read_bytes()
    assert voxrt("render", "house.mem", *MODEL).code == 0
    assert (built / "house.png").read_bytes() == hardware


@pytest.mark.usefixtures("ray_tracer", "folder")
def test_a_preview_is_checked_where_that_is_quick(voxrt):
    build = ("build", "house.obj", "--depth", "4", "--preview", "--size", "64x48")
    checked = voxrt.json(*build)["check"]
    assert (checked["pixels"], checked["wrong_pixels"]) == (64 * 48, 0)
    assert checked["cycles_per_pixel"] > 1
    assert "0 of 3,072 pixels differ" in voxrt.succeeds(*build).err
    for options in (("--no-check",), ("--engine", "rtl"), ("--size", "2048x1536")):
        assert voxrt.json(*build[: -2 if options[0] == "--size" else None], *options)["check"] is None
    for options in (("--check", "--no-check"), ("--check",)):
        arguments = build[:4] if len(options) == 1 else build
        voxrt.fails(2, "--check", *arguments, *options)


@pytest.mark.usefixtures("ray_tracer", "built")
def test_check_counts_wrong_pixels(voxrt):
    assert voxrt.json("render", "house.mem", "--size", "64x48", "--check")["wrong_pixels"] == 0


@pytest.mark.usefixtures("ray_tracer", "built")
def test_check_fails_where_the_engines_differ(voxrt, monkeypatch):
    module = sys.modules["voxrt.sim.rendering"]
    render = module._render_model

    def wrong(*arguments, **options):
        frame = render(*arguments, **options)
        frame.face[7, 5] ^= 1
        return frame

    monkeypatch.setattr(module, "_render_model", wrong)
    finished = voxrt("render", "house.mem", "--size", "64x48", "--check", "--json")
    assert finished.code == 5
    assert json.loads(finished.out)["wrong_pixels"] == 1
    assert "1 pixels differ" in finished.error


@pytest.mark.usefixtures("built")
def test_a_turntable_comes_around(voxrt, folder):
    for suffix in ("gif", "webp"):
        voxrt.succeeds("render", "house.mem", "--turntable", "--size", "48x36", "-o", f"turn.{suffix}")
        with Image.open(folder / f"turn.{suffix}") as film:
            assert (film.n_frames, film.size, film.info["loop"]) == (72, (48, 36), 0)
            shown = []
            for number in (0, 1, 18, 71):
                film.seek(number)
                shown.append(np.asarray(film.convert("RGB"), int))
        near = [np.abs(shown[0] - one).mean() for one in (shown[1], shown[3])]
        assert 0 < max(near) < np.abs(shown[0] - shown[2]).mean()
    for options in (("--check",), ("--look", "0,0,-1"), ("-o", "turn.png"), ("--background", "transparent")):
        voxrt.fails(
            2,
            "turntable" if options[0] != "--background" else "transparent",
            "render",
            "house.mem",
            "--turntable",
            *options,
        )
    voxrt.fails(2, "choose a smaller --size", "render", "house.mem", "--turntable", "--size", "16384x16384")
    voxrt.fails(2, "or give --turntable", "render", "house.mem", "-o", "turn.webp")


def test_light_bounces_and_shading(voxrt, built):
    pictures = []
    for options in (
        [],
        ["--light", "-20,90.5,-31", "--ambient", "5"],
        ["--shading", "flat"],
        ["--shading", "report"],
        ["--bounces", "2"],
    ):
        voxrt.succeeds("render", "house.mem", *MODEL, *options)
        pictures.append((built / "house.png").read_bytes())
    assert len(set(pictures[:4])) == 4
    for options in (["--bounces", "16"], ["--light", "1,2,3", "--ambient", "256"]):
        voxrt.fails(5, "", "render", "house.mem", *MODEL, *options)


def test_samples_and_backgrounds(voxrt, built):
    pictures = {}
    for options in ((), ("--samples", "2"), ("--background", "light"), ("--background", "#102030")):
        voxrt.succeeds("render", "house.mem", *MODEL, *options)
        with Image.open(built / "house.png") as picture:
            assert picture.mode == "RGB"
            pictures[options] = np.array(picture)
    assert len({picture.tobytes() for picture in pictures.values()}) == 4
    assert pictures["--background", "light"][0, 0].tolist() == [236, 240, 244]
    assert pictures["--background", "#102030"][0, 0].tolist() == [16, 32, 48]
    voxrt.succeeds("render", "house.mem", *MODEL, "--background", "transparent", "--samples", "4")
    with Image.open(built / "house.png") as picture:
        opacity = np.array(picture)[..., 3]
    assert {0, 255} < set(np.unique(opacity).tolist())
    for wrong, message in ((("--samples", "3"), "1, 2"), (("--background", "blue"), "dark, light, transparent or a")):
        voxrt.fails(2, message, "render", "house.mem", *MODEL, *wrong)


@pytest.mark.usefixtures("ray_tracer")
def test_every_sample_is_compared(voxrt, built):
    result = voxrt.json("render", "house.mem", "--size", "40x30", "--check", "--samples", "2")
    assert (result["wrong_pixels"], result["rays"]) == (0, 4 * 40 * 30)
    assert (built / "house.png").exists()
