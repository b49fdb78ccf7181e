"""Frames by way of a Rom: both engines, what they refuse, the published memories, picture files."""

import importlib.util
import sys

import numpy as np
import pytest
from assets import over_assets
from oracles import worlds
from oracles.cuts import memory_of
from oracles.ray_batch import trace_batch
from oracles.seeds import HOUSE_CAMERA, SEED_DEPTH, PointQueries, seed_words
from PIL import Image

from voxrt.octree import Octree, Rom
from voxrt.sim import (
    FACE_NONE,
    Camera,
    Lighting,
    SimulatorError,
    check,
    frame_scene,
    pixel_directions,
    render,
    write_png,
)
from voxrt.voxelize import Material

needs_rtl = pytest.mark.skipif(
    importlib.util.find_spec("voxrt.sim._rtl") is None, reason="this build has no verilated ray tracer"
)


ALONG_Z = Camera((0, 0, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0))


def rom_of(words, depth, name="scene"):
    colours = np.random.default_rng(depth).integers(40, 256, (256, 3)).tolist()
    materials = tuple(Material(f"m{i}", tuple(colour)) for i, colour in enumerate(colours))
    return Rom(name, Octree(depth, words), materials)


@pytest.fixture(scope="module")
def rom():
    return rom_of(memory_of(worlds.ball(5)), 5)


def test_the_model_gives_a_whole_frame(rom):
    camera = frame_scene(rom, (80, 60))
    frame = render(rom, camera, (80, 60), engine="model")
    assert frame.colour.shape == (60, 80, 3)
    assert frame.material.shape == frame.face.shape == (60, 80)
    seen = frame.material > 0
    assert 0.15 < seen.mean() < 0.8
    assert np.all(frame.face[~seen] == FACE_NONE)
    assert np.all(frame.colour[~seen] == rom.materials[0].colour)
    assert frame.cost.rays == 4800
    assert frame.cost.words_read is frame.cost.cycles is None
    # From above, in front and on the right: upper faces show, and the materials of the upper octants.
    assert set(np.unique(frame.face[seen])) == {0, 1, 2}
    assert {3 + 1, 4 + 3 + 1} <= set(np.unique(frame.material))


@over_assets("name", ["cubes", "dog", "house"])
def test_the_published_memories_are_seen_without_a_wrong_pixel(name):
    words = seed_words(name)
    rom = rom_of(words, SEED_DEPTH, name)
    camera = Camera(*HOUSE_CAMERA)
    size = (256, 256)
    frame = render(rom, camera, size, engine="model")
    pixels = np.random.default_rng(9).choice(size[0] * size[1], 2_000, replace=False)
    directions = pixel_directions(camera, size).reshape(-1, 3)[pixels]
    origins = np.broadcast_to(np.array(camera.position), directions.shape)
    material, face, _ = trace_batch(PointQueries(words, SEED_DEPTH), origins, directions)
    np.testing.assert_array_equal(frame.material.reshape(-1)[pixels], material)
    np.testing.assert_array_equal(frame.face.reshape(-1)[pixels], face)
    assert len(np.unique(frame.material)) > 2 or name != "house"


@pytest.mark.parametrize("engine", ["model", pytest.param("rtl", marks=needs_rtl)])
def test_progress_counts_the_rows_of_all_samples(rom, engine):
    size, calls = (160, 120), []
    render(rom, frame_scene(rom, size), size, engine=engine, samples=2, progress=lambda *rows: calls.append(rows))
    done = [rows for rows, _ in calls]
    assert done == sorted(done)
    assert {120, 240, 360, 480} <= set(done)
    assert calls[-1] == (480, 480)
    assert {total for _, total in calls} == {480}
    if engine == "rtl":
        assert len(done) > 4


@needs_rtl
def test_what_the_caller_of_progress_raises_ends_the_frame(rom):
    def stop(done, total):
        raise KeyError((done, total))

    with pytest.raises(KeyError):
        render(rom, frame_scene(rom, (160, 120)), (160, 120), engine="rtl", progress=stop)


def test_an_empty_memory_frames_its_world():
    nothing = rom_of(np.array([0xFFFFFF00], np.uint32), 3)
    whole = rom_of(np.array([0xFFFFFF01], np.uint32), 3)
    assert frame_scene(nothing, (64, 48)) == frame_scene(whole, (64, 48))
    assert not np.any(render(nothing, frame_scene(nothing, (64, 48)), (64, 48), engine="model").material)


def test_a_shaded_rom_is_lit_and_reflects():
    voxels = np.zeros((8, 8, 8), np.uint8)
    voxels[:, 0] = 1
    voxels[3:5, 1:4, 3:5] = 2
    materials = (
        Material("air", (9, 9, 30)),
        Material("floor", (200, 200, 200), mirror=True),
        Material("box", (250, 0, 0)),
    )
    rom = Rom("scene", Octree(3, memory_of(voxels)), materials)
    camera = frame_scene(rom, (64, 48))
    plain = render(rom, camera, (64, 48), engine="model")
    floor = plain.material == 1
    flat = render(rom, camera, (64, 48), engine="model", lighting=Lighting(flat=True))
    np.testing.assert_array_equal(np.unique(flat.colour[floor], axis=0), [[200, 200, 200]])
    lit = render(
        rom, camera, (64, 48), engine="model", lighting=Lighting((16 * 30, 16 * 40, 16 * 5), ambient=64, on=True)
    )
    # The box's shadow on the floor's top; by hand: 200 64 / 256.
    dark = np.all(lit.colour == 50, axis=2) & floor
    assert 0.02 < dark.sum() / floor.sum() < 0.5
    mirrored = render(rom, camera, (64, 48), engine="model", lighting=Lighting(bounces=1))
    assert np.any(mirrored.material[floor] == 2)
    assert np.any(mirrored.material[floor] == 0)
    np.testing.assert_array_equal(mirrored.colour[plain.material == 2], plain.colour[plain.material == 2])


