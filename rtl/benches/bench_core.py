"""The whole core from its pins: registers over AXI4-Lite, a scene through the memory port, pictures off the stream."""

import itertools
import random

import cocotb
import numpy as np
from cocotb.triggers import ClockCycles, RisingEdge
from cocotb.utils import get_sim_time
from core_driver import CAMERA, COLOURS, MIRRORS, scene, started
from oracles.memory import words_of
from oracles.ray import directions, readings, render
from oracles.shading import Shader, shaded_pixel
from voxrt_registers import REGISTERS

# What the oracle is told, and the feature that it belongs to.
FEATURES = {"light": "light", "ambient": "light", "bounces": "mirrors", "mirrors": "mirrors"}


def shaded(voxels, width, height, **shading):
    """Give what docs/shading.md says that CAMERA sees."""
    shader = Shader(COLOURS, **shading)
    rays = directions(CAMERA, width, height).reshape(-1, 3)
    colours = [shaded_pixel(voxels, shader, CAMERA[0], direction)[0] for direction in rays]
    return np.array(colours, np.uint8).reshape(height, width, 3)


@cocotb.test()
async def every_width_and_pattern(dut):
    """All phases of the packer, under back-pressure of several kinds."""
    voxels = scene(1)
    core = await started(dut, voxels)
    chance = random.Random(1)
    patterns = [
        itertools.repeat(1),
        itertools.cycle([1, 0]),
        itertools.cycle([0, 0, 0, 0, 1]),
        iter(lambda: chance.randrange(2), 2),
    ]
    for width, pattern in itertools.product((1, 2, 3, 4, 5, 8, 11), patterns):
        core.ready = pattern
        await core.set_frame(CAMERA, width, 3, 3)
        colour, _, _ = render(voxels, CAMERA, width, 3, COLOURS)
        np.testing.assert_array_equal(await core.trace(width, 3), colour)
        assert core.words == []


@cocotb.test()
async def counters_and_identity(dut):
    """Read registers as the description says, and count a frame."""
    core = await started(dut)
    assert (await core.axi.read_dword(REGISTERS["identity"][0])).to_bytes(4, "big") == b"VXRT"
    assert await core.read("size", "width") == 640
    assert await core.read("size", "height") == 480
    for name, value in (("position[1]", -123456), ("look[2]", -77)):
        width = REGISTERS[name][1]["value"][1]
        await core.write(name, value=value)
        assert await core.read(name, "value") == value & ((1 << width) - 1)
    voxels = scene(2)
    await core.load(words_of(voxels))
    await core.set_frame(CAMERA, 20, 10, 3)
    _, material, _ = render(voxels, CAMERA, 20, 10, COLOURS)
    words = words_of(voxels)
    rays = directions(CAMERA, 20, 10).reshape(-1, 3)
    wanted = sum(len(readings(words, 3, CAMERA[0], direction)) for direction in rays)
    for idle in (0, 30, 9):  # clocks between words of the stream that are taken
        core.ready = itertools.cycle([1, *[0] * idle])
        before = get_sim_time("ns")
        await core.trace(20, 10)
        clocks = (get_sim_time("ns") - before) / 10
        cycles, stalls = await core.read("cycles", "value"), await core.read("stalls", "value")
        assert wanted / int(dut.Lanes.value) < cycles < clocks
        assert (stalls > 0) == (idle > 0)
        assert stalls < cycles
        assert await core.read("rays", "value") == 200
        assert await core.read("hits", "value") == (material > 0).sum()
        assert await core.read("words_read", "value") == wanted
    assert await core.read("status", "busy") == 0
    for error in ("direction_overflow", "bad_pointer", "step_limit"):
        assert await core.read("status", error) == 0


