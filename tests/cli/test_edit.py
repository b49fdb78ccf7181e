"""``voxrt edit``: scripts of edits."""

from __future__ import annotations

import json

import msgspec
import numpy as np
import pytest

from voxrt import Material, Rom, World, octree, run_edit_script
from voxrt.cli.results.memory_results import EditResult
from voxrt.export import BakedLight, Provenance, Source, read_any, read_rom, write_rom
from voxrt.voxelize import EMPTY, AssetError, DoesNotFitError

MATERIALS = (EMPTY, Material("stone", (200, 100, 50)), Material("glass", (1, 2, 3)))


@pytest.fixture
def world(folder):
    """A memory of 8 voxels per side: a floor."""
    cube = np.zeros((8, 8, 8), np.uint8)
    cube[:, :2] = 1
    source = Source("floor.obj", {"fill": "solid"})
    write_rom(folder, Rom("world", octree.from_dense(cube), MATERIALS), source=source)
    return cube


def write_script(path, *operations):
    path.write_text("".join(f"{json.dumps(operation)}\n" for operation in operations))


def test_every_operation(voxrt, folder, world):
    coin = Rom("coin", octree.from_points([[1, 0, 0]], [1], depth=1), (EMPTY, Material("silver", (9, 9, 9))))
    write_rom(folder / "parts", coin)
    (folder / "scripts").mkdir()
    write_script(
        folder / "scripts" / "edits.jsonl",
        {"op": "material", "name": "gold", "colour": "#ffcc00", "mirror": True},
        {"op": "set", "points": [[0, 7, 0], [1, 7, 0]], "materials": ["gold", 2]},
        {"op": "fill", "box": {"low": [4, 0, 4], "high": [8, 1, 8]}, "material": "empty"},
        {"op": "fill", "sphere": {"centre": [4, 4, 4], "radius": 1}, "material": 1},
        {"op": "paint", "capsule": {"start": [0, 1.5, 0], "end": [8, 1.5, 0], "radius": 1}, "material": "glass"},
        {"op": "set", "points": [[5, 5, 5]], "materials": 1},
        {"op": "undo"},
        {"op": "redo"},
        {"op": "undo"},
        {"op": "paste", "box": {"low": [0, 7, 0], "high": [2, 8, 1]}, "at": [6, 6, 6], "turned": 1},
        {"op": "paste", "file": "../parts/coin.mem", "at": [0, 4, 0]},
    )
    finished = voxrt.succeeds("edit", "world.mem", "--script", "scripts/edits.jsonl", "-o", "new.mem", "--json")
    result = msgspec.json.decode(finished.out, type=EditResult, strict=True)
    assert (result.outputs, result.edits) == (["new.mem", "new.json"], 11)
    rom, warnings = read_rom(folder / "new.mem")
    assert not warnings
    assert [material.name for material in rom.materials] == ["empty", "stone", "glass", "gold", "silver"]
    assert rom.materials[3].mirror
    world[0, 7, 0], world[1, 7, 0] = 3, 2
    world[4:, 0, 4:] = 0
    world[3:5, 3:5, 3:5] = 1
    world[:, 1, 0] = 2
    world[6, 6, 7], world[6, 6, 6] = 3, 2
    world[1, 4, 0] = 4
    np.testing.assert_array_equal(octree.to_dense(rom.octree), world)
    np.testing.assert_array_equal(rom.octree.words, octree.from_dense(world).words)
    assert result.words == len(rom.octree.words)
    assert read_any(folder / "new.mem")[0].provenance == Provenance()


@pytest.mark.usefixtures("world")
def test_the_memory_may_be_edited_in_place(voxrt, folder):
    write_script(folder / "dig.jsonl", {"op": "fill", "box": {"low": [0, 0, 0], "high": [8, 8, 8]}, "material": 0})
    before = (folder / "world.mem").read_bytes()
    finished = voxrt("edit", "world.mem", "--script", "dig.jsonl", "-o", "world.mem")
    assert finished.code == 0
    assert "1 words, before" in finished.err + finished.out
    assert (folder / "world.mem").read_bytes() != before
    assert read_any(folder / "world.mem")[0].provenance == Provenance()


