"""The core with EndsFrames: whatever a soft reset cuts, the stream has whole frames, and offers stay."""

import itertools
import random

import cocotb
import numpy as np
from cocotb.triggers import ClockCycles
from core_driver import CAMERA, COLOURS, scene, started
from oracles.ray import render


def frames_of(words, width, height):
    """Cut a stream into frames, and check the form of each; give the bytes of each: height rows of 3 width bytes."""
    per_line, rest = -(-3 * width // 4), 3 * width % 4
    frames = []
    while words:
        frame, words = words[: per_line * height], words[per_line * height :]
        assert len(frame) == per_line * height
        rows = []
        for number, (data, keep, user, last) in enumerate(frame):
            is_last = number % per_line == per_line - 1
            assert user == (number == 0)
            assert last == is_last
            assert keep == ((1 << rest) - 1 if is_last and rest else 15)
            rows.append(data.to_bytes(4, "little")[: keep.bit_count()])
        frames.append(np.frombuffer(b"".join(rows), np.uint8).reshape(height, 3 * width))
    return frames


def bytes_of(colour):
    """The bytes of a picture on the stream: green, blue, red."""
    return colour[..., (1, 2, 0)].reshape(len(colour), -1)


@cocotb.test()
async def a_soft_reset_ends_the_frame(dut):
    """At any clock, twice, with a start in the same write, under back-pressure; the next frame is right."""
    voxels = scene(5)
    core = await started(dut, voxels)
    chance = random.Random(7)
    core.ready = iter(lambda: chance.random() < 0.4, 2)
    cut = 0
    for trial in range(50):
        width, height = chance.randrange(1, 14), chance.randrange(1, 6)
        picture = bytes_of(render(voxels, CAMERA, width, height, COLOURS)[0])
        await core.set_frame(CAMERA, *(0 if side == 1 else side for side in (width, height)), 3)  # 0 counts as 1
        core.words.clear()
        await core.write("control", start=1)
        await ClockCycles(dut.clk_i, chance.randrange(1, 60 + 4 * width * height))
        await core.write("control", soft_reset=1, start=trial % 3 == 0)
        if trial % 4 == 0:
            await core.write("control", soft_reset=1)
        # Another size for the next frame does not change the one that is ended.
        other_width, other_height = chance.randrange(1, 14), chance.randrange(1, 5)
        other = bytes_of(render(voxels, CAMERA, other_width, other_height, COLOURS)[0])
        await core.set_frame(CAMERA, other_width, other_height, 3)
        await core.write("status", frame_done=1)  # the first frame may have ended before
        await core.write("control", start=1)
        await core.wait()
        await ClockCycles(dut.clk_i, 40)
        first = -(-3 * width // 4) * height
        other_words = -(-3 * other_width // 4) * other_height
        words = list(core.words)
        assert len(words) in {other_words, first + other_words}, (len(words), first, other_words)
        if len(words) > other_words:
            (found,) = frames_of(words[:first], width, height)
            wrong = (found != picture).ravel()
            # The picture up to a word, then black.
            end = int(np.argmax(wrong)) if wrong.any() else len(wrong)
            assert not found.ravel()[end - end % 4 + 4 :].any() or not wrong.any()
            cut += bool(wrong.any())
        (found,) = frames_of(words[-other_words:], other_width, other_height)
        np.testing.assert_array_equal(found, other)
    assert cut > 10


@cocotb.test()
async def frames_without_a_reset_are_as_ever(dut):
    """All widths of the packer's phases, one frame after the other."""
    voxels = scene(6)
    core = await started(dut, voxels)
    for width, pattern in itertools.product((1, 2, 3, 4, 5, 8), ([1], [1, 0], [0, 0, 1])):
        core.ready = itertools.cycle(pattern)
        await core.set_frame(CAMERA, width, 3, 3)
        np.testing.assert_array_equal(await core.trace(width, 3), render(voxels, CAMERA, width, 3, COLOURS)[0])
