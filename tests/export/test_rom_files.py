import json
import os
import shutil
import zlib
from pathlib import Path

import msgspec
import numpy as np
import pytest
from assets import asset, over_assets
from hypothesis import given, settings
from oracles.random_worlds import dense_cubes

from voxrt import export, octree
from voxrt.octree import Rom, RomError
from voxrt.voxelize import EMPTY, Grid, Material, ObjectReport, SceneWarning

GRID = Grid(2, (1.5, -2.0, 0.1), 0.25)
RED = Material("red", (255, 0, 0))
GLASS = Material("glass \N{SNOWMAN}", (1, 2, 3), mirror=True, authored=False)


def rom(name="scene", cells=((0, 0, 0, 1), (1, 1, 1, 2)), materials=(EMPTY, RED, GLASS), grid=GRID):
    cube = np.zeros((4, 4, 4), int)
    for x, y, z, material in cells:
        cube[x, y, z] = material
    return Rom(name, octree.from_dense(cube), materials, grid)


def entry(**change):
    return {"id": 0, "name": "a", "colour": [0, 0, 0], "mirror": False, "authored": True, "voxels": 0} | change


def edited(path, **change):
    path.write_bytes(msgspec.json.encode(json.loads(path.read_bytes()) | change))


@pytest.mark.parametrize("dialect", octree.DIALECTS)
def test_round_trip(tmp_path, dialect):
    written = rom()
    reports = (ObjectReport("cube", "box", "exact", 2, moved=(0.0, 0.5, 0.0)),)
    warnings = (SceneWarning("default-material", "two faces", 2),)
    source = export.Source("a.glb", {"depth": 2, "fill": "solid", "voxel_size": None})
    files = export.write_rom(
        tmp_path / "new" / "folder", written, dialect=dialect, objects=reports, warnings=warnings,
        seconds={"load": 0.25}, source=source,
    )  # fmt: skip
    assert sorted(p.name for p in files.mem.parent.iterdir()) == ["scene.json", "scene.mem"]
    read, assumed = export.read_rom(files.mem)
    assert assumed == ()
    assert (read.name, read.materials, read.grid) == (written.name, written.materials, written.grid)
    assert read.octree.depth == 2
    np.testing.assert_array_equal(read.octree.words, written.octree.words)
    manifest = export.read_manifest(files.manifest)
    assert (manifest.objects, manifest.warnings, manifest.source) == (reports, warnings, source)
    assert (manifest.voxels, manifest.words, manifest.blocks) == (2, len(read.octree.words), read.octree.blocks)
    assert [entry.voxels for entry in manifest.materials] == [62, 1, 1]
    assert manifest.crc32 == f"{zlib.crc32(files.mem.read_bytes()):08X}"
    assert manifest.world.matrix == ((0.25, 0, 0, 1.5), (0, 0.25, 0, -2.0), (0, 0, 0.25, 0.1), (0, 0, 0, 1))
    again = export.write_rom(
        tmp_path / "again", written, dialect=dialect, objects=reports, warnings=warnings, seconds={"load": 0.25},
        source=source,
    )  # fmt: skip
    assert again.mem.read_bytes() == files.mem.read_bytes()
    assert again.manifest.read_bytes() == files.manifest.read_bytes()


@given(cube=dense_cubes(3))
@settings(max_examples=30)
def test_any_world_survives_its_files(tmp_path_factory, cube):
    folder = tmp_path_factory.mktemp("rom")
    tree = octree.from_dense(cube)
    materials = export.default_materials(255)
    read, _ = export.read_rom(export.write_rom(folder, Rom("a", tree, materials)).mem)
    np.testing.assert_array_equal(read.octree.words, tree.words)
    assert read.grid is None
    assert read.materials == materials


class Interruption(BaseException):
    pass


def file_steps():
    """Every place where writing a pair touches the disk, as (object, name)."""
    return [(os, "fsync"), (Path, "replace"), (Path, "open")]


@pytest.mark.parametrize("moment", range(12))
@pytest.mark.parametrize("old", [True, False])
def test_an_interruption_leaves_the_old_pair_or_the_new(tmp_path, monkeypatch, moment, old):
    before, after = rom(cells=[(0, 0, 0, 1)]), rom(cells=[(3, 3, 3, 2), (1, 2, 3, 1)])
    if old:
        export.write_rom(tmp_path, before)
    calls = 0

    def interrupted(original):
        def step(*arguments, **keywords):
            nonlocal calls
            calls += 1
            if calls == moment + 1:
                raise Interruption
            return original(*arguments, **keywords)

        return step

    with monkeypatch.context() as patch:
        for owner, name in file_steps():
            patch.setattr(owner, name, interrupted(getattr(owner, name)))
        try:
            export.write_rom(tmp_path, after)
        except Interruption:
            finished = False
        else:
            finished = True
    path = tmp_path / "scene.mem"
    assert not list(tmp_path.glob("*.tmp"))
    if not path.exists():
        assert not old
        assert not finished
        return
    read, assumed = export.read_rom(path)
    assert assumed == ()
    expected = [after] if finished or not old else [before, after]
    assert any(np.array_equal(read.octree.words, rom.octree.words) for rom in expected)
    assert calls <= moment or not finished
    export.write_rom(tmp_path, before)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["scene.json", "scene.mem"]


