"""Files of ours: written whole by whoever writes, on a full disk not at all, never over something else in silence."""

from __future__ import annotations

import json
import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import pytest

import voxrt
from voxrt.export import read_rom
from voxrt.export.atomic import staged_files, write_atomically, write_together

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def command(folder: Path, *arguments: str, limit: int | None = None) -> subprocess.CompletedProcess[str]:
    """``voxrt`` in a process of its own, which may be kept from writing files longer than `limit` bytes."""
    code = "from voxrt.cli import main\n"
    if limit is not None:
        code += f"import resource\nresource.setrlimit(resource.RLIMIT_FSIZE, ({limit}, {limit}))\n"
    return subprocess.run(
        [sys.executable, "-B", "-c", code + "main()", *arguments],
        cwd=folder, capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip


def names(folder: Path) -> list[str]:
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


WRITER = """
import sys, voxrt
from pathlib import Path
for turn in range(6):
    depth = 3 + (turn + int(sys.argv[1])) % 2
    voxrt.build("house.obj", "out", depth=depth, preview=True, size=(32, 24), engine="model")
"""


def test_writers_and_a_reader_beside_each_other(folder):
    sets = {}
    for depth in (3, 4):
        made = voxrt.build(folder / "house.obj", folder / "out", depth=depth, preview=True, size=(32, 24),
                           engine="model")  # fmt: skip
        sets[depth] = [made.outputs[kind].read_bytes() for kind in ("mem", "preview")]
    writers = [
        subprocess.Popen([sys.executable, "-c", WRITER, str(number)], cwd=folder, stderr=subprocess.PIPE)
        for number in range(4)
    ]
    reads = 0
    while any(writer.poll() is None for writer in writers):
        rom, assumed = read_rom(folder / "out" / "house.mem")
        assert assumed == ()
        assert rom.octree.depth in sets
        reads += 1
    assert [(writer.wait(), writer.communicate()[1]) for writer in writers] == [(0, b"")] * 4
    assert reads > 1
    assert names(folder / "out") == ["house.json", "house.mem", "house.preview.png"]
    last = json.loads((folder / "out" / "house.json").read_bytes())["depth"]
    assert [(folder / "out" / name).read_bytes() for name in ("house.mem", "house.preview.png")] == sets[last]


@pytest.mark.parametrize(
    "arguments",
    [
        ("build", "house.obj", "-o", "new/folder", "--depth", "4"),
        ("build", "house.obj", "-o", "house.mem", "--depth", "5", "--preview", "--engine", "model"),
        ("render", "house.mem", "-o", "house.png", "--engine", "model"),
        *(("convert", "house.mem", f"new/house{suffix}") for suffix in voxrt.WRITABLE_SUFFIXES if suffix != ".vtu"),
        ("view", "house.mem", "-o", "house.glb"),
    ],
    ids=" ".join,
)
def test_no_room_is_one_line_and_leaves_everything(folder, arguments):
    voxrt.build(folder / "house.obj", folder / "house.mem", depth=4)
    before = {name: (folder / name).read_bytes() for name in names(folder)}
    finished = command(folder, *arguments, limit=500)
    assert finished.returncode == 2, finished.stderr
    (line,) = (line for line in finished.stderr.splitlines() if "warning" not in line and not line.startswith(" "))
    assert line.startswith("voxrt: error: ")
    assert "cannot be written: File too large" in line
    assert {name: (folder / name).read_bytes() for name in names(folder)} == before


def test_no_room_for_octants_of_paraview(folder):
    pytest.importorskip("pyvista", reason="PyVista is not installed")
    before = names(folder)
    finished = command(folder, "view", "house.obj", "--depth", "4", "-o", "x.vtu", limit=500)
    assert (finished.returncode, "wrote" in finished.stderr) == (2, False)
    assert "x.vtu: cannot be written" in finished.stderr
    assert names(folder) == before


def test_a_set_is_old_where_its_last_file_cannot_be_written(tmp_path):
    first, second = tmp_path / "first", tmp_path / "second"
    first.write_bytes(b"old")
    second.mkdir()
    with pytest.raises(IsADirectoryError):
        write_together({first: b"new", second: b"new"})
    assert (first.read_bytes(), names(tmp_path)) == (b"old", ["first", "second"])


def test_what_is_removed_is_the_link_and_not_what_it_leads_to(tmp_path):
    kept, link, first = (tmp_path / name for name in ("kept", "link", "first"))
    kept.write_bytes(b"mine")
    link.symlink_to(kept)
    write_together({first: b"new", link: None})
    assert (kept.read_bytes(), names(tmp_path)) == (b"mine", ["first", "kept"])


def test_the_files_of_a_core_replace_no_others(voxrt, folder):
    voxrt.succeeds("build", "house.obj", "--depth", 4)
    out = folder / "out"
    out.mkdir()
    (out / "bank_00.hex").write_text("1007\n1007\n")  # as another configuration leaves it
    (out / "bank_01.hex").write_text("my notes\n")
    (folder / "kept").write_text("1007\n")
    (out / "bank_02.hex").symlink_to(folder / "kept")
    voxrt.succeeds("convert", "house.mem", "out", "--form", "core")
    assert names(out) == ["bank_01.hex", "bank_02.hex", "boot.hex", "octree.hex", "scene.h"]
    assert (folder / "kept").read_text() == "1007\n"


def test_a_set_is_old_where_a_renaming_fails(tmp_path, monkeypatch):
    first, second, third = (tmp_path / name for name in ("first", "second", "third"))
    first.write_bytes(b"old")
    rename, calls = Path.replace, []

    def fail_once(path, target):
        calls.append(target)
        if len(calls) == 3:
            raise PermissionError(1, "Operation not permitted")
        return rename(path, target)

    monkeypatch.setattr(Path, "replace", fail_once)
    with pytest.raises(PermissionError):
        write_together({first: b"new", second: b"new", third: b"new"})
    assert (first.read_bytes(), names(tmp_path)) == (b"old", ["first"])


def test_modes_links_and_devices(tmp_path):
    file, link = tmp_path / "file", tmp_path / "link"
    file.write_bytes(b"old")
    file.chmod(0o640)
    link.symlink_to(file)
    write_atomically(link, b"new")
    assert link.is_symlink()
    assert (file.read_bytes(), stat.S_IMODE(file.stat().st_mode)) == (b"new", 0o640)
    write_atomically(Path(os.devnull), b"nothing")
    assert not Path(os.devnull).is_file()
    umask = os.umask(0o027)
    try:
        write_atomically(tmp_path / "fresh", b"")
    finally:
        os.umask(umask)
    assert stat.S_IMODE((tmp_path / "fresh").stat().st_mode) == 0o640


def test_the_next_writer_removes_what_the_dead_left_and_nothing_else(tmp_path):
    target = tmp_path / "house.mem"
    for name in (".house.mem.0123abcd.tmp", ".house.mem.notours.tmp", ".house.json.0123abcd.tmp"):
        (tmp_path / name).touch()
    assert len(staged_files(target)) == 1
    write_atomically(target, b"")
    assert names(tmp_path) == [".house.json.0123abcd.tmp", ".house.mem.notours.tmp", "house.mem"]


@pytest.mark.parametrize("suffix", [".mem", ".coe", ".mif", ".bin", ".blob"])
def test_conversion_keeps_what_is_known_of_the_build(folder, suffix):
    voxrt.build(folder / "house.obj", folder, depth=4)
    original = json.loads((folder / "house.json").read_bytes())
    assert original["objects"]
    for target in (f"house{suffix}", f"there/one{suffix}"):
        blob, _ = voxrt.read_any(folder / "house.mem")
        voxrt.convert(blob, folder / target)
        voxrt.convert(voxrt.read_any(folder / target)[0], folder / "back" / "house.mem")
        back = json.loads((folder / "back" / "house.json").read_bytes())
        for manifest in (original, back):
            manifest.pop("seconds", None)
        assert back == original
        assert json.loads((folder / "house.json").read_bytes())["objects"] == original["objects"]


def test_conversion_of_the_memory_alone_keeps_its_manifest(folder):
    built = voxrt.build(folder / "house.obj", folder, depth=4)
    before = (folder / "house.json").read_bytes()
    voxrt.convert(built.rom, folder / "house.coe")
    assert (folder / "house.json").read_bytes() == before


def test_conversion_does_not_take_the_manifest_from_another_file(folder):
    voxrt.build(folder / "house.obj", folder, depth=4)
    before = {name: (folder / name).read_bytes() for name in names(folder)}
    finished = command(folder, "convert", "house.mem", "house.coe", "--dialect", "msb")
    assert finished.returncode == 2
    assert "house.json belongs to house.mem, which has other words" in finished.stderr
    assert {name: (folder / name).read_bytes() for name in names(folder)} == before


def test_two_assets_of_one_stem(folder):
    (folder / "other").mkdir()
    shutil.copy(folder / "house.obj", folder / "other" / "House.obj")
    shutil.copy(folder / "dog.usda", folder / "other" / "house.usda")
    before = names(folder)
    finished = command(folder, "build", "house.obj", "other/House.obj", "--depth", "3")
    assert finished.returncode == 2
    assert "house.obj and other/House.obj would both be written" in finished.stderr
    assert names(folder) == before
    assert command(folder, "build", "house.obj", "-o", "out", "--depth", "3").returncode == 0
    kept = {name: (folder / "out" / name).read_bytes() for name in names(folder / "out")}
    finished = command(folder, "build", "other/house.usda", "-o", "out", "--depth", "3")
    assert finished.returncode == 2
    assert "out/house.mem: was built from house.obj, not from house.usda" in finished.stderr
    assert {name: (folder / "out" / name).read_bytes() for name in names(folder / "out")} == kept
    assert command(folder, "build", "other/house.usda", "-o", "out/house.mem", "--depth", "3").returncode == 0


def test_a_json_of_somebody_else(folder):
    (folder / "house.json").write_text('{"mine": true}')
    finished = command(folder, "build", "house.obj", "--depth", "3")
    assert finished.returncode == 2
    assert "house.json is there and is no manifest" in finished.stderr
    assert (folder / "house.json").read_text() == '{"mine": true}'
    assert not (folder / "house.mem").exists()