@cocotb.test()
async def a_scene_is_swapped_between_frames(dut):
    """Continuous frames; hold, write another scene, go on: every frame shows one scene, none is torn or hangs."""
    core = await started(dut)
    worlds = [scene(3), scene(4)]
    pictures = [render(world, CAMERA, 12, 9, COLOURS)[0] for world in worlds]
    await core.load(words_of(worlds[0]))
    await core.set_frame(CAMERA, 12, 9, 3)
    await core.write("control", continuous=1)
    await core.wait()
    await core.write("control", continuous=1, hold=1)
    while await core.read("status", "busy"):
        pass
    await core.load(words_of(worlds[1]))
    await core.write("control", continuous=1)
    await core.wait()
    await core.wait()
    await core.hold(40)
    seen = []
    while core.words:
        picture = core.picture(12, 9)
        assert any((picture == candidate).all() for candidate in pictures)
        seen.append([(picture == candidate).all() for candidate in pictures].index(True))
    assert seen == sorted(seen)
    assert seen[0] == 0
    assert seen[-1] == 1


@cocotb.test()
async def scenes_are_swapped_by_their_roots_while_frames_go_on(dut):
    """Write root at any clock, and words of the scene that is not traced; every frame shows one scene, whole."""
    core = await started(dut)
    worlds = [scene(9), scene(10)]
    pictures = [render(world, CAMERA, 9, 7, COLOURS)[0] for world in worlds]
    first, second = (words_of(world) for world in worlds)
    base = (len(first) + 7) // 8 * 8
    moved = [int(word) if word >> 31 else int(word) + base for word in second]
    await core.load([*first, *[0] * (base - len(first)), *moved])
    await core.set_frame(CAMERA, 9, 7, 3)
    chance = random.Random(2)
    core.ready = iter(lambda: chance.randrange(2), 2)
    await core.write("control", continuous=1)
    for number in range(10):
        await core.write("root", address=base * (number % 2))
        await core.write("status", frame_done=1)
        for _ in range(2):
            while not await core.read("status", "frame_done"):
                pass
            await core.write("status", frame_done=1)
        if number % 2:
            await core.load(first)
        await ClockCycles(dut.clk_i, chance.randrange(200))
    await core.hold(100)
    seen = []
    while core.words:
        picture = core.picture(9, 7)
        seen.append([(picture == candidate).all() for candidate in pictures].index(True))
    assert sum(a != b for a, b in itertools.pairwise(seen)) == 9
    assert len(seen) >= 20


@cocotb.test()
async def a_camera_written_during_a_frame_shows_in_the_next(dut):
    voxels = scene(5)
    core = await started(dut, voxels, 16, 16)
    other = CAMERA.copy()
    other[0] = [40, 40, -90]
    other[1] = [9, 8, 90]
    await core.write("control", start=1)
    await core.set_frame(other, 7, 5, 3)
    await core.wait()
    await core.write("control", start=1)
    await core.wait()
    np.testing.assert_array_equal(core.picture(16, 16), render(voxels, CAMERA, 16, 16, COLOURS)[0])
    np.testing.assert_array_equal(core.picture(7, 5), render(voxels, other, 7, 5, COLOURS)[0])


@cocotb.test()
async def reset_at_any_clock(dut):
    """Reset in the middle of a frame, after a picture that would show through; the next frame is whole."""
    voxels = scene(6)
    core = await started(dut, voxels, 9, 6)
    expected = render(voxels, CAMERA, 9, 6, COLOURS)[0]
    other = CAMERA.copy()
    other[0] = [40, 40, -90]
    for clocks in (0, 1, 5, 30, 77, 200, 333):
        await core.set_frame(other, 9, 6, 3)
        await core.write("control", start=1)
        await ClockCycles(dut.clk_i, clocks)
        await core.soft_reset()
        assert await core.read("status", "busy") == 0
        await core.set_frame(CAMERA, 9, 6, 3)
        np.testing.assert_array_equal(await core.trace(9, 6), expected)


@cocotb.test()
@cocotb.parametrize(register=["size", "depth"])
async def values_out_of_range_count_as_the_nearest(dut, register):
    """Width, height and depth 0, and depths above the deepest."""
    deepest = int(dut.MaxDepth.value)
    voxels = scene(12)
    core = await started(dut, voxels, 7, 5)
    if register == "size":
        for written, meant in (((0, 5), (1, 5)), ((7, 0), (7, 1)), ((0, 0), (1, 1))):
            await core.write("size", width=written[0], height=written[1])
            np.testing.assert_array_equal(await core.trace(*meant), render(voxels, CAMERA, *meant, COLOURS)[0])
        return
    for depth in (0, deepest + 1, 31):
        pictures = []
        for number in (depth, min(max(depth, 1), deepest)):
            await core.write("depth", depth=number)
            pictures.append(await core.trace(7, 5))
        np.testing.assert_array_equal(*pictures)


