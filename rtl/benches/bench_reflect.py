"""voxrt_reflect against lists of the mirrors that each ray has met: a ring of rays, of which one is at stage 9."""

import random
from itertools import count

import cocotb
from cocotb.triggers import RisingEdge
from streams import drive, pace, start_clock
from structs import MATERIAL_WRITE

SLOTS = 12
TABLE_STAGE, SUM_STAGE, TURN_STAGE = 3, 7, 9


def some_entry():
    """Make an entry of the material table: whether it is a mirror, and its colour."""
    return random.random() < 0.9, tuple(random.choice([0, 255, random.randrange(256)]) for _ in range(3))


class Ring:
    """The lane around it. A ray is the list of mirrors that it has met; a slot may be without one."""

    def __init__(self, dut):
        self.dut = dut
        self.table = {}
        self.rays = [None] * SLOTS
        self.entries = [None] * SLOTS  # Looked up for stage 9.
        self.clocks = count()
        self.ended = self.reflected = 0

    def write_table(self, material, row):
        """Set the inputs that write a row, and give what else is to be done once the clock has passed."""
        mirror, (red, green, blue) = row
        fields = {"mirror": mirror, "red": red, "green": green, "blue": blue}
        drive(self.dut, material_write_i=MATERIAL_WRITE.pack(valid=1, material=material, **fields))
        return {material: row}

    async def fill_table(self):
        for material in range(256):
            written = self.write_table(material, some_entry())
            await self.clock(0, {}, busy=False)
            self.table |= written

    async def clock(self, bounces, written, *, busy=True):
        """Pass a clock: look a material up for one ray, tell what becomes of another."""
        dut, now = self.dut, next(self.clocks)
        slots = {stage: (now - stage) % SLOTS for stage in (TABLE_STAGE, SUM_STAGE, TURN_STAGE)}
        own, looking = slots[TURN_STAGE], slots[TABLE_STAGE]
        ray = self.rays[own]
        hits = busy and ray is not None and self.entries[own] is not None and random.random() < 0.9
        material = random.randrange(256)
        mirror, colour = self.entries[own] or (False, None)
        reflects = ends = False
        if hits and mirror and bounces:
            ray.append(colour)
            ends = len(ray) > bounces
            reflects = not ends
        issues = busy and not reflects and (ray is None or hits) and random.random() < 0.8
        drive(dut, bounces_i=bounces, material_i=material, slot7_i=slots[SUM_STAGE], slot9_i=own)
        drive(dut, hit_i=hits, issues_i=issues)
        await RisingEdge(dut.clk_i)
        assert int(dut.reflects_o.value) == reflects
        assert int(dut.ends_o.value) == ends
        if ends:
            met = dut.mirrors_o.value.to_unsigned()
            assert met % 32 == len(ray) == bounces + 1
            sums = [met >> 5 + 12 * channel & 0xFFF for channel in range(3)]
            assert sums == [sum(channel) for channel in zip(*ray, strict=True)]
        if issues or (hits and not reflects):
            self.rays[own] = [] if issues else None
        self.entries[looking] = self.table.get(material)
        self.table |= written
        self.ended += ends
        self.reflected += reflects

    async def frame(self, bounces, clocks, writing):
        """Hold the limit for so many clocks, while the table is written or not; then let all rays go."""
        writes = pace(writing) if writing else iter(int, 1)
        for _ in range(clocks):
            drive(self.dut, material_write_i=0)
            writing = next(writes)
            await self.clock(bounces, self.write_table(random.randrange(256), some_entry()) if writing else {})
        drive(self.dut, material_write_i=0)
        self.rays = [None] * SLOTS


async def prepare(dut):
    drive(dut, material_write_i=0, hit_i=0, issues_i=0)
    start_clock(dut)
    await RisingEdge(dut.clk_i)
    ring = Ring(dut)
    await ring.fill_table()
    return ring


@cocotb.test()
@cocotb.parametrize(bounces=list(range(16)))
async def limits(dut, bounces):
    """Rays are reflected as often as the frame allows, and then show the sum of all mirrors that they met."""
    ring = await prepare(dut)
    await ring.frame(bounces, 3000, None)
    assert (ring.ended > 5) == (ring.reflected > 100) == (bounces > 0)


@cocotb.test()
@cocotb.parametrize(writing=["always", "random"])
async def the_table_is_written(dut, writing):
    """Take a row as it was when it was looked up, also at the clock in which it is written."""
    ring = await prepare(dut)
    for bounces in (3, 15, 0, 1):
        await ring.frame(bounces, 1000, writing)


@cocotb.test()
async def brightest_mirrors(dut):
    ring = await prepare(dut)
    for material in range(256):
        written = ring.write_table(material, (True, (255, 255, 255)))
        await ring.clock(15, written, busy=False)
    await ring.frame(15, 5000, None)
    assert ring.ended