@pytest.mark.parametrize(
    ("lighting", "message"),
    [
        (Lighting(bounces=16), "16 reflections are not 0 … 15"),
        (Lighting((0, 0, 0), ambient=256, on=True), "ambient brightness of 256 is not 0 … 255"),
        (Lighting(faces=(0, 0, 0, 256, 0, 0)), "the brightness of faces .* is not six numbers of 0 … 255"),
        (Lighting(faces=(0, 0, 0)), "the brightness of faces .* is not six numbers of 0 … 255"),
        (Lighting((0, 1 << 31, 0), on=True), "the light at .* is not within signed 32 bits"),
    ],
)
def test_lighting_out_of_range_is_refused(rom, lighting, message):
    with pytest.raises(SimulatorError, match=message):
        render(rom, ALONG_Z, (4, 4), engine="model", lighting=lighting)


def test_directions_that_overflow_are_refused(rom):
    camera = Camera((0, 0, 0), (0, 0, 1), (32767, 0, 0), (0, 1, 0))
    with pytest.raises(SimulatorError, match=r"directions reach 1081311 at the .* not below 2\*\*20"):
        render(rom, camera, (66, 4), engine="model")


@pytest.mark.parametrize("size", [(0, 4), (4, 0), (16385, 1), (-3, 4)])
def test_sizes_out_of_range_are_refused(rom, size):
    with pytest.raises(ValueError, match=r"size\[[01]\] must be an integer 1 … 16384"):
        render(rom, ALONG_Z, size, engine="model")


def test_a_missing_ray_tracer_says_what_to_do(rom, monkeypatch):
    monkeypatch.setitem(sys.modules, "voxrt.sim._rtl", None)
    with pytest.raises(SimulatorError, match=r"no verilated ray tracer .*--engine model"):
        render(rom, ALONG_Z, (4, 4), engine="rtl")


@needs_rtl
def test_the_ray_tracer_refuses_what_it_cannot_hold(rom):
    with pytest.raises(SimulatorError, match="no ray tracer configuration 'huge'; there are"):
        render(rom, ALONG_Z, (4, 4), engine="rtl", config="huge")
    far = Camera((0, 1 << 29, 0), ALONG_Z.look, ALONG_Z.right, ALONG_Z.up)
    with pytest.raises(SimulatorError, match=r"scene does not fit .*: a camera at \(0.0, 33554432.0, 0.0\)"):
        render(rom, far, (4, 4), engine="rtl")
    with pytest.raises(SimulatorError, match=r"4097x4 pixels; it counts to 4095; .*--engine model"):
        render(rom, ALONG_Z, (4097, 4), engine="rtl")
    words = np.full(9 + 8 * (1 << 21), 0xFFFFFF00, np.uint32)
    with pytest.raises(SimulatorError, match=r"16777225 words; it holds \d+"):
        render(rom_of(words, 5), ALONG_Z, (4, 4), engine="rtl")


@needs_rtl
def test_both_engines_agree(rom):
    camera = frame_scene(rom, (40, 30))
    agreement = check(rom, camera, (40, 30))
    assert agreement.wrong_pixels == 0
    assert agreement.wrong.shape == (30, 40)
    assert agreement.rtl.cost.cycles > 1200


def test_pictures_are_whole_and_the_same_every_time(rom, tmp_path):
    frame = render(rom, frame_scene(rom, (50, 40)), (50, 40), engine="model")
    path = tmp_path / "frame.png"
    write_png(path, frame.colour)
    first = path.read_bytes()
    write_png(path, frame.colour)
    assert path.read_bytes() == first
    with Image.open(path) as picture:
        np.testing.assert_array_equal(np.asarray(picture), frame.colour)
    assert [entry.name for entry in tmp_path.iterdir()] == ["frame.png"]


def test_a_picture_that_cannot_be_written_leaves_nothing(tmp_path):
    (tmp_path / "folder.png").mkdir()
    with pytest.raises(OSError, match=r"folder\.png"):
        write_png(tmp_path / "folder.png", np.zeros((2, 2, 3), np.uint8))
    assert [entry.name for entry in tmp_path.iterdir()] == ["folder.png"]


@needs_rtl
def test_the_ray_tracer_shades_as_the_model(rom):
    camera = frame_scene(rom, (40, 30))
    lighting = Lighting((300, 900, -70), ambient=20, on=True, bounces=3)
    found = check(rom, camera, (40, 30), lighting=lighting, config="lit4")
    assert found.wrong_pixels == 0
    assert not np.array_equal(found.rtl.colour, render(rom, camera, (40, 30), engine="model").colour)


@needs_rtl
@pytest.mark.parametrize(
    ("lighting", "absent"),
    [
        (Lighting((0, 0, 0), on=True), "light"),
        (Lighting((0, 0, 0), on=True, bounces=2, flat=True), "light and mirrors"),
    ],
)
def test_a_configuration_without_the_feature_says_so(rom, lighting, absent):
    with pytest.raises(SimulatorError, match=f"'tiny' is built without {absent}; .*'lit'.*--engine model"):
        render(rom, ALONG_Z, (4, 4), engine="rtl", lighting=lighting)


@needs_rtl
def test_a_light_too_far_for_the_ray_tracer_is_refused(rom):
    camera = frame_scene(rom, (40, 30))
    for light, message in ((1 << 30, "a light outside of"), (700_000, "move it nearer")):
        lighting = Lighting((light,) * 3, on=True)
        with pytest.raises(SimulatorError, match=message):
            render(rom, camera, (40, 30), engine="rtl", lighting=lighting, config="lit4")