@cocotb.test()
@cocotb.parametrize(writes=[False, True])
async def the_processor_uses_the_memory_port_at_every_clock(dut, writes):
    """Lanes keep a share of the memory: the frame ends, in at most 2.5 times the clocks; its pixels are the same."""
    core = await started(dut)
    voxels = scene(13)
    words = words_of(voxels)
    await core.load(words)
    width, height = 12, 5 * int(dut.Lanes.value)
    await core.set_frame(CAMERA, width, height, 3)
    expected = render(voxels, CAMERA, width, height, COLOURS)[0]

    async def use_the_port():
        dut.bram_en_i.value = 1
        for address in itertools.cycle(range(len(words))):
            dut.bram_we_i.value = 15 if writes else random.randrange(15)  # Only whole words are written.
            dut.bram_addr_i.value = 4 * address
            dut.bram_wrdata_i.value = int(words[address]) if writes else random.getrandbits(32)
            await RisingEdge(dut.clk_i)

    cycles = []
    for busy in (False, True):
        user = cocotb.start_soon(use_the_port()) if busy else None
        await core.write("control", start=1)
        await core.wait()
        if user:
            user.cancel()
            dut.bram_en_i.value = dut.bram_we_i.value = 0
        np.testing.assert_array_equal(core.picture(width, height), expected)
        cycles.append(await core.read("cycles", "value"))
    assert cycles[1] < 2.5 * cycles[0]


@cocotb.test()
@cocotb.parametrize((("error", "pointer"), [("step_limit", 1), ("bad_pointer", 7)]))
async def errors_stick_until_cleared(dut, error, pointer):
    """Raise an error by a corrupt memory; the frame ends."""
    core = await started(dut)
    await core.load([1, *[pointer] * 8])
    await core.set_frame(CAMERA, 8, 8, 3)
    await core.write("control", start=1)
    await core.wait()
    assert await core.read("status", error) == 1
    await core.load(words_of(scene(7)))
    await core.write("control", start=1)
    await core.wait()
    assert await core.read("status", error) == 1
    await core.write("status", **{error: 1})
    assert await core.read("status", error) == 0


