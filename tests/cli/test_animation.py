"""Animations from assets to pictures: every frame is what it is alone, and what is no animation is refused."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import voxrt
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import View
from voxrt.boards.board_scenes import board_scene, load_scene
from voxrt.cli.run import run
from voxrt.export import write_blob

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from animated_assets import write_lift_glb, write_lift_usda, write_still_obj

SIZE = (64, 48)


@pytest.fixture
def lift(tmp_path):
    return write_lift_glb(tmp_path / "lift.glb")


def bounds_of(grid: voxrt.Grid) -> tuple[float, ...]:
    return (*grid.origin, *(place + grid.size * grid.voxel_size for place in grid.origin))


@pytest.mark.parametrize(("suffix", "count"), [("glb", 8), ("usda", 4)])
def test_the_pixels_of_each_frame_are_those_of_that_frame_alone(tmp_path, suffix, count):
    write = {"glb": write_lift_glb, "usda": write_lift_usda}[suffix]
    path = write(tmp_path / f"lift.{suffix}")
    times = voxrt.frame_times(0, 2, count)
    built = voxrt.build_animation(path, depth=5, times=times)
    camera = voxrt.animation_camera(built.blob, SIZE)
    assert len(built.octree.words) < 0.8 * built.animation.words_alone
    seen = set()
    for time, frame in zip(times, built.animation.frames, strict=True):
        alone = voxrt.build(path, time=time, depth=5, bounds=bounds_of(built.rom.grid))
        assert (frame.time, frame.words) == (time, len(alone.octree.words))
        expected = voxrt.render(alone.rom, camera, size=SIZE, engine="model").colour
        found = voxrt.render(built.rom, camera, size=SIZE, engine="model", root=frame.root).colour
        assert np.array_equal(found, expected)
        seen.add(found.tobytes())
    assert len(seen) == count // 2 + 1  # it comes down as it went up


def test_the_hardware_shows_a_frame_by_its_root(lift):
    built = voxrt.build_animation(lift, depth=4, times=voxrt.frame_times(0, 2, 4))
    camera = voxrt.animation_camera(built.blob, (24, 18))
    checked = voxrt.check(built.rom, camera, (24, 18), root=built.animation.roots[2])
    alone = voxrt.render(built.blob.frame(2), camera, size=(24, 18), engine="model")
    assert checked.wrong_pixels == 0
    assert np.array_equal(checked.rtl.colour, alone.colour)


def test_a_folder_of_assets_in_natural_order(tmp_path):
    heights = {"up_10.obj": 4.0, "up_2.obj": 2.0, "up_1.obj": 1.0}
    for name, height in heights.items():
        write_still_obj(tmp_path / name, height)
    (tmp_path / "notes.txt").write_text("no asset")
    built = voxrt.build_animation(tmp_path, depth=5)
    assert [frame.name for frame in built.animation.frames] == ["up_1.obj", "up_2.obj", "up_10.obj"]
    tops = [voxrt.octree.solid_bounds(built.blob.frame(row).octree)[1][1] for row in range(3)]
    assert tops == [12, 16, 24]
    several = voxrt.build_animation([tmp_path / name for name in ("up_1.obj", "up_2.obj", "up_10.obj")], depth=5)
    assert several.rom.name == "up"
    assert np.array_equal(several.octree.words, built.octree.words)


def test_materials_of_different_files_share_one_table(tmp_path):
    for row, colour in enumerate(("1 0 0", "0 1 0", "1 0 0")):
        (tmp_path / f"{row}.mtl").write_text(f"newmtl paint{row % 2}\nKd {colour}\n")
        path = write_still_obj(tmp_path / f"{row}.obj", 1.0 + row)
        path.write_text(f"mtllib {row}.mtl\nusemtl paint{row % 2}\n" + path.read_text())
    built = voxrt.build_animation(tmp_path, depth=4)
    assert [material.name for material in built.rom.materials] == ["empty", "paint0", "paint1"]
    used = [set(np.unique(voxrt.octree.to_points(built.blob.frame(row).octree)[1]).tolist()) for row in range(3)]
    assert used == [{1}, {2}, {1}]


def test_threads_do_not_change_a_byte(lift):
    times = voxrt.frame_times(0, 2, 5)
    one, many = (voxrt.build_animation(lift, depth=5, times=times, threads=threads) for threads in (1, 3))
    assert one.animation == many.animation
    assert np.array_equal(one.octree.words, many.octree.words)


def test_files_keep_the_frames(lift, tmp_path):
    built = voxrt.build_animation(lift, tmp_path, depth=4, times=voxrt.frame_times(0, 2, 4))
    for name in ("lift.blob", "again.coe"):
        voxrt.convert(voxrt.read_any(built.outputs["mem"])[0], tmp_path / name)
    for path in (built.outputs["mem"], tmp_path / "lift.blob", tmp_path / "again.coe"):
        blob, warnings = voxrt.read_any(path)
        assert (blob.animation, warnings) == (built.animation, ())
        assert np.array_equal(blob.frame(3).octree.words, built.blob.frame(3).octree.words)
    with pytest.raises(voxrt.RomError, match="frames 0 to 3"):
        blob.frame(4)


@pytest.mark.parametrize("root", [-1, 10**9, 0.5, "1"])
def test_a_manifest_with_a_wrong_root_is_refused(lift, tmp_path, root):
    files = voxrt.build_animation(lift, tmp_path, depth=4, times=voxrt.frame_times(0, 2, 4)).outputs
    manifest = json.loads(files["manifest"].read_text())
    manifest["animation"]["frames"][1]["root"] = root
    files["manifest"].write_text(json.dumps(manifest))
    with pytest.raises(voxrt.RomError):
        voxrt.read_any(files["mem"])


def test_a_device_plays_the_frames_by_its_root(lift, tmp_path):
    built = voxrt.build_animation(lift, tmp_path, depth=4, times=voxrt.frame_times(0, 2, 4))
    camera = voxrt.animation_camera(built.blob, SIZE)
    write_blob(tmp_path / "lift.blob", built.blob)
    scenes = (board_scene(built.blob), load_scene(tmp_path / "lift.blob"), load_scene(built.outputs["mem"]))
    device = ModelDevice(capacity=1 << 12)
    memory = SceneMemory(device)
    for scene in scenes:  # the second and the third stand at other places of the memory
        assert (scene.roots, scene.period) == (built.animation.roots, 0.5)
        memory.load(scene, lambda *_: None)
        for row in (2, 0, 3, 2):
            memory.select_frame(row)
            expected = voxrt.render(built.blob.frame(row), camera, size=SIZE, engine="model").colour
            found = device.frame(View(camera, SIZE, scene.background)).colour
            assert np.array_equal(found, expected)


def test_render_writes_a_gif_of_all_frames(lift, tmp_path):
    out = tmp_path / "out"
    assert run(["build", str(lift), "--frames", "0:2:4", "--depth", "4", "-o", str(out)]) == 0
    picture = ["render", str(out / "lift.mem"), "--engine", "model", "--size", "64x48"]
    assert run([*picture, "-o", str(out / "lift.gif")]) == 0
    assert run([*picture, "-o", str(out / "one.png"), "--frame", "2"]) == 0
    with Image.open(out / "lift.gif") as film:
        assert (film.n_frames, film.info["duration"], film.info["loop"]) == (4, 500, 0)
        film.seek(2)
        shown = np.array(film.convert("RGB"))
    assert np.array_equal(shown, np.array(Image.open(out / "one.png")))


def test_info_and_diff_tell_of_frames(lift, tmp_path, capsys):
    voxrt.build_animation(lift, tmp_path, depth=4, times=voxrt.frame_times(0, 2, 4))
    mem = str(tmp_path / "lift.mem")
    assert run(["info", mem, "--json"]) == 0
    frames = json.loads(capsys.readouterr().out)["frames"]
    assert [frame["time"] for frame in frames] == [0.0, 0.5, 1.0, 1.5]
    for others, voxels in (([], 64), (["--frame", "1", "--to-frame", "3"], 0)):
        assert run(["diff", mem, *others, "--json"]) == 0
        assert (json.loads(capsys.readouterr().out)["voxels"] > 0) == (voxels > 0)


@pytest.mark.parametrize(
    ("command", "whole"),
    [
        (["trace", "lift.mem", "--pixel", "3,4"], False),
        (["convert", "lift.mem", "lift.vox"], False),
        (["convert", "lift.mem", "lift.coe"], True),
        (["convert", "lift.mem", "core", "--form", "core"], True),
        (["info", "lift.mem"], True),
    ],
)
def test_a_command_that_uses_one_frame_says_so(lift, monkeypatch, capsys, command, whole):
    voxrt.build_animation(lift, lift.parent, depth=4, times=voxrt.frame_times(0, 2, 4))
    monkeypatch.chdir(lift.parent)
    assert run(command) == 0
    assert ("lift.mem has 4 frames, and the first is used" in capsys.readouterr().err) != whole


@pytest.mark.parametrize(
    ("arguments", "refusal"),
    [
        (["lift.glb", "--frames", "0:2:0"], (2, "0 frames are not 1 to 4096")),
        (["lift.glb", "--frames", "2:2:4"], (2, "must be after the start")),
        (["lift.glb", "--frames", "0:2"], (2, "not START:STOP:COUNT")),
        (["lift.glb", "--frames", "0:nan:3"], (2, "not START:STOP:COUNT")),
        (["lift.glb", "--frames", "5:9:4"], (3, "nothing moves")),
        (["lift.glb", "--frames", "0:2:9", "--depth", "15"], (4, "build 8 frames")),
        (["lift.glb", "--frames", "0:2:4", "--bake"], (2, "--bake is not for")),
        (["lift.glb", "--frames", "0:2:4", "--board", "pynq-z1"], (2, "--board is not for")),
        (["lift.glb", "--frames", "0:2:4", "--animation", "walk"], (3, "no animation 'walk'")),
        (["lift.glb", "still.obj", "--frames", "0:2:4"], (2, "is of one asset")),
        (["still.obj", "--frames", "0:2:4"], (3, "nothing moves")),
        (["empty", "--frames", "files"], (3, "the folder has no asset")),
    ],
)
@pytest.mark.usefixtures("lift")
def test_what_is_no_animation_is_refused(tmp_path, monkeypatch, capsys, arguments, refusal):
    code, message = refusal
    monkeypatch.chdir(tmp_path)
    write_still_obj(tmp_path / "still.obj", 1.0)
    (tmp_path / "empty").mkdir()
    assert run(["build", *arguments, "-o", "out"]) == code
    error = capsys.readouterr().err.strip().splitlines()[-1]
    assert message in error
    assert not (tmp_path / "out").exists()


def test_an_interrupted_write_leaves_the_old_pair(lift, tmp_path, monkeypatch):
    out = tmp_path / "out"
    voxrt.build_animation(lift, out, depth=4, times=voxrt.frame_times(0, 2, 4))
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    replace = Path.replace

    def fail(path: Path, target: Path) -> Path:
        if Path(target).suffix == ".json":
            raise KeyboardInterrupt
        return replace(path, target)

    with monkeypatch.context() as patched:
        patched.setattr(Path, "replace", fail)
        with pytest.raises(KeyboardInterrupt):
            voxrt.build_animation(lift, out, depth=5, times=voxrt.frame_times(0, 2, 3))
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before
