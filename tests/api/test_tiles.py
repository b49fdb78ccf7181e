"""Builds in tiles on the disk: the bytes of a build at once, also after a kill, and nothing left behind."""

from __future__ import annotations

import shutil
import subprocess
import sys
from contextlib import suppress

import numpy as np
import pytest
from oracles.meshes import icosphere, scene_of

import voxrt
from voxrt import octree
from voxrt.export.outputs import OutputError
from voxrt.plans.tile_store import Tile, TileStore, read_tile, write_tile
from voxrt.voxelize import SceneObject

LITTLE = 1 << 26
DEPTH = 11

# Builds the ball in tiles; signals itself as the n-th tile gets its name (never for 0). Prints how many were written.
BUILD = """
import os, signal, sys
sys.path.insert(0, sys.argv[1])
from oracles.meshes import icosphere, scene_of
import voxrt
from voxrt.voxelize import SceneObject
number, moment, level = map(int, sys.argv[2:5])
written = 0
def watch(event, arguments):
    global written
    if event == "os.rename" and str(arguments[1]).endswith(".tile"):
        written += 1
        if written == moment:
            os.kill(os.getpid(), number)
sys.addaudithook(watch)
scene = scene_of(SceneObject("ball", icosphere(level, (0.0, 0.0, 0.0), 1.0)))
try:
    voxrt.build(scene, "ball.mem", depth=11, memory=1 << 26)
except KeyboardInterrupt:
    sys.exit(130)
print(written)
"""


@pytest.fixture
def ball():
    return scene_of(SceneObject("ball", icosphere(2, (0.0, 0.0, 0.0), 1.0)))


@pytest.fixture
def at_once(ball):
    return bytes(voxrt.build(ball, depth=DEPTH, memory=1 << 40).octree.words)


def run(folder, number=0, moment=0, level=2):
    tests = next(path for path in sys.path if path.endswith("tests"))
    command = [sys.executable, "-c", BUILD, tests, str(number), str(moment), str(level)]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=300)


def left(folder):
    return sorted(path.name for path in folder.iterdir())


def words_of(folder):
    return bytes(voxrt.export.read_rom(folder / "ball.mem")[0].octree.words)


def test_tiles_give_the_bytes_of_a_build_at_once_and_go(ball, at_once, tmp_path):
    built = voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=LITTLE)
    assert bytes(built.octree.words) == at_once == words_of(tmp_path)
    assert built.solid_voxels == built.objects[0].voxels
    assert left(tmp_path) == ["ball.json", "ball.mem"]


@pytest.mark.parametrize("number", [2, 9])  # Ctrl-C, and a kill that no process hears
def test_a_build_that_was_ended_goes_on_from_its_tiles(number, at_once, tmp_path):
    ended = run(tmp_path, number, moment=5)
    assert ended.returncode == {2: 130, 9: -9}[number]
    finished = left(tmp_path / "ball.tiles")
    kept = sum(name.endswith(".tile") for name in finished)
    assert kept == {2: 5, 9: 4}[number]
    assert (number == 2) == all(name == "key" or name.endswith(".tile") for name in finished)
    fresh = tmp_path / "fresh"
    fresh.mkdir()
    all_tiles = int(run(fresh).stdout)
    again = run(tmp_path)
    assert int(again.stdout) == all_tiles - kept, again.stderr
    assert words_of(tmp_path) == at_once
    assert left(tmp_path) == ["ball.json", "ball.mem", "fresh"]


def test_tiles_of_another_scene_are_not_used(at_once, tmp_path):
    run(tmp_path, 9, moment=5, level=1)
    fresh = tmp_path / "fresh"
    fresh.mkdir()
    assert run(tmp_path).stdout == run(fresh).stdout
    assert words_of(tmp_path) == at_once


