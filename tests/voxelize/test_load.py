import os

import numpy as np
import pytest
from oracles.gltf_writer import GltfWriter

from voxrt.voxelize import AssetError, load


def test_unknown_suffix_is_refused_with_the_known_ones(tmp_path):
    path = tmp_path / "house.max"
    path.write_bytes(b"")
    known = r"to one of \.gltf, \.glb, "
    message = rf"house\.max: unknown kind of file '\.max'; convert it, by Blender or MeshLab for example, {known}"
    with pytest.raises(AssetError, match=message):
        load(path)


def test_missing_file_and_folder_are_refused(tmp_path):
    with pytest.raises(AssetError, match=r"gone\.glb: no such file; check the path"):
        load(tmp_path / "gone.glb")
    (tmp_path / "folder.obj").mkdir()
    os.mkfifo(tmp_path / "pipe.obj")
    with pytest.raises(AssetError, match=r"pipe\.obj: is a pipe or a device; save it to a file, and name that"):
        load(tmp_path / "pipe.obj")
    with pytest.raises(AssetError, match=r"folder\.obj: is a folder, not a file"):
        load(tmp_path / "folder.obj")


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def test_formats_say_which_options_they_ignore(tmp_path):
    obj = tmp_path / "a.OBJ"
    obj.write_text(TRIANGLE)
    scene = load(obj, up="z", unit=0.5, time=1.0, variants=("x",))
    assert [warning.message for warning in scene.warnings if warning.kind == "ignored-option"] == [
        "the time was ignored: obj files have no animation",
        "variants were ignored: obj files have none",
    ]
    corners = scene.objects[0].mesh.positions @ scene.objects[0].transform[:3, :3].T
    np.testing.assert_allclose(np.ptp(corners, axis=0), [0.5, 0, 0.5], atol=1e-12)
    writer = GltfWriter()
    writer.show(mesh=writer.mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]]))
    scene = load(str(writer.save(tmp_path / "a.glb")), up="z", unit=0.5)
    assert [warning.message for warning in scene.warnings if warning.kind == "ignored-option"] == [
        "the up axis was ignored: glb files define it",
        "the unit was ignored: glb files define it",
    ]
    assert np.ptp(scene.objects[0].mesh.positions, axis=0).tolist() == [1, 1, 0]
