"""Options that would have no effect are refused, in one line that says what to do."""

from __future__ import annotations

import pytest


@pytest.mark.parametrize(
    ("option", "value", "other"),
    [
        ("--bake-samples", 64, "--bake"),
        ("--bake-samples", 9, "--bake"),
        ("--sun", "1,3,2", "--bake"),
        ("--sky", "0.4", "--bake"),
        ("--size", "640x480", "--preview"),
        ("--samples", 1, "--preview"),
        ("--background", "light", "--preview"),
        ("--engine", "model", "--preview"),
    ],
)
def test_options_that_need_another(voxrt, folder, option, value, other):
    problem = f"{option} has no effect without {other}; give that as well, or leave {option} out"
    voxrt.fails(2, problem, "build", "house.obj", "--depth", 4, option, value)
    assert not list(folder.glob("*.mem"))


def test_materials_of_a_listing_are_not_for_assets(voxrt, folder):
    problem = "--material is of node listings, and house.obj has materials; leave it out"
    voxrt.fails(2, problem, "convert", "house.obj", "house.npz", "--material", "roof=ff0000")
    assert not (folder / "house.npz").exists()


@pytest.mark.parametrize("flag", ["-o", "--output"])
def test_convert_has_no_option_for_its_output(voxrt, flag):
    problem = f"there is no option {flag}; name the file to write as the last argument, without it"
    voxrt.fails(2, problem, "convert", "house.obj", flag, "house.npz")


def test_an_upload_without_a_board(voxrt):
    voxrt.fails(2, "neither --to nor --device says where the board is", "upload", "house.mem")


def test_a_command_that_is_none(voxrt):
    voxrt.fails(2, "there is no command 'rendr'; did you mean render; name one of build, render, ", "rendr")


@pytest.mark.parametrize("name", ["a.exe", "a.obj", "a.blob", "a.3mf"])
def test_an_output_that_is_no_folder_and_no_memory(voxrt, folder, name):
    voxrt.fails(2, "is no format of memories; name a file with one of .mem", "build", "house.obj", "-o", name)
    assert not (folder / name).exists()
    for place in (name, "v0.2"):
        if place == name:
            (folder / name).mkdir()
        voxrt.succeeds("build", "house.obj", "--depth", 3, "-o", place)
        assert (folder / place / "house.mem").exists()
