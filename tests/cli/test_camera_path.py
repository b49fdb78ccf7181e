"""``voxrt render --cameras``: the pictures of each camera alone, also from a cluster."""

from __future__ import annotations

import json

import pytest

RENDER = ("render", "house.mem", "--engine", "model", "--size", "32x24")
CAMERAS = [{"position": [20.5, 30, 60], "look": [0, -1, -3]}, {}, {"position": [-10, 30, 60]}]


def cameras(folder, entries=None):
    (folder / "path.json").write_text(json.dumps(CAMERAS if entries is None else entries))
    return "path.json"


@pytest.fixture
def house(voxrt, folder):
    assert voxrt("build", "house.obj", "--depth", 4).code == 0
    return folder


@pytest.mark.parametrize("detail", [[], ["--lod"]])
def test_a_path_has_the_pictures_of_its_cameras(voxrt, house, detail):
    results = voxrt.json(*RENDER, "--cameras", cameras(house), "-o", "p.png", "--check", *detail)
    assert [one["outputs"]["picture"] for one in results] == ["p-0000.png", "p-0001.png", "p-0002.png"]
    assert [one["wrong_pixels"] for one in results] == [0, 0, 0]
    alone = (["--position", "20.5,30,60", "--look", "0,-1,-3"], [], ["--position", "-10,30,60"])
    for number, sight in enumerate(alone):
        assert voxrt(*RENDER, *sight, *detail, "-o", "one.png").code == 0
        assert (house / "one.png").read_bytes() == (house / f"p-{number:04d}.png").read_bytes()


def test_a_cluster_gives_the_same_pictures(voxrt, house):
    pytest.importorskip("distributed")
    assert voxrt(*RENDER, "--cameras", cameras(house), "-o", "a.png").code == 0
    finished = voxrt.succeeds(*RENDER, "--cameras", cameras(house), "-o", "b.png", "--workers", 1, "--check")
    assert "0 pixels differ" in finished.out + finished.err
    for number in range(3):
        assert (house / f"a-{number:04d}.png").read_bytes() == (house / f"b-{number:04d}.png").read_bytes()


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({}, "path.json: is not a list of cameras"),
        ([], "path.json: is not a list of cameras"),
        ([{}] * 65_537, "path.json: has 65,537 cameras; render at most 65,536 at once"),
        ([1], "path.json: camera 0: is not an object"),
        ([{"where": [1, 2, 3]}], "path.json: camera 0: is not an object"),
        ([{}, {"look": [1, 2]}], "path.json: camera 1: look must be three numbers"),
        ([{"look": [0, 0, 1e30]}], "path.json: camera 0: "),
    ],
)
def test_a_file_that_is_no_path_is_one_line(voxrt, house, entries, message):
    voxrt.fails(2, message, *RENDER, "--cameras", cameras(house, entries), "-o", "p.png")
    assert not list(house.glob("*.png"))


def test_what_does_not_go_together_is_refused(voxrt, house):
    path = cameras(house)
    assert "give --cameras" in voxrt(*RENDER, "--workers", 2).error
    assert "leave --position" in voxrt(*RENDER, "--cameras", path, "--position", "1,2,3").error
    assert "name a .png" in voxrt(*RENDER, "--cameras", path, "-o", "p.gif").error
    assert "exclude each other" in voxrt(*RENDER, "--cameras", path, "--workers", 2, "--scheduler", "tcp://x:1").error
    assert "cannot be read" in voxrt(*RENDER, "--cameras", "none.json").error
