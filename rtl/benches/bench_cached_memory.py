"""voxrt_cached_memory, with caches of a few lines: at any pace of the external memory, lanes get the words there.

Lanes ask as rays do: for a word until it comes, in a ring of slots.
"""

import random

import cocotb
from axi_memory import DECERR, SLVERR, AxiMemory, StructPort
from bench_on_chip_memory import encoded, kept, some_word
from cocotb.triggers import ReadOnly, RisingEdge
from streams import drive, start

BLOCK_BITS, CLOCKS, SLOTS = 6, 5, 15
BLOCKS = 1 << BLOCK_BITS
ERROR = encoded(0x7FFFFFFF)


class Memory:
    """The memory, the external one behind it, and lanes before it."""

    def __init__(self, dut):
        self.dut = dut
        self.lanes = len(dut.read_i)
        ports = [StructPort(dut.axi_o[p], dut.axi_i[p]) for p in range(2)]
        self.base = random.randrange(1 << 26) << 5
        self.bus = AxiMemory(ports, random.Random(random.randrange(1 << 30)), self.base)
        self.fill()
        self.requests = [[None] * SLOTS for _ in range(self.lanes)]  # By slot: the address that a ray waits for.
        self.clock_number = 0
        self.got = 0
        self.answers = []
        self.counts = [0, 0, 0]  # Questions, those for lines, lines from the bus.

    def fill(self):
        self.bus.words = [some_word() for _ in range(1 + 8 * BLOCKS)]

    async def begin(self):
        await start(self.dut, read_i=0, start_i=0, flush_i=0, base_i=self.base, bus_rst_ni=0)
        self.dut.bus_rst_ni.value = 1
        self.dut.rst_ni.value = 1

    async def clock(self):
        """Let a clock pass; the bus and the answers are seen at its edge."""
        self.bus.drive()
        await ReadOnly()
        self.bus.edge()
        self.ready = int(self.dut.ready_o.value)
        self.acks = self.dut.ack_o.value.to_unsigned()
        self.words = [self.dut.word_o[i].value.to_unsigned() for i in range(self.lanes)]
        events = self.dut.events_o.value.to_unsigned()
        self.faults = events >> 17
        self.counts = [count + more for count, more in zip(self.counts, counts_of(events), strict=True)]
        await RisingEdge(self.dut.clk_i)
        self.clock_number += 1

    async def frame(self):
        """Start a frame; wait until its root may be read."""
        drive(self.dut, start_i=1)
        await self.clock()
        drive(self.dut, start_i=0)
        for _ in range(3000):
            if self.ready:
                return
            await self.clock()
        raise AssertionError("the frame never begins")

    async def read(self, clocks, *, hot=4, check=True, stop=False):
        """Let the rays of all lanes read, most of them few blocks; give how many words came."""
        history, got = [], 0
        for clock in range(clocks + CLOCKS + 1):
            slot = self.clock_number % SLOTS
            addresses, reads = [], 0
            for lane in range(self.lanes):
                waits = self.requests[lane][slot]
                if waits is None and clock < clocks and not stop:
                    block = random.choice([-1, *range(hot), random.randrange(BLOCKS)])
                    waits = (block, 7 if block < 0 else random.randrange(8))
                if clock >= clocks:
                    waits = None
                else:
                    self.requests[lane][slot] = waits
                addresses.append(0 if waits is None else (waits[0] % (2 * BLOCKS)) << 3 | waits[1])
                reads |= (waits is not None) << lane
            drive(self.dut, read_i=reads, address_i=addresses)
            history.append(
                (slot, [self.requests[lane][slot] if reads >> lane & 1 else None for lane in range(self.lanes)])
            )
            await self.clock()
            if len(history) > CLOCKS:
                then, requests = history.pop(0)
                for lane, place in enumerate(requests):
                    if self.acks >> lane & 1:
                        assert place is not None, "an answer that nobody asked for"
                        word = encoded(kept_here(self.bus.words[1 + 8 * place[0] + place[1]]))
                        if check:
                            assert self.words[lane] == word
                        else:
                            assert self.words[lane] in (word, ERROR)
                        self.requests[lane][then] = None
                        got += 1
        drive(self.dut, read_i=0)
        return got

    async def ask(self, lane, block):
        """Let one ray read once; tell whether its word came, within the turn of its slot."""
        octant = random.randrange(8)
        addresses = [block << 3 | octant] * self.lanes
        drive(self.dut, read_i=1 << lane, address_i=addresses)
        await self.clock()
        drive(self.dut, read_i=0)
        for _ in range(CLOCKS):
            await self.clock()
        came = bool(self.acks)
        assert not came or self.words[lane] == encoded(kept(self.bus.words[1 + 8 * block + octant]))
        for _ in range(SLOTS - CLOCKS - 1):
            await self.clock()
        return came

    async def drain(self, limit=40000, *, check=True):
        for _ in range(limit // 60):
            if all(place is None for lane in self.requests for place in lane):
                return
            await self.read(60, stop=True, check=check)
        raise AssertionError("a ray waits for ever")


class SharedLines:
    """The L2 as lanes see it that ask one after the other."""

    def __init__(self, sets):
        self.ways = [[None] * 4 for _ in range(sets)]
        self.used = [[0] * 3 for _ in range(sets)]  # The half used last, and the way used last of each half.

    def holds(self, line):
        """Look a line up, which takes an empty way or one not used lately; tell whether it was there."""
        ways, used = self.ways[line % len(self.ways)], self.used[line % len(self.ways)]
        was_there = line in ways
        if was_there or None in ways:
            way = ways.index(line if was_there else None)
        else:
            way = 2 * (1 - used[0]) + 1 - used[2 - used[0]]
        ways[way] = line
        used[0], used[1 + way // 2] = way // 2, way % 2
        return was_there


def counts_of(events):
    return events >> 9 & 0xFF, events >> 1 & 0xFF, events & 1


def kept_here(word):
    """Give a word as lanes read it; the bench on chip has as many blocks."""
    return kept(word)


@cocotb.test()
@cocotb.parametrize(
    (("latency", "jitter", "stalls"), [(1, 0, 0.0), (3, 9, 0.3), (50, 0, 0.0), (200, 40, 0.1), (10, 200, 0.5)])
)
async def every_ray_gets_its_word(dut, latency, jitter, stalls):
    """At any latency, jitter and back-pressure; from hot blocks that all want, and from cold ones."""
    memory = Memory(dut)
    memory.bus.latency, memory.bus.jitter, memory.bus.stalls = latency, jitter, stalls
    await memory.begin()
    await memory.frame()
    assert await memory.read(1500) > 0
    await memory.drain()


@cocotb.test()
async def a_flush_at_any_clock_shows_the_next_frame_what_was_written(dut):
    """And never disturbs the frame that is traced, as the memory is written between frames."""
    memory = Memory(dut)
    memory.bus.latency, memory.bus.jitter = 8, 20
    await memory.begin()
    for _ in range(8):
        await memory.frame()
        await memory.read(random.randrange(1, 200))
        drive(dut, flush_i=1)
        await memory.read(1)
        drive(dut, flush_i=0)
        await memory.read(random.randrange(1, 100))
        await memory.drain()
        memory.fill()


@cocotb.test()
async def without_a_flush_lines_stay(dut):
    """Read no line in the second frame of the same few blocks."""
    memory = Memory(dut)
    memory.bus.words[1:9] = [0xFFFFFF07] * 8  # A pointer would be followed.
    await memory.begin()
    await memory.frame()
    for _ in range(2):
        before = len(memory.bus.addresses)
        memory.requests = [[(0, slot % 8) for slot in range(SLOTS)] for _ in range(memory.lanes)]
        await memory.drain()
        lines = len(memory.bus.addresses) - before
        await memory.frame()
    assert lines == 0


@cocotb.test()
async def a_frame_begins_when_all_lines_have_come(dut):
    """Start it, after a flush or without, while lines are under way that no lane waits for any more."""
    memory = Memory(dut)
    memory.bus.latency, memory.bus.jitter = 10, 10
    await memory.begin()
    for number in range(24):
        await memory.frame()
        await memory.read(random.randrange(1, 60))
        memory.requests = [[None] * SLOTS for _ in range(memory.lanes)]
        drive(dut, flush_i=number % 4 > 0)
        await memory.read(random.randrange(1, 12), stop=True)
        drive(dut, flush_i=0)
        await memory.frame()
        assert not any(memory.bus.lines)
        if number % 4:
            memory.fill()
        await memory.read(40)
        await memory.drain()


@cocotb.test()
async def a_line_is_read_from_the_bus_once(dut):
    """Lanes ask for the same few lines, one after the other; the bus is asked for those, in this order."""
    memory = Memory(dut)
    await memory.begin()
    await memory.frame()
    wanted = []
    for block in random.sample(range(1, BLOCKS), 8):
        wanted.append(memory.base + 32 * (block + 1))
        for lane in random.sample(range(memory.lanes), memory.lanes):
            while not await memory.ask(lane, block):
                assert len(memory.bus.addresses) <= len(wanted)
            assert memory.bus.addresses == wanted


@cocotb.test()
async def lines_of_a_set_are_read_while_one_comes(dut):
    """Answer at once for the lines that stay, whichever way of the set the line that comes is to take."""
    memory = Memory(dut)
    memory.bus.latency = 80
    await memory.begin()
    await memory.frame()
    for lane in range(memory.lanes):
        ways = []
        for block in range(20 * lane, 20 * lane + 18, 2):  # of one set; none of another lane
            assert not await memory.ask(lane, block)
            ways = ways[-3:]
            for other in ways:
                assert await memory.ask(lane, other)
            while not await memory.ask(lane, block):
                pass
            ways.append(block)


@cocotb.test()
async def the_least_recently_used_line_goes(dut):
    """Answer a lane at its first question while its line is one of the last four of the set; the L2 has its own."""
    memory = Memory(dut)
    await memory.begin()
    await memory.frame()
    memory.counts, addresses, shared = [0, 0, 0], [], SharedLines(1 << int(dut.L2SetBits.value))
    total = misses = 0
    used = [[[], []] for _ in range(memory.lanes)]
    for _ in range(400):
        lane, block = random.randrange(memory.lanes), random.choice([random.randrange(12), random.randrange(30)])
        recent, questions = used[lane][block % 2], 1
        while not await memory.ask(lane, block):
            questions += 1
            assert questions < 100
        assert (questions == 1) == (block in recent)
        if questions > 1 and not shared.holds(block):
            addresses.append(memory.base + 32 * (block + 1))
        assert memory.bus.addresses == addresses
        total, misses = total + questions, misses + (questions > 1)
        if block in recent:
            recent.remove(block)
        recent.append(block)
        del recent[:-4]
    assert memory.counts == [total, misses, len(addresses)]


@cocotb.test()
async def reset_at_any_clock(dut):
    """Drop what the bus still owes; the frame after it is right."""
    memory = Memory(dut)
    memory.bus.latency, memory.bus.jitter = 20, 60
    await memory.begin()
    for _ in range(10):
        await memory.frame()
        await memory.read(random.randrange(1, 150))
        memory.requests = [[None] * SLOTS for _ in range(memory.lanes)]
        drive(dut, rst_ni=0, read_i=0)
        await memory.clock()
        drive(dut, rst_ni=1)
        memory.fill()
        await memory.frame()
        await memory.read(200)
        await memory.drain()


@cocotb.test()
@cocotb.parametrize(response=[SLVERR, DECERR])
async def an_error_ends_the_frame(dut, response):
    """All rays get words soon, errors where the bus was needed; the next frame is right."""
    memory = Memory(dut)
    memory.bus.latency = 10
    await memory.begin()
    for _ in range(4):
        await memory.frame()
        await memory.read(random.randrange(60))
        memory.bus.response = response
        await memory.read(60, check=False)
        await memory.drain(1200, check=False)
        memory.bus.response = 0
        await memory.frame()
        await memory.read(200)
        await memory.drain()


@cocotb.test()
async def silence_ends_the_frame(dut):
    """After the clocks that the bus may take; and when it speaks again, the next frame is right."""
    memory = Memory(dut)
    memory.bus.latency = 10
    await memory.begin()
    patience = 1 << int(dut.TimeoutBits.value)
    for _ in range(3):
        await memory.frame()
        await memory.read(40)
        memory.bus.silent = True
        await memory.read(patience + 200, check=False)
        await memory.drain(1200, check=False)
        memory.bus.silent = False
        await memory.frame()
        await memory.read(200)
        await memory.drain()
