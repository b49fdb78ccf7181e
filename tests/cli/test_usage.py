"""Every wrong command line and every unusable file is one line and the promised exit code."""

from __future__ import annotations

import shutil
import subprocess

import pytest


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["frob"], "there is no command 'frob'"),
        (["build"], "ASSET is missing"),
        (["build", "house.obj", "--bogus"], "--bogus"),
        (["build", "house.obj", "--dept", "3"], "did you mean --depth"),
        (["board", "chek", "serial:x"], 'error: \'chek\' is none of "check", "report"; did you mean check; see'),
        (["completion", "bsh"], 'error: \'bsh\' is none of "bash", "zsh", "fish"; did you mean bash; see'),
        (
            ["build", "house.obj", "--rule", "toch"],
            '--rule: \'toch\' is none of "touch", "centre", "half"; did you mean touch',
        ),
        (["build", "house.obj", "--depth"], "--depth requires an argument: N"),
        (["build", "house.obj", "--depth", "--json"], "--depth requires an argument: N"),
        (["build", "house.obj", "--depth", "3", "--depth", "4"], "--depth is given 2 times"),
        (["build", "house.obj", "--json=yes"], "--json"),
        (["build", "house.obj", "-x"], "-x"),
        (["info", "house.obj", "dog.usda"], "dog.usda is one argument too many"),
        (["build", "house.obj", "--depth", "3.5"], "'3.5' is not a whole number"),
        (["build", "house.obj", "--depth", "0"], "--depth must be an integer 1 … 16, not 0"),
        (["build", "house.obj", "--depth", "17"], "--depth must be an integer 1 … 16, not 17"),
        (["build", "house.obj", "--memory", "much"], "'much' is not a size such as 4G or 512M"),
        (["build", "house.obj", "--memory", "1M"], "--memory must be 64M to 4194303T"),
        (["build", "house.obj", "--memory", "9" * 60], "--memory must be 64M to 4194303T"),
        (["build", "house.obj", "--depth", "3", "--voxel-size", "1"], "exclude each other"),
        (["build", "house.obj", "--voxel-size", "-1"], "--voxel-size must be a finite number above 0, not -1"),
        (["build", "house.obj", "--voxel-size", "nan"], "--voxel-size must be a finite number above 0, not nan"),
        (["build", "house.obj", "--unit", "0"], "--unit must be a finite number from 1e-12 to 1e+12, not 0"),
        (["build", "house.obj", "--unit", "inf"], "--unit must be a finite number from 1e-12 to 1e+12, not inf"),
        (["build", "house.obj", "--unit", "inch"], "'inch' is not a number"),
        (["build", "house.obj", "--budget", "0"], "--budget must be an integer 1 "),
        (["build", "house.obj", "--budget", "9", "--board", "pynq-z1"], "exclude each other"),
        (["build", "house.obj", "--board", "abacus"], "there are icepi-zero, pynq-z1, tang-nano-20k, ulx3s-12f"),
        (["build", "house.obj", "--time", "inf"], "--time must be a finite number, not inf"),
        (["build", "house.obj", "--fill", "half"], '"solid", "surface"'),
        (["build", "house.obj", "--size", "640x480x3"], "is not WIDTHxHEIGHT"),
        (["build", "house.obj", "--voxel-size", "cm"], "is not a number"),
        (["build", "house.obj", "--up", "w"], '"x", "y", "z"'),
        (["build", "house.obj", "--size", "0x480"], "--size[0] must be an integer 1 … 16384, not 0"),
        (["build", "house.obj", "--size", "99999x99999"], "--size[0] must be an integer 1 … 16384, not 99999"),
        (["build", "house.obj", "--preview", "picture.jpg"], "ends in .png"),
        (["build", "house.obj", "-o", "house.mtl"], "house.mtl is a file, not a folder"),
        (["build", "house.obj", "-o", "house.mtl/deeper"], "house.mtl is a file, not a folder"),
        (["build", "house.obj", "--preview", "house.mtl/picture.png"], "house.mtl is a file, not a folder"),
        (["render", "house.mem", "-o", "picture.bmp"], "ends in .png"),
        (["render", "house.mem", "--position", "1,2"], "is not X,Y,Z"),
        (["render", "house.mem", "--position", "1,2,x"], "'x' is not a number"),
        (["render", "house.mem", "--position", "1,2,0.05"], "multiple of 1/16"),
        (["render", "house.mem", "--position", "1,2,1e99999"], "out of range"),
        (["render", "house.mem", "--look", "0,0,40000"], "signed 16 bits"),
        (["render", "house.mem", "--look", "0,0,0.5"], "three whole numbers"),
        (["core", "--config", "tiny"], "--config and --verilog need each other"),
        (["core", "--verilog", "tiny.v"], "--config and --verilog need each other"),
        (["core", "--path", "--config", "tiny", "--verilog", "tiny.v"], "--path excludes"),
        (["core", "--config", "huge", "--verilog", "huge.v"], "name one of tiny, micro, nano, duo, quad"),
        (["core", "--config", "tiny", "--verilog", "tiny.sv"], "ends in .v"),
        (["core", "--config", "tiny", "--verilog", "house.mtl/tiny.v"], "house.mtl is a file, not a folder"),
    ],
)
def test_usage(voxrt, arguments, message):
    voxrt.fails(2, message, *arguments)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["build", "nothing.glb"], "nothing.glb: no such file"),
        (["build", "house.obj", "more.obj"], "more.obj: no such file; check the path; nothing was built"),
        (["build", "."], ".: is a folder, not a file"),
        (["build", "nothing"], "nothing: no such file; check the path"),
        (["build", "folder.glb"], "folder.glb: is a folder"),
        (["build", "notes.txt"], ".gltf, .glb, .usd, .usda, .usdc, .usdz"),
        (["build", "notes"], "unknown kind of file"),
        (["build", "broken.glb"], "broken.glb"),
        (["build", "broken.usda"], "broken.usda"),
        (["build", "broken.obj"], "broken.obj"),
        (["render", "nothing.mem"], "nothing.mem"),
        (["render", "notes.txt"], "notes.txt"),
        (["render", "folder.glb"], "folder.glb"),
    ],
)
def test_asset(voxrt, folder, arguments, message):
    (folder / "folder.glb").mkdir()
    for name in ("notes.txt", "notes", "broken.glb", "broken.usda", "broken.obj"):
        (folder / name).write_text("v 1 2 three\nneither this nor that\n")
    before = sorted(folder.iterdir())
    voxrt.fails(3, message, *arguments)
    assert sorted(folder.iterdir()) == before


