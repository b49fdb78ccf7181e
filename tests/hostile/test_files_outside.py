"""Assets that name files outside of their folder: nothing of these is read, and nobody learns whether they exist."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest
from fakes.usd_arcs import FACES, POINTS, SECRET, arcs
from oracles.usd_in_process import load_usd

from voxrt import voxelize
from voxrt.voxelize import AssetError
from voxrt.voxelize.formats.usd import layers
from voxrt.voxelize.formats.usd.isolated import read_isolated


@pytest.fixture
def folders(tmp_path):
    """An asset's folder, and a secret beside it, by several names."""
    secret = tmp_path / "secret"
    secret.mkdir()
    (secret / "geo.1.usda").write_text(SECRET)
    inside = tmp_path / "asset"
    inside.mkdir()
    (inside / "link.1.usda").symlink_to(secret / "geo.1.usda")
    (inside / "folder").symlink_to(secret)
    return inside, secret


def names(folder, secret):
    return [
        "../secret/geo.1.usda",
        str(secret / "geo.1.usda"),
        "./link.1.usda",
        "folder/geo.1.usda",
        f"../{folder.name}/../secret/geo.1.usda",
    ]


@pytest.mark.parametrize("arc", arcs("x.1.usda"))
def test_no_arc_of_usd_reaches_a_layer_outside(folders, arc):
    folder, secret = folders
    stage = folder / "stage.usda"
    for name in names(*folders):
        if (arc, name) == ("template", "./link.1.usda"):
            continue  # USD lists the folder for a template, and a link without an end is no file of it
        messages = []
        for there in (True, False):
            (secret / "geo.1.usda").unlink(missing_ok=True)
            if there:
                (secret / "geo.1.usda").write_text(SECRET)
            stage.write_text(arcs(name)[arc])
            with pytest.raises(AssetError, match=r"is outside the file's folder.*--allow-outside") as caught:
                load_usd(stage)
            messages.append(str(caught.value))
        assert messages[0] == messages[1], name
    (secret / "geo.1.usda").write_text(SECRET)
    with pytest.raises(AssetError, match="is outside the file's folder"):
        read_isolated(stage)
    assert len(read_isolated(stage, allow_outside=True).objects) >= 1
    stage.write_text(arcs("./geo.1.usda")[arc])
    (folder / "geo.1.usda").write_text(SECRET)
    assert len(read_isolated(stage).objects) >= 1


def test_a_layer_that_slipped_through_gives_nothing(folders, monkeypatch):
    """Where the names are not looked at, and the kernel cannot help."""
    folder, _ = folders
    monkeypatch.setattr(layers, "_clips_of", lambda _: set())
    stage = folder / "stage.usda"
    stage.write_text(arcs("../secret/geo.1.usda")["clips and manifest"])
    with pytest.raises(AssetError, match=r"layer 'geo\.1\.usda' is outside the file's folder"):
        load_usd(stage)


def test_names_are_not_looked_up_in_the_callers_folder(folders, monkeypatch):
    folder, secret = folders
    stage = folder / "stage.usda"
    (secret / "deep").mkdir()
    (secret / "deep" / "geo.usda").write_text(SECRET)
    stage.write_text(arcs("deep/geo.usda")["reference"])
    monkeypatch.chdir(secret)
    monkeypatch.setenv("PXR_AR_DEFAULT_SEARCH_PATH", str(secret))
    assert [one.name for one in read_isolated(stage).objects] == ["/own"]


CONFINED = """
import json, os, socket, subprocess, sys
from pathlib import Path
from voxrt.voxelize.file_sandbox import confine
folder, secret, writable = map(Path, sys.argv[1:])
if not confine([folder], [writable]):
    print("null")
    raise SystemExit
def tried(act):
    try:
        act()
    except PermissionError:
        return "refused"
    return "done"
def connect():
    with socket.socket() as one:
        try:
            one.connect(("127.0.0.1", 9))
        except ConnectionRefusedError:
            pass
import wave  # the interpreter still finds its modules
found = {
    "inside": tried((folder / "a").read_bytes),
    "outside": tried((secret / "a").read_bytes),
    "link": tried((folder / "link").read_bytes),
    "listing": tried(lambda: os.listdir(secret)),
    "writing inside": tried(lambda: (folder / "b").write_bytes(b"")),
    "writing": tried(lambda: (writable / "b").write_bytes(b"")),
    "other process": subprocess.run([sys.executable, "-c", "open(__import__('sys').argv[1])", secret / "a"],
        stderr=subprocess.DEVNULL).returncode,
}
print(json.dumps(found))
"""


def test_a_confined_process_opens_nothing_else(tmp_path):
    for name in ("folder", "secret", "writable"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "a").write_text("1")
    (tmp_path / "folder" / "link").symlink_to(tmp_path / "secret" / "a")
    places = [tmp_path / name for name in ("folder", "secret", "writable")]
    done = subprocess.run([sys.executable, "-c", CONFINED, *places], capture_output=True, text=True, check=True)
    found = json.loads(done.stdout)
    if found is None:
        pytest.skip("this kernel has no Landlock")
    refused = {"outside", "link", "listing", "writing inside"}
    assert found == {
        "other process": 1,
        **{name: "refused" if name in refused else "done" for name in found if name != "other process"},
    }


TEXTURED = {
    "a.obj": "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n",
    "a.mtl": "newmtl m\nmap_Kd NAME\n",
    "b.obj": "mtllib NAME\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "a.ply": "ply\nformat ascii 1.0\ncomment TextureFile NAME\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nproperty float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_indices\n"
    "end_header\n0 0 0 0 0\n1 0 0 0 0\n0 1 0 0 0\n3 0 1 2\n",
    "a.usda": f'#usda 1.0\ndef Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {{ {FACES} {POINTS}\n'
    'texCoord2f[] primvars:st = [(0, 0)] (interpolation = "constant")\n rel material:binding = </p>\n}\n'
    'def Material "p" {\n token outputs:surface.connect = </p/s.outputs:surface>\n def Shader "s" {\n'
    'uniform token info:id = "UsdPreviewSurface"\n color3f inputs:diffuseColor.connect = </p/t.outputs:rgb>\n'
    'token outputs:surface\n }\n def Shader "t" {\n uniform token info:id = "UsdUVTexture"\n'
    "asset inputs:file = @NAME@\n float3 outputs:rgb\n }\n}\n",
    "b.gltf": json.dumps({"asset": {"version": "2.0"}, "buffers": [{"uri": "NAME", "byteLength": 4}]}),
    "c.toml": '[[objects]]\nasset.file = "NAME"\n',
}


@pytest.mark.parametrize("kind", [name for name in TEXTURED if name != "a.mtl"])
@pytest.mark.parametrize("name", ["../secret/file.png", "ABSOLUTE/secret/file.png", "folder/file.png"])
def test_no_format_tells_whether_a_file_outside_exists(tmp_path, kind, name):
    message = []
    for there in (True, False):
        base = tmp_path / str(there)
        folder, secret = base / "asset", base / "secret"
        folder.mkdir(parents=True)
        secret.mkdir()
        (folder / "folder").symlink_to(secret)
        if there:
            (secret / "file.png").write_bytes(b"a secret")
        for file, text in TEXTURED.items():
            (folder / file).write_text(text.replace("NAME", name.replace("ABSOLUTE", str(base))))
        try:
            found = [one.message for one in voxelize.load(folder / kind).warnings]
        except AssetError as error:
            found = [str(error)]
        assert any("outside" in one and "--allow-outside" in one for one in found), found
        message.append([one.replace(str(base), "") for one in found])
    assert message[0] == message[1]