def test_what_a_file_keeps(voxrt, folder, world):
    light = BakedLight((1, 3, 2), (0.4, 0.4, 0.4), 64, 100, 2, 33, 65)
    rom = octree.with_means(Rom("lit", octree.from_dense(world), MATERIALS))
    write_rom(folder, rom, dialect="lod", baked=light)
    write_script(folder / "dig.jsonl", {"op": "set", "points": [[0, 1, 0]], "materials": 0})
    voxrt.succeeds("edit", "lit.mem", "--script", "dig.jsonl", "-o", "dug.mem")
    blob, _ = read_any(folder / "dug.mem")
    world[0, 1, 0] = 0
    expected = octree.with_means(Rom("dug", octree.from_dense(world), MATERIALS)).octree
    np.testing.assert_array_equal(blob.rom.octree.means, expected.means)
    assert blob.provenance.baked == light


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("{", "is no operation: "),
        ('{"op": "dig"}', "is no operation: Invalid value 'dig' - at `$.op`"),
        ('{"op": "undo", "x": 1}', "is no operation: Object contains unknown field `x`"),
        ('{"op": "set", "points": [[1, 2]], "materials": 1}', "is no operation: Expected `array` of length 3"),
        ('{"op": "set", "points": [[1, 2, 9]], "materials": 1}', "points[0, 2] must be an integer 0 … 7, not 9"),
        ('{"op": "set", "points": [[1, 2, 3]], "materials": "ice"}', "there is no material 'ice'"),
        ('{"op": "set", "points": [[1, 2, 3]], "materials": 3}', "materials[0] must be an integer 0 … 2, not 3"),
        ('{"op": "fill", "material": 1}', "one of box, sphere and capsule is needed"),
        ('{"op": "fill", "material": 1, "sphere": {"centre": [0, 0, 0.1], "radius": 1}}', "multiples of 1/16 voxel"),
        ('{"op": "paint", "material": 0, "box": {"low": [0, 0, 0], "high": [1, 1, 1]}}', "must be an integer 1 … 2"),
        ('{"op": "paste", "at": [0, 0, 0]}', "one of box and file is needed"),
        ('{"op": "paste", "at": [0, 0, 0], "file": "none.mem"}', "none.mem"),
        ('{"op": "paste", "at": [0, 0, 0], "turned": 4, "file": "a.mem"}', "is no operation: Expected `int` <= 3"),
        ('{"op": "material", "name": "glass", "colour": "#010203"}', "there is a material 'glass' already"),
        ('{"op": "material", "name": "ice", "colour": "white"}', "colour 'white' is not written as #rrggbb"),
        ('{"op": "undo"}', "there is no edit to undo"),
        ('{"op": "redo"}', "there is no edit to do again"),
    ],
)
@pytest.mark.usefixtures("world")
def test_a_wrong_line_is_named_and_nothing_is_written(voxrt, folder, line, problem):
    (folder / "edits.jsonl").write_text(f"\n  \n{line}\n")
    finished = voxrt("edit", "world.mem", "--script", "edits.jsonl", "-o", "new.mem")
    assert finished.code == 3
    assert finished.err.count("\n") == 1
    assert "edits.jsonl: line 3: " in finished.err
    assert problem in finished.err
    assert not (folder / "new.mem").exists()


@pytest.mark.usefixtures("world")
def test_a_script_that_cannot_be_read(voxrt):
    voxrt.fails(3, "none.jsonl: cannot be read", "edit", "world.mem", "--script", "none.jsonl", "-o", "new.mem")
    voxrt.fails(2, "new.xyz: is not a format to write", "edit", "world.mem", "--script", "x.jsonl", "-o", "new.xyz")


def test_a_line_without_room_is_named(folder, world):
    write_script(folder / "edits.jsonl", {"op": "set", "points": [[5, 5, 5]], "materials": 2})
    tree = octree.from_dense(world)
    edited = World(Rom("small", tree, MATERIALS), words=len(tree.words))
    with pytest.raises(DoesNotFitError, match=r"edits.jsonl: line 1: the result of the edit does not fit"):
        run_edit_script(edited, folder / "edits.jsonl")
    with pytest.raises(AssetError, match="cannot be read"):
        run_edit_script(edited, folder)


def test_an_animation_is_refused(voxrt, folder):
    frames = [octree.from_points([[x, 0, 0]], [1], depth=3) for x in range(2)]
    memory, roots = octree.join_frames(frames)
    animation = octree.Animation(tuple(octree.AnimationFrame(root, 25) for root in roots))
    write_rom(folder, Rom("walk", memory, MATERIALS), animation=animation)
    write_script(folder / "edits.jsonl", {"op": "undo"})
    voxrt.fails(2, "walk.mem is an animation", "edit", "walk.mem", "--script", "edits.jsonl", "-o", "new.mem")
