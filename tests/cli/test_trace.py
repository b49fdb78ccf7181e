"""``voxrt trace``: the way of one pixel's ray."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import msgspec
import numpy as np
import pytest
from PIL import Image

from voxrt import read_rom
from voxrt.cli.commands.trace import wave_rows
from voxrt.cli.results.memory_results import TraceResult
from voxrt.octree import material_at
from voxrt.sim.wave import Wave

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def test_what_a_ray_reads(voxrt, folder):
    assert voxrt("build", "house.obj", "--depth", "5").code == 0
    finished = voxrt.succeeds("trace", "house.mem", "--pixel", "32,24", "--size", "64x48", "--json")
    result = msgspec.json.decode(finished.out, type=TraceResult, strict=True)
    rom = read_rom(folder / "house.mem")[0]
    assert [rom.octree.words[reading.address] for reading in result.readings] == [r.word for r in result.readings]
    assert result.material == material_at(rom.octree, result.voxel) != 0
    assert result.face in {"x", "y", "z"}
    for_people = voxrt("trace", "house.mem", "--pixel", "32,24", "--size", "64x48")
    assert for_people.err == ""
    lines, colour = (part.splitlines() for part in for_people.out.split("The colour of the pixel:\n"))
    assert f"colour     #{bytes(result.colour.rgb).hex()}" in colour[-1]
    assert f"reads      {len(result.readings)} words" in for_people.out
    for number, reading in enumerate(result.readings, 1):
        line = lines[len(lines) - len(result.readings) + number - 1].split()
        assert line[:3] == [str(number), f"0x{reading.address:X}", f"0x{reading.word:08X}"]
        assert f"{reading.axis} = " in " ".join(line)
    assert f"leaf: material {result.material}, {rom.materials[result.material].name}" in lines[-1]
    asset = voxrt("trace", "house.obj", "--depth", "5", "--pixel", "32,24", "--size", "64x48", "--json")
    assert msgspec.json.decode(asset.out, type=TraceResult) == result


def test_a_miss_and_a_camera_within_a_solid(voxrt, folder):
    assert voxrt("build", "house.obj", "--depth", "5").code == 0
    assert "hits       nothing" in voxrt("trace", "house.mem", "--pixel", "0,0").out
    away = ("--position", "-9,5,5", "--look", "-1,0,0")
    missed = msgspec.json.decode(voxrt("trace", "house.mem", "--pixel", "320,240", *away, "--json").out)
    assert (missed["readings"], missed["material"], missed["face"], missed["voxel"]) == ([], 0, None, None)
    x, y, z = next(
        voxel
        for voxel in ((n % 32, n // 32 % 32, n // 1024) for n in range(32**3))
        if material_at(read_rom(folder / "house.mem")[0].octree, voxel)
    )
    within = voxrt("trace", "house.mem", "--pixel", "9,9", "--position", f"{x}.5,{y}.5,{z}.5")
    assert f"hits       voxel {x}, {y}, {z}, from within: material" in within.out
    assert "the eye" in within.out


@pytest.mark.parametrize(
    "lighting",
    [
        (),
        ("--shading", "report"),
        ("--shading", "flat"),
        ("--light", "60,90,60", "--ambient", "30"),
        ("--light", "60,90,60", "--shading", "report"),
        ("--bounces", "3"),
    ],
    ids=" ".join,
)
def test_the_colour_is_that_of_the_rendered_pixel(voxrt, folder, lighting):
    shutil.copy(EXAMPLES / "courtyard.glb", folder)
    assert voxrt("build", "courtyard.glb", "--depth", "6").code == 0
    size = ("--size", "160x120")
    assert voxrt("render", "courtyard.mem", *size, "--engine", "model", *lighting).code == 0
    with Image.open("courtyard.png") as picture:
        pixels = picture.convert("RGB")
    for column, row in np.random.default_rng(len(lighting)).integers(0, (160, 120), (12, 2)).tolist():
        arguments = ("trace", "courtyard.mem", "--pixel", f"{column},{row}", *size, *lighting)
        colour = pixels.getpixel((column, row))
        assert f"colour     #{bytes(colour).hex()}, " in voxrt(*arguments).out.splitlines()[-1]
        assert tuple(json.loads(voxrt(*arguments, "--json").out)["colour"]["rgb"]) == colour


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (("--pixel", "640,0"), "pixel 640,0 lies outside the picture of 640x480; columns go to 639, rows to 479"),
        (("--pixel", "1"), "'1' is not COLUMN,ROW"),
        (("--pixel", "-1,2"), "'-1,2' is not COLUMN,ROW"),
        ((), "--pixel"),
    ],
)
def test_wrong_pixels(voxrt, arguments, problem):
    voxrt.fails(2, problem, "trace", "house.obj", *arguments)


def test_the_wave_of_a_pixel(voxrt, folder):
    verilated = pytest.importorskip("voxrt.sim._rtl")
    assert verilated.WAVE
    arguments = ("trace", "house.obj", "--depth", "5", "--pixel", "32,24", "--size", "64x48", "--wave", "out/ray.vcd")
    done = voxrt.succeeds(*arguments)
    files = [str(Path("out", f"ray{suffix}")) for suffix in (".vcd", ".gtkw", ".sucl")]
    for file in files:
        assert f"  wrote      {file}" in done.err
        assert (folder / file).stat().st_size > 100
    assert f"gtkwave {files[0]} {files[1]}" in done.err
    result = msgspec.json.decode(voxrt.succeeds(*arguments, "--json").out, type=TraceResult)
    assert list(result.outputs.values()) == files
    assert (folder / files[2]).read_text().count("marker_set") == len(result.readings)


def test_a_wave_of_another_format_is_refused(voxrt):
    voxrt.fails(
        2, "waves are VCD or FST files; give it a name that ends in .vcd or .fst",
        "trace", "house.obj", "--pixel", "1,1", "--wave", "ray.png",
    )  # fmt: skip


def test_what_a_wave_leaves_out_is_printed():
    outputs = {"wave": "ray.vcd", "gtkwave": "ray.gtkw", "surfer": "ray.sucl"}
    rows = dict(wave_rows(Wave((), tuple(range(40, 320, 10)), 400, 2), outputs))
    assert rows["markers"] == "GTKWave has none for the last 2 of 28 words"
    assert rows["rays"].startswith("the lane traces 2 rays, this one first")
    assert not {"markers", "rays"} & dict(wave_rows(Wave((), (40,), 400, 1), outputs)).keys()