def test_a_mem_exchanged_alone_is_noticed(tmp_path):
    files = export.write_rom(tmp_path, rom())
    export.write_mem(files.mem, rom(cells=[(0, 0, 0, 2)]).octree.words)
    with pytest.raises(RomError, match=r"scene\.json: describes another scene\.mem \(CRC-32 [0-9A-F]{8} is not"):
        export.read_rom(files.mem)


def test_a_manifest_alone_may_not_be_contradicted(tmp_path):
    files = export.write_rom(tmp_path, rom())
    assert export.read_rom(files.mem, depth=2, dialect="report")[0].octree.depth == 2
    with pytest.raises(RomError, match="the manifest says depth 2, and 3 was asked for"):
        export.read_rom(files.mem, depth=3)
    with pytest.raises(RomError, match="the manifest says dialect report, and msb was asked for"):
        export.read_rom(str(files.mem), dialect="msb")


def test_without_manifest_nothing_is_assumed_silently(tmp_path):
    files = export.write_rom(tmp_path, rom())
    files.manifest.unlink()
    read, assumed = export.read_rom(files.mem)
    assert [warning.kind for warning in assumed] == ["assumed-dialect", "assumed-depth", "assumed-palette"]
    assert (read.name, read.octree.depth, read.grid) == ("scene", 2, None)
    assert read.materials == export.default_materials(2)
    read, assumed = export.read_rom(files.mem, depth=9, dialect="report")
    assert [warning.kind for warning in assumed] == ["assumed-palette"]
    assert read.octree.depth == 9


def test_palette_is_distinct():
    materials = export.default_materials(255)
    assert materials[0] == EMPTY
    assert len({m.colour for m in materials}) == 256
    assert len({m.name for m in materials}) == 256
    assert all(0 <= c <= 255 for m in materials for c in m.colour)
    for i in range(1, 255):
        nearest = min(
            sum(abs(a - b) for a, b in zip(materials[i].colour, m.colour, strict=True))
            for m in materials[max(0, i - 4) : i]
        )
        assert nearest > 60, i


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"schema": 2}, "schema 2 is not known to this version"),
        ({"name": "n" * 1001}, r"\$\.name: 1001 characters are no name; it may have 1000"),
        ({"depth": 0}, r"\$\.depth: 0 is outside 1 \.\.\. 16"),
        ({"depth": "2"}, r"Expected `int`, got `str` - at `\$\.depth`"),
        ({"words": 10}, r"\$\.words: 10 are not a root"),
        ({"dialect": "vhdl"}, r"Invalid enum value 'vhdl' - at `\$\.dialect`"),
        ({"materials": []}, r"\$\.materials: 0 entries"),
        ({"materials": [entry(id=1)]}, r"\$\.materials\[0\]\.id: 1 stands in row 0"),
        ({"materials": [entry(colour=[0, 0, 256])]}, r"materials\[0\]\.colour: .* is outside 0"),
        ({"surprise": 1}, "unknown field `surprise`"),
        (
            {"world": {"origin": [0, 0, 0], "voxel_size": 0, "matrix": [[0] * 4] * 4}},
            r"\$\.world\.voxel_size: 0.* is not above 0",
        ),
    ],
)
def test_broken_manifests_are_refused_by_field(tmp_path, change, message):
    files = export.write_rom(tmp_path, rom())
    edited(files.manifest, **change)
    with pytest.raises(RomError, match=message):
        export.read_rom(files.mem)


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"{",
        b"[]",
        b"null",
        b"\xff",
        b"[" * 10**6,
        b'{"schema": 1}',
        b'{"schema": null}',
        b'{"schema": 1, "\xa8": 1}',
    ],
)
def test_what_is_no_manifest_is_refused(tmp_path, data):
    path = tmp_path / "a.json"
    path.write_bytes(data)
    with pytest.raises(RomError, match=r"a\.json: "):
        export.read_manifest(path)


def test_materials_missing_from_the_manifest(tmp_path):
    files = export.write_rom(tmp_path, rom())
    manifest = json.loads(files.manifest.read_text())
    manifest["materials"] = manifest["materials"][:2]
    files.manifest.write_text(json.dumps(manifest))
    with pytest.raises(RomError, match="material 2 is missing from the manifest, which ends at 1"):
        export.read_rom(files.mem)


@pytest.mark.parametrize("name", ["", "..", "a/b", "a\0b"])
def test_names_that_are_no_file_names(tmp_path, name):
    with pytest.raises(ValueError, match="cannot name a file"):
        export.write_rom(tmp_path, rom(name))


@over_assets(("name", "highest"), [("house", 7), ("dog", 5), ("cubes", 3)])
def test_the_published_memories(tmp_path, name, highest):
    shutil.copy(asset(f"../seed-memories/{name}.mem"), tmp_path)
    seed, assumed = export.read_rom(tmp_path / f"{name}.mem", depth=10)
    assert [warning.kind for warning in assumed] == ["assumed-dialect", "assumed-palette"]
    assert "seed-rtl" in assumed[0].message
    assert len(seed.materials) == highest + 1
    files = export.write_rom(tmp_path, seed, dialect="seed-rtl")
    again, assumed = export.read_rom(files.mem)
    assert assumed == ()
    np.testing.assert_array_equal(again.octree.words, seed.octree.words)