def test_a_damaged_tile_is_made_anew(at_once, tmp_path):
    run(tmp_path, 9, moment=5)
    tile = max((tmp_path / "ball.tiles").glob("*.tile"))
    data = bytearray(tile.read_bytes())
    data[len(data) // 2] ^= 1
    tile.write_bytes(data)
    run(tmp_path)
    assert words_of(tmp_path) == at_once


FORGERIES = {
    "an overlap": lambda tile: Tile(octree.Octree(DEPTH, np.full(1, 0xFFFFFF01, np.uint32)), tile.tallies),
    "another world": lambda tile: Tile(octree.Octree(DEPTH - 1, tile.octree.words), tile.tallies),
    "an object too many": lambda tile: Tile(tile.octree, np.array([[7, 1, 0, 0, 1, 1, 0]])),
    "no object": lambda tile: Tile(tile.octree, np.array([[-1, 1, 0, 0, 1, 1, 0]])),
    "negative counts": lambda tile: Tile(tile.octree, np.array([[0, -1, 0, 0, 1, 1, 0]])),
}


@pytest.mark.parametrize("kind", FORGERIES)
def test_a_forged_tile_is_one_line_that_says_what_to_remove(ball, at_once, tmp_path, kind):
    run(tmp_path, 9, moment=5)
    folder = tmp_path / "ball.tiles"
    key = (folder / "key").read_text().split()[0]
    path = max(folder.glob("*.tile"), key=lambda one: one.stat().st_size)
    write_tile(path, key, FORGERIES[kind](read_tile(path, key)))
    for _ in range(2):
        with pytest.raises(OutputError, match=r"not what its build writes; remove the folder of the tiles"):
            voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=LITTLE)
    shutil.rmtree(folder)
    voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=LITTLE)
    assert words_of(tmp_path) == at_once


def test_what_an_unsound_build_made_goes(ball, tmp_path):
    with pytest.raises(voxrt.DoesNotFitError, match="empty"):
        voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=LITTLE, bounds=(9, 9, 9, 12, 12, 12))
    assert left(tmp_path) == []


def test_a_folder_that_another_build_uses_is_left_alone(ball, tmp_path):
    with TileStore(tmp_path / "ball.tiles") as other:
        assert other.claim("0" * 32, 256) == 256
        with pytest.raises(OutputError, match="another build uses it"):
            voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=LITTLE)
        assert left(tmp_path / "ball.tiles") == ["key"]


def test_files_of_others_are_left_alone(ball, tmp_path):
    (tmp_path / "ball.tiles").mkdir()
    (tmp_path / "ball.tiles" / "notes").write_text("mine")
    with pytest.raises(OutputError, match="no build put there"):
        voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=LITTLE)
    assert left(tmp_path / "ball.tiles") == ["notes"]


OWN = {"key": b"mine\n", "words": b"mine", "map-1.tile": b"mine", "0-0.tile": b"mine", ".a.tmp": b"mine"}


@pytest.mark.parametrize("key", [b"mine\n", b"0" * 32 + b" 128", b"0" * 32 + b" 1 28\n", b"0" * 32 + b" 128\n\n", b""])
def test_a_folder_whose_key_no_build_wrote_is_left_alone(ball, tmp_path, key):
    folder = tmp_path / "ball.tiles"
    folder.mkdir()
    for name, data in {**OWN, "key": key}.items():
        (folder / name).write_bytes(data)
    with pytest.raises(OutputError, match="no build put there"):
        voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=LITTLE)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == {**OWN, "key": key}


def test_links_to_folders_of_others_are_not_followed(ball, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    for name, data in {**OWN, "key": b"0" * 32 + b" 128\n"}.items():
        (other / name).write_bytes(data)
    before = left(other)
    (tmp_path / "ball.tiles").symlink_to(other)
    with pytest.raises(OutputError, match="is a link to another folder"):
        voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=LITTLE)
    assert left(other) == before
    (tmp_path / "ball.tiles").unlink()
    (tmp_path / "ball.tiles").mkdir()
    (tmp_path / "ball.tiles" / "key").symlink_to(other / "key")
    with pytest.raises(OutputError, match="no build put there"):
        voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=LITTLE)
    assert (other / "key").read_bytes() == b"0" * 32 + b" 128\n"


def test_a_build_at_once_removes_the_tiles_of_one_that_was_killed(ball, at_once, tmp_path):
    run(tmp_path, 9, moment=5)
    assert (tmp_path / "ball.tiles").exists()
    (tmp_path / "ball.tiles" / "map-1.tile").write_text("mine")
    voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=1 << 40)
    assert words_of(tmp_path) == at_once
    assert left(tmp_path / "ball.tiles") == ["map-1.tile"]
    voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=1 << 40)
    assert left(tmp_path / "ball.tiles") == ["map-1.tile"]