@cocotb.test()
async def worlds_of_every_depth(dut):
    """Octants of two levels, larger and larger, from as far as they are large; of 64 voxels per side at most."""
    core = await started(dut)
    for depth in range(1, min(int(dut.MaxDepth.value), 6) + 1):
        octants = scene(20 + depth)[:4, :4, :4] if depth > 1 else np.full((2,) * 3, 2, np.uint8)
        half = 1 << depth - 1
        voxels = np.kron(octants, np.ones((2 * half // len(octants),) * 3, np.uint8))
        await core.load(words_of(voxels))
        camera = np.array([[-8 * half, 30 * half, -8 * half], *CAMERA[1:]], np.int32)
        await core.set_frame(camera, 11, 7, depth)
        colour, material, _ = render(voxels, camera, 11, 7, COLOURS)
        assert (material > 0).any()
        np.testing.assert_array_equal(await core.trace(11, 7), colour)


@cocotb.test()
async def directions_that_are_too_long(dut):
    """Refuse rays with a component of 2**20 or more, say so, and trace the others of the line."""
    voxels = scene(7)
    core = await started(dut, voxels)
    camera = np.array([[-60, 150, -70], [20000, -15000, 20000], [32767, 0, 0], [0, 300, 0]], np.int32)
    await core.set_frame(camera, 80, 2, 3)
    picture = await core.trace(80, 2)
    colour, material, _ = render(voxels, camera, 80, 2, COLOURS)
    refused = (np.abs(directions(camera, 80, 2)) >= 1 << 20).any(axis=2)
    assert refused.any()
    assert (material > 0).any()
    np.testing.assert_array_equal(picture, np.where(refused[..., None], COLOURS[0], colour))
    assert await core.read("status", "direction_overflow") == 1
    await core.write("status", direction_overflow=1)
    await core.set_frame(CAMERA, 5, 4, 3)
    await core.trace(5, 4)
    assert await core.read("status", "direction_overflow") == 0


@cocotb.test()
async def light_and_mirrors_written_during_a_frame_show_in_the_next(dut):
    """Shading is latched at the frame's start; a core without a feature shows none, and says so."""
    core = await started(dut)
    features = {name for name in ("light", "mirrors") if await core.read("features", name)}
    parameters = {"light": dut.Light, "mirrors": dut.Mirrors}
    assert features == {name for name, built in parameters.items() if int(built.value)}
    assert await core.read("features", "flat")
    assert await core.read("features", "faces")
    voxels = scene(8)
    await core.load(words_of(voxels))
    await core.write_mirrors()
    await core.set_frame(CAMERA, 14, 11, 3)
    looks = [
        {"light": (-40, 200, 30), "ambient": 50},
        {"flat": True},
        {"bounces": 3, "mirrors": MIRRORS},
        {"light": (70, 60, 50), "ambient": 7, "flat": True, "bounces": 15, "mirrors": MIRRORS},
        {"light": (-40, -200, 30), "bounces": 1, "mirrors": MIRRORS},
        {"faces": (1, 40, 99, 255, 200, 0)},
        {
            "faces": (254, 215, 156, 0, 55, 255),
            "light": (-40, 200, 30),
            "ambient": 90,
            "bounces": 2,
            "mirrors": MIRRORS,
        },
        {},
    ]
    for look, following in itertools.pairwise([{}, *looks, {}]):
        # What is written now is the next frame's.
        await core.write("control", start=1)
        await core.set_light(following.get("light", (0, 0, 0)))
        await core.set_faces(following.get("faces", (77,) * 6))
        present = {name: name in following for name in ("flat", "faces", "light")}
        values = {name: following.get(name, 0) for name in ("ambient", "bounces")}
        await core.write("shading", **present, **values)
        await core.wait()
        built = {name: value for name, value in look.items() if name not in FEATURES or FEATURES[name] in features}
        np.testing.assert_array_equal(core.picture(14, 11), shaded(voxels, 14, 11, **built))


@cocotb.test()
@cocotb.parametrize(reset=["soft", "pin"])
async def one_clock_of_reset(dut, reset):
    """Reset for one clock, at each phase of the lanes' rings; three frames after it are whole.

    A frame has more rays per lane than a lane has rows for their weights, so that each row is used again.
    """
    voxels = scene(11)
    core = await started(dut, voxels)
    features = {name for name in ("light", "mirrors") if await core.read("features", name)}
    shading = {"light": {"light": (-40, 200, 30), "ambient": 50}, "mirrors": {"bounces": 3, "mirrors": MIRRORS}}
    shading = {key: value for name in features for key, value in shading[name].items()}
    width, height = 11, 7 * int(dut.Lanes.value)
    expected = shaded(voxels, width, height, **shading)

    async def prepare():
        await core.write_mirrors()
        await core.set_frame(CAMERA, width, height, 3)
        await core.set_light(shading.get("light", (0, 0, 0)))
        await core.write("shading", light="light" in features, ambient=50, bounces=shading.get("bounces", 0))

    await prepare()
    for clocks in range(250, 266):
        await core.write("control", start=1)
        await ClockCycles(dut.clk_i, clocks)
        core.dropping = True
        if reset == "soft":
            await core.write("control", soft_reset=1)
        else:
            dut.rst_ni.value = 0
            await ClockCycles(dut.clk_i, 1)
            dut.rst_ni.value = 1
            await ClockCycles(dut.clk_i, 2)
            await prepare()
        await ClockCycles(dut.clk_i, 4)
        core.dropping = False
        core.words.clear()
        await core.write("status", frame_done=1)
        for _ in range(3):
            np.testing.assert_array_equal(await core.trace(width, height), expected)
        assert core.words == []
