"""GLB containers, JSON and URIs: what is accepted, and the one line that refuses the rest."""

import base64
import json

import pytest
from oracles.gltf_writer import GltfWriter, glb

from voxrt.voxelize import AssetError, load

TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def triangle():
    writer = GltfWriter()
    writer.show(mesh=writer.mesh(TRIANGLE))
    return writer


def with_uri(folder, uri):
    writer = triangle()
    writer.json["buffers"] = [{"byteLength": len(writer.data), "uri": uri}]
    path = folder / "asset.gltf"
    path.write_text(json.dumps(writer.json))
    return path, bytes(writer.data)


@pytest.mark.parametrize("size", [None, 1000])
def test_a_buffer_that_git_lfs_keeps_elsewhere_is_named(size, tmp_path):
    path, data = with_uri(tmp_path, "data.bin")
    assert len(data) < 40  # less than a pointer needs to be known
    if size is not None:
        path.write_text(path.read_text().replace(f'"byteLength": {len(data)}, "uri"', f'"byteLength": {size}, "uri"'))
    (tmp_path / "data.bin").write_text("version https://git-lfs.github.com/spec/v1\nsize 1\n")
    with pytest.raises(AssetError, match=r"buffers\[0\]\.uri: is a Git LFS pointer.*; run: git lfs pull"):
        load(path)


@pytest.mark.parametrize("suffix", [".glb", ".gltf"])
def test_a_glb_and_a_gltf_with_inline_data_are_the_same(suffix, tmp_path):
    (thing,) = load(triangle().save(tmp_path / f"a{suffix}")).objects
    assert thing.mesh.positions.tolist() == TRIANGLE


@pytest.mark.parametrize(
    ("uri", "file"),
    [
        ("data.bin", "data.bin"),
        ("a%20b/c.bin", "a b/c.bin"),
        ("x%41.bin", "x%41.bin"),
        ("folder\\data.bin", "folder/data.bin"),
    ],
)
def test_files_beside_the_asset_are_read(uri, file, tmp_path):
    path, data = with_uri(tmp_path, uri)
    (tmp_path / file).parent.mkdir(exist_ok=True)
    (tmp_path / file).write_bytes(data + b"more than it says")
    assert len(load(path).objects) == 1


@pytest.mark.parametrize("text", ["data:,%s", "data:application/gltf-buffer;base64,%s"])
def test_inline_data_may_be_percent_encoded(text, tmp_path):
    path, data = with_uri(tmp_path, "")
    body = "".join(f"%{byte:02x}" for byte in data)
    if "base64" in text:
        body = base64.b64encode(data).decode().rstrip("=").replace("/", "%2F")
    path, _ = with_uri(tmp_path, text.replace("%s", body))
    assert len(load(path).objects) == 1


def test_nothing_outside_the_folder_of_the_asset_is_opened(tmp_path):
    folder = tmp_path / "asset"
    folder.mkdir()
    (folder / "link.bin").symlink_to(tmp_path / "secret.bin")
    for uri in ("../secret.bin", "%2e%2e/secret.bin", str(tmp_path / "secret.bin"), "link.bin"):
        path, data = with_uri(folder, uri)
        (tmp_path / "secret.bin").write_bytes(data)
        with pytest.raises(
            AssetError, match=r"buffers\[0\]\.uri: '.*' is outside the asset's folder; .*--allow-outside"
        ):
            load(path)
        assert len(load(path, allow_outside=True).objects) == 1


@pytest.mark.parametrize(
    ("uri", "message"),
    [
        ("https://example.com/a.bin", r"the address 'https://example.com/a.bin' was not opened; put the file into"),
        ("file:///etc/passwd", r"the address 'file:///etc/passwd' was not opened"),
        (":", r"the address ':' was not opened"),
        ("gone.bin", r"buffers\[0\]\.uri: no file 'gone\.bin' in the asset's folder; put it there, or embed it"),
        ("", r"buffers\[0\]\.uri: no file '' in the asset's folder"),
        ("a%00b", r"no file 'a%00b' in the asset's folder"),
        ("n" * 5000, r"no file 'n{60}' in"),
        ("data:application/octet-stream;base64", r"a data URI without a comma"),
        ("data:;base64,!!!!", r"a data URI that is not base64"),
        ("data:;base64,AAAA", r"buffers\[0\]: its byteLength is \d+, and it has 3 bytes"),
    ],
)
def test_uris_that_cannot_be_honoured_are_refused(uri, message, tmp_path):
    path, _ = with_uri(tmp_path, uri)
    with pytest.raises(AssetError, match=message):
        load(path)


