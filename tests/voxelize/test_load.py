import pytest

from voxrt.voxelize import AssetError, load


def test_unknown_suffix_is_refused_with_the_known_ones(tmp_path):
    path = tmp_path / "house.max"
    path.write_bytes(b"")
    with pytest.raises(AssetError, match=r"house\.max: unknown kind of file '\.max'; give one of \.gltf, \.glb, "):
        load(path)


def test_missing_file_and_folder_are_refused(tmp_path):
    with pytest.raises(AssetError, match=r"gone\.glb: no such file; check the path"):
        load(tmp_path / "gone.glb")
    (tmp_path / "folder.obj").mkdir()
    with pytest.raises(AssetError, match=r"folder\.obj: is a folder, not a file"):
        load(tmp_path / "folder.obj")