def test_files_of_others_in_the_folder_of_a_build_stay(ball, at_once, tmp_path):
    run(tmp_path, 9, moment=5)
    folder = tmp_path / "ball.tiles"
    links = {"link.tile": tmp_path / "kept", "folder.tile": tmp_path}
    (tmp_path / "kept").write_bytes(b"voxrtil2")
    for name in ("map-1.tile", "notes.txt", ".a.tmp"):
        (folder / name).write_text("mine")
    for name, target in links.items():
        (folder / name).symlink_to(target)
    voxrt.build(ball, tmp_path / "ball.mem", depth=DEPTH, memory=LITTLE)
    assert words_of(tmp_path) == at_once
    assert left(folder) == sorted(["map-1.tile", "notes.txt", ".a.tmp", *links])
    assert (tmp_path / "kept").exists()


def test_tiles_are_used_whatever_is_free_now(tmp_path):
    def claimed(side, key="0" * 32):
        with suppress(KeyboardInterrupt), TileStore(tmp_path / "a.tiles") as store:
            found = store.claim(key, side)
            (tmp_path / "a.tiles" / f"{found}.tile").write_bytes(b"voxrtil2")
            raise KeyboardInterrupt
        return found, left(tmp_path / "a.tiles")

    assert claimed(512) == (512, ["512.tile", "key"])
    assert claimed(2048) == (512, ["512.tile", "key"])
    assert claimed(256) == (512, ["512.tile", "key"])
    assert claimed(128) == (128, ["128.tile", "key"])
    assert claimed(128, "1" * 32) == (128, ["128.tile", "key"])


def test_a_tile_is_read_as_it_was_written_and_never_else(tmp_path):
    tree = octree.from_points([[1, 2, 3]], [7], depth=2)
    tile = Tile(tree, np.array([[0, 1, 0, 0, 1, 1, 0]]))
    path, key = tmp_path / "one.tile", "ab" * 16
    size = write_tile(path, key, tile)
    assert path.stat().st_size == size
    again = read_tile(path, key)
    assert again is not None
    assert (again.octree.depth, bytes(again.octree.words)) == (2, bytes(tree.words))
    assert again.tallies.tolist() == [[0, 1, 0, 0, 1, 1, 0]]
    assert read_tile(path, "cd" * 16) is None
    assert read_tile(tmp_path / "none.tile", key) is None
    for length in (0, 10, size - 1):
        (tmp_path / "short.tile").write_bytes(path.read_bytes()[:length])
        assert read_tile(tmp_path / "short.tile", key) is None


def test_octrees_joined_on_the_disk_have_the_bytes_of_those_in_memory(tmp_path):
    rng = np.random.default_rng(0)
    whole = rng.integers(0, 3, (64, 64, 64)).astype(np.uint8)  # far more blocks than the least cache holds
    assembly = octree.DiskAssembly(6, tmp_path, cache=0)
    for x in range(0, 64, 16):
        for y in range(0, 64, 32):
            part = np.zeros_like(whole)
            part[x : x + 16, y : y + 32] = whole[x : x + 16, y : y + 32]
            assembly.add(octree.from_dense(part))
    joined = assembly.octree(tmp_path / "words")
    assert len(joined.words) > 8 * 8192
    assert bytes(joined.words) == bytes(octree.from_dense(whole).words)
    assert left(tmp_path) == ["words"]
    dot = octree.from_points([[0, 0, 0]], [1], depth=2)
    second = octree.DiskAssembly(2, tmp_path, cache=0)
    second.add(dot)
    with pytest.raises(ValueError, match="overlap"):
        second.add(dot)


def test_a_folder_that_is_not_there_is_an_error_of_the_system(tmp_path):
    with pytest.raises(FileNotFoundError):
        octree.DiskAssembly(4, tmp_path / "none", cache=0)


def test_the_estimate_is_of_the_build_in_tiles(ball, tmp_path):
    estimates = []
    voxrt.build(ball, tmp_path, depth=DEPTH, memory=LITTLE, estimated=estimates.append)
    voxrt.build(ball, tmp_path, depth=DEPTH, memory=1 << 40, estimated=estimates.append)
    little, much = estimates
    assert little.bytes < much.bytes
    assert little.disk > 0 == much.disk
    assert "GB of disk" in str(little)