JSON = b'{"asset":{"version":"2.0"}}     '


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (glb([(b"JSON", JSON)])[:16], r"a GLB of 16 bytes ends before its JSON chunk"),
        (glb([(b"JSON", JSON)])[:-4], r"says it has 52 bytes and has 48"),
        (glb([(b"JSON", JSON)]).replace(b"F\2", b"F\1"), r"is a GLB of version 1, and version 2 is read"),
        (glb([(b"BIN\0", b"    "), (b"JSON", JSON)]), r"byte 12: the JSON chunk is not the first"),
        (glb([(b"JSON", JSON), (b"JSON", JSON)]), r"byte 52: the JSON chunk is not the first"),
        (glb([(b"JSON", JSON), (b"WHAT", b""), (b"BIN\0", b"    ")]), r"byte 60: the binary chunk is not the second"),
        (glb([(b"JSON", JSON[:-1])]), r"byte 12: a chunk of 31 bytes, not a multiple of 4"),
        (glb([(b"JSON", JSON)]).replace(b"\x20\0\0\0J", b"\x24\0\0\0J"), r"a chunk of 36 bytes where 32 are left"),
        (b'{"asset":{"version":"1.0"}}', r"asset: written in glTF 1\.0"),
        (b'{"asset":{"version":"2.1","minVersion":"2.1"}}', r"to be read by 2\.1 and later"),
        (b'{"asset":{"version":"1.0"},"meshes":{"m":{}}}', "asset: is glTF 1.0, and glTF 2.0 is read"),
        (b'{"asset":{}}', r"asset: object missing required field `version`"),
        (b"{}", r"object missing required field `asset`"),
        (b'{"nodes":[{"mesh":"a"}]}', r"nodes\[0\]\.mesh: expected `int \| null`, got `str`"),
        (b'{"nodes":[{"mesh":-1}]}', r"nodes\[0\]\.mesh: expected `int` >= 0"),
        (b'{"extras":' + b"[" * 100_000 + b"]" * 100_000 + b"}", r"the JSON is nested too deeply"),
        (b'{"a', r"the JSON cannot be read \(Input data was truncated\)"),
        (b'{"asset":{"version":"2.0","generator":"\xa1"}}', r"byte 39: the JSON is not UTF-8"),
        (b'{"asset":{"version":"2.0"},"nodes":[{"name":"\xa1"}]}', r"byte 45: the JSON is not UTF-8"),
        (b'{"asset":{"version":"2.0"},"nodes":[{"name":"\\ud800"}]}', r"the JSON cannot be read"),
        (b"\x00\x01", r"the JSON cannot be read \(JSON is malformed"),
        (b"", r"the JSON cannot be read \(Input data was truncated\)"),
        (b"\xef\xbb\xbf" + JSON, r"has no triangles to voxelize"),
    ],
)
def test_broken_containers_are_refused(data, message, tmp_path):
    path = tmp_path / "a.glb"
    path.write_bytes(data)
    with pytest.raises(AssetError, match=message) as caught:
        load(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_unknown_chunks_are_passed_over(tmp_path):
    path = triangle().save(tmp_path / "a.glb")
    data = path.read_bytes() + b"\x04\0\0\0WHAT1234"
    path.write_bytes(data[:8] + len(data).to_bytes(4, "little") + data[12:])
    assert len(load(path).objects) == 1


def test_a_buffer_view_that_leaves_its_buffer_is_refused_even_unused(tmp_path):
    writer = triangle()
    writer.add("bufferViews", {"buffer": 0, "byteOffset": 30, "byteLength": 100})
    with pytest.raises(AssetError, match=r"bufferViews\[1\]: ends at byte 130 of a buffer of 36"):
        load(writer.save(tmp_path / "a.glb"))


def test_required_extensions_that_are_unknown_refuse_the_file_and_others_are_counted(tmp_path):
    writer = triangle()
    writer.json["extensionsUsed"] = ["ACME_wobble", "KHR_lights_punctual"]
    scene = load(writer.save(tmp_path / "a.glb"))
    assert [w.message for w in scene.warnings if w.kind == "unknown-extension"] == [
        "the extension ACME_wobble was ignored"
    ]
    writer.json["extensionsRequired"] = ["KHR_lights_punctual", "ACME_wobble"]
    with pytest.raises(AssetError, match=r"extensionsRequired\[1\]: the extension ACME_wobble is not supported"):
        load(writer.save(tmp_path / "a.glb"))


def test_a_buffer_without_data_is_refused(tmp_path):
    path = tmp_path / "a.gltf"
    writer = triangle()
    writer.json["buffers"] = [{"byteLength": len(writer.data)}]
    path.write_text(json.dumps(writer.json))
    with pytest.raises(AssetError, match=r"buffers\[0\]: has no uri, and the file has no binary chunk"):
        load(path)