def test_a_voxel_too_small_does_not_fit(voxrt):
    voxrt.fails(4, "", "build", "house.obj", "--voxel-size", "1e-9")


def test_a_bug_is_one_line_that_says_how_to_report_it(voxrt, monkeypatch):
    monkeypatch.setattr("voxrt.voxelize.load", None)
    finished = voxrt.fails(1, "this is a bug of voxrt: TypeError", "build", "house.obj")
    assert "please report it" in finished.error


def test_the_traceback_comes_with_debug_only(voxrt, process):
    assert "Traceback" not in voxrt("build", "nothing.glb").err
    assert process("build", "nothing.glb") == voxrt("build", "nothing.glb")
    finished = process("build", "nothing.glb", "--debug")
    assert finished.code == 3
    assert "Traceback" in finished.err
    assert finished.err.splitlines()[-1].startswith("voxrt: error: nothing.glb: no such file")


@pytest.mark.parametrize("command", ["build", "render", "compare", "view", "convert", "info", "diff", "core"])
def test_help_has_an_example(voxrt, command):
    finished = voxrt.succeeds(command, "--help")
    assert f"Example: voxrt {command}" in finished.out
    assert finished.err == ""


def test_version(voxrt):
    from voxrt import __version__

    assert voxrt("--version") == (0, f"{__version__}\n", "")


def test_what_a_terminal_would_act_on_is_spelled_out(voxrt):
    assert "\\x1b[31mred.glb" in voxrt("build", "\x1b[31mred.glb").error
    assert "two\\nlines.glb" in voxrt("build", "two\nlines.glb").error


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion(voxrt, shell):
    finished = voxrt.succeeds("completion", shell)
    assert finished.err == ""
    assert "voxel-size" in finished.out
    if path := shutil.which(shell):
        subprocess.run([path, "-n"], input=finished.out, text=True, check=True)
