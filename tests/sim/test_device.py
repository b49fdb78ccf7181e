"""The devices without a board show, pixel by pixel, what the engines render."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np
import pytest
from fakes.box_scenes import ignore
from fakes.device import opened_or_skipped
from msgspec.structs import replace
from oracles import worlds
from oracles.cuts import memory_of

from voxrt.board import register_device
from voxrt.board.errors import DeviceError
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.core import open_rtl
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import View, refit
from voxrt.boards.board_scenes import board_scene
from voxrt.export import Blob
from voxrt.octree import Octree, Rom
from voxrt.sim import Camera, Lighting, NoSuchConfigurationError, render
from voxrt.voxelize import Material

SIZE = (48, 32)
TINY = partial(open_rtl, "tiny")


def rom_of(name, seed):
    colours = np.random.default_rng(seed).integers(40, 256, (256, 3)).tolist()
    words = memory_of(worlds.boxes(4, 9, seed))
    return Rom(name, Octree(4, words), tuple(Material(f"m{i}", tuple(colour)) for i, colour in enumerate(colours)))


@pytest.mark.parametrize(
    ("engine", "opened"), [("model", ModelDevice), ("tiny", TINY), ("lit", partial(open_rtl, "lit"))]
)
def test_swapped_scenes(engine, opened):
    device = opened_or_skipped(opened)
    memory = SceneMemory(device)
    roots = set()
    for seed in range(3):
        rom = rom_of(f"world {seed}", seed)
        scene = board_scene(Blob(rom))
        memory.load(scene, ignore)
        seen = refit(scene.camera, (640, 480), SIZE)
        frame = device.frame(View(seen, SIZE, scene.background))
        camera = Camera(seen.position, seen.look, seen.right, seen.up)
        expected = render(rom, camera, SIZE, engine="model")
        assert (frame.colour == expected.colour).all()
        assert len(np.unique(expected.material)) > 2
        assert frame.counters.rays == SIZE[0] * SIZE[1]
        assert (frame.counters.cycles is None) == (engine == "model")
        registers = device.registers()
        assert registers["depth"] == 4
        place = scene.camera.position[0]
        assert registers.get("position_x", place) == place
        assert registers.get("position[0]", place & 0xFFFFFFFF) == place & 0xFFFFFFFF
        roots.add(registers.get("root", 0))
    assert len(roots) == 2


@pytest.mark.parametrize("opened", [ModelDevice, partial(open_rtl, "lit")])
def test_features_and_background(opened):
    rom = rom_of("world", 1)
    mirrors = tuple(replace(material, mirror=i % 2 == 1) for i, material in enumerate(rom.materials))
    rom = replace(rom, materials=(replace(mirrors[0], colour=(1, 2, 3)), *mirrors[1:]))
    scene = board_scene(Blob(rom))
    device = opened_or_skipped(opened)
    assert device.identity.features == {"light", "mirrors"}
    SceneMemory(device).load(scene, ignore)
    size = (80, 60)
    seen = refit(scene.camera, (640, 480), size)
    pictures = set()
    for lighting in (
        Lighting(),
        Lighting(faces=(1, 2, 3, 250, 99, 98)),
        Lighting(faces=None),
        Lighting(flat=True),
        Lighting((400, 900, -100), 20, on=True),
        Lighting((400, 900, -100), 20, on=True, bounces=3),
        Lighting((400, 900, -100), 20, on=True, bounces=3, faces=None),
    ):
        view = View(seen, size, (1, 2, 3), lighting)
        picture = device.frame(view).colour
        assert (picture == render(rom, seen, size, engine="model", lighting=lighting).colour).all()
        pictures.add(picture.tobytes())
    assert len(pictures) == 7


def test_a_core_without_features():
    assert opened_or_skipped(TINY).identity.features == frozenset()


def test_faults():
    device = ModelDevice(capacity=100)
    with pytest.raises(DeviceError, match="words 96 to 101 are not in a memory of 100"):
        device.write_memory(96, np.zeros(5, dtype=np.uint32))
    with pytest.raises(DeviceError, match="not in a memory"):
        device.read_memory(0, 101)
    assert (device.read_memory(50, 50) == 0).all()
    device.write_memory(0, np.array([5], dtype=np.uint32))
    with pytest.raises(DeviceError, match="the model refuses the memory"):
        device.select_scene(0, 3)
    scene = board_scene(Blob(rom_of("world", 1)))
    device = ModelDevice()
    SceneMemory(device).load(scene, ignore)
    steep = replace(scene.camera, right=(32767, 0, 0), up=(32767, 0, 0))
    with pytest.raises(DeviceError, match="the model refuses the frame"):
        device.frame(View(steep, (640, 480)))


def test_every_width_of_the_stream():
    device, model = opened_or_skipped(TINY), ModelDevice()
    scene = board_scene(Blob(rom_of("world", 5)))
    for either in (device, model):
        SceneMemory(either).load(scene, ignore)
    for columns in (1, 2, 3, 4, 5, 7, 31):
        size = (columns, 9)
        view = View(refit(scene.camera, (640, 480), size), size, (3, 2, 1))
        assert (device.frame(view).colour == model.frame(view).colour).all()


def test_an_unknown_configuration():
    opened_or_skipped(TINY)
    with pytest.raises(
        NoSuchConfigurationError, match="no ray tracer configuration 'huge'; there are cached1, lit, tiny"
    ):
        open_rtl("huge")


def test_a_frame_from_another_thread_and_a_dropped_one(monkeypatch):
    device = opened_or_skipped(TINY)
    scene = board_scene(Blob(rom_of("world", 6)))
    SceneMemory(device).load(scene, ignore)
    view = View(refit(scene.camera, (640, 480), SIZE), SIZE)
    with ThreadPoolExecutor(1) as pool:
        good = pool.submit(device.frame, view).result().colour
    with monkeypatch.context() as patch:
        patch.setattr(register_device, "_STUCK_SECONDS", 0.0)
        patch.setattr(device, "_pause", lambda: None)  # the clock stands
        with pytest.raises(DeviceError, match="the frame does not end: no pixel came"):
            device.frame(view)
    assert (device.frame(view).colour == good).all()
