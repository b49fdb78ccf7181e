"""voxrt_lane alone: rays of rays.py, a memory that answers or not, pixels against the oracle's walk."""

import random

import cocotb
import numpy as np
from cocotb.triggers import ClockCycles, RisingEdge
from oracles.memory import words_of
from oracles.ray import FACE_NONE, trace
from rays import ray_of, some_direction
from streams import PACES, drive, pace, reset, send, start

LEAF, DEPTH, ROWS = 1 << 9, 3, 32
SIDE = 1 << DEPTH


def encoded(word):
    """Give a word as lanes read it."""
    return LEAF | word & 0xFF if word >> 31 else word >> 3


class Surroundings:
    """Memory, pixel buffer and free rows of the lane."""

    def __init__(self, dut, words, taking):
        self.dut = dut
        self.words = [encoded(int(word)) for word in words]
        self.acknowledges, self.has_place = pace(taking), pace(taking)
        self.taken = 0
        self.pixels = {}
        self.errors = 0
        self.free_rows = list(range(ROWS))

    async def run(self):
        """Serve for ever."""
        dut = self.dut
        asked = None
        while True:
            drive(dut, take_ready_i=next(self.has_place), take_tag_i=self.taken % 256)
            await RisingEdge(dut.clk_i)
            if int(dut.take_o.value):
                assert int(dut.take_ready_i.value)
                assert self.taken not in self.pixels
                self.pixels[self.taken] = None
                self.taken += 1
            if int(dut.fill_o.value):
                tag = dut.fill_tag_o.value.to_unsigned()
                assert int(dut.store_o.value)
                assert self.pixels[tag] is None, "filled twice"
                pixel = dut.store_pixel_o.value.to_unsigned()
                self.pixels[tag] = (pixel >> 2, pixel & 3)
            if int(dut.releases_o.value):
                row = dut.released_row_o.value.to_unsigned()
                assert row not in self.free_rows, "released twice"
                self.free_rows.append(row)
            self.errors += int(dut.bad_pointer_o.value) + int(dut.step_limit_o.value)
            answer = None if asked is None or not next(self.acknowledges) else asked
            drive(dut, mem_ack_i=answer is not None, mem_word_i=random.randrange(1 << 10) if answer is None else answer)
            asked = None
            if int(dut.mem_read_o.value):
                asked = self.words[1 + 8 * dut.mem_block_o.value.to_unsigned() + dut.mem_octant_o.value.to_unsigned()]


def inputs(ray, row):
    """Give a ray as the lane takes it, which comes when it is offered."""
    return {
        "arrives_i": 1,
        "arrival_row_i": row,
        "arrival_weight_i": [weight % (1 << 40) for weight in ray.weight],
        "ray_row_i": row,
        "ray_resolved_i": ray.resolved,
        "ray_pixel_i": FACE_NONE,
        "ray_mirrored_i": ray.mirrored,
        "ray_dead_i": ray.dead,
        "ray_octant_i": ray.octant,
        "ray_entry_time_i": ray.entry_time % KEY,
        "ray_entry_face_i": ray.entry_face,
    }


KEY = 1 << (40 + 6 + 4 + 1)


async def frame(dut, count, sending, taking):
    """Trace rays from one position, and compare."""
    voxels = np.random.default_rng(random.randrange(1 << 30)).choice([0, 0, 0, 0, 5, 255], (SIDE,) * 3).astype(np.uint8)
    words = words_of(voxels)
    position = [random.choice([16 * random.randint(-4, 12), random.randint(-50, 178)]) for _ in range(3)]
    directions = [some_direction() for _ in range(count)]
    rays = [ray_of(position, direction, SIDE) for direction in directions]
    drive(dut, world_i=SIDE, beyond_i=(1 << 6) - SIDE, root_i=encoded(int(words[0])))
    drive(dut, origin_i=position, mirrored_origin_i=[16 * SIDE - place for place in position])
    surroundings = Surroundings(dut, words, taking)
    runner = cocotb.start_soon(surroundings.run())
    try:
        free_rows = surroundings.free_rows
        offers = (inputs(ray, free_rows.pop(random.randrange(len(free_rows)))) for ray in rays)
        await send(dut, offers, sending, valid="ray_valid_i", ready="ray_ready_o")
        for _ in range(200):
            if surroundings.taken == count and None not in surroundings.pixels.values():
                break
            await ClockCycles(dut.clk_i, 50)
    finally:
        runner.cancel()
    for tag, (ray, direction) in enumerate(zip(rays, directions, strict=True)):
        wanted = (0, FACE_NONE) if ray.overflow else trace(voxels, position, direction)
        assert surroundings.pixels[tag] == wanted, (position, direction)
    assert not surroundings.errors
    assert len(free_rows) == ROWS


async def begin(dut):
    """Start with nothing to do."""
    await start(
        dut, ray_valid_i=0, ray_shadow_i=0, mem_ack_i=0, take_ready_i=0, request_ready_i=0, light_i=0, bounces_i=0
    )


@cocotb.test()
@cocotb.parametrize(**PACES)
async def pixels(dut, sending, taking):
    """Random worlds and troublesome rays; words that do not come, pixel buffers that are full."""
    await begin(dut)
    for _ in range(8):
        await frame(dut, 60, sending, taking)


@cocotb.test()
async def reset_at_any_clock(dut):
    """Drop all rays."""
    await begin(dut)
    for _ in range(8):
        running = cocotb.start_soon(frame(dut, 60, "random", "random"))
        await ClockCycles(dut.clk_i, random.randrange(1, 400))
        running.cancel()
        drive(dut, ray_valid_i=0, mem_ack_i=0, take_ready_i=0)
        await reset(dut)
        await ClockCycles(dut.clk_i, 3)
        assert not int(dut.mem_read_o.value)
        assert not int(dut.fill_o.value)
        await frame(dut, 30, "random", "random")
