"""MagicaVoxel files in the WebAssembly module: the words and materials of the native reader."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from assets import asset, over_assets
from fakes.site import ROOT, assert_same_memory, page_builds, warnings_of

import voxrt
from voxrt.export.vox import read_vox, write_vox
from voxrt.voxelize import AssetError

if TYPE_CHECKING:
    from pathlib import Path


def assert_same(path: Path, found: dict) -> None:
    rom, warnings = read_vox(path)
    assert_same_memory(found, rom)
    assert found["warnings"] == warnings_of(warnings)


def test_a_scene_of_several_models_has_the_words_of_the_native_reader(tmp_path: Path) -> None:
    files = [tmp_path / "courtyard.vox", tmp_path / "house.vox"]
    write_vox(files[0], voxrt.build(ROOT / "examples" / "courtyard.glb", depth=9).rom)
    write_vox(files[1], voxrt.build(ROOT / "examples" / "house.obj", depth=4).rom)
    for path, found in zip(files, page_builds(*([path] for path in files)), strict=True):
        assert_same(path, found)


@over_assets(
    "name",
    [
        *("dot_vox/axes.vox", "dot_vox/placeholder-with-materials.vox", "opengametools/test_meta_chunk.vox"),
        *(f"mikelovesrobots-mmmm/vox/{name}.vox" for name in ("chr_army1", "scene_house", "scene_store8")),
    ],
)
def test_shared_scenes_have_the_words_of_the_native_reader(name: str) -> None:
    path = asset(f"vox/{name}")
    assert_same(path, *page_builds([path]))


def test_broken_files_are_refused_as_natively(tmp_path: Path) -> None:
    write_vox(tmp_path / "whole.vox", voxrt.build(ROOT / "examples" / "house.obj", depth=4).rom)
    whole = (tmp_path / "whole.vox").read_bytes()
    bad = {
        "cut.vox": whole[:-9],
        "name.vox": b"VOXX" + whole[4:],
        "version.vox": b"VOX \1\0\0\0" + whole[8:],
        "none.vox": b"",
    }
    for name, content in bad.items():
        (tmp_path / name).write_bytes(content)
    for name, found in zip(bad, page_builds(*([tmp_path / name] for name in bad)), strict=True):
        with pytest.raises(AssetError) as caught:
            read_vox(tmp_path / name)
        # The native message puts the fix on a line of its own.
        native = str(caught.value).replace(f"{tmp_path}/", "")
        assert found["problem"].split("; ")[0] == native.split("; ")[0].splitlines()[0]
        assert "\n" not in found["problem"]
