"""voxrt_root: the word at any address, from a memory that refuses as it likes; a leaf with an error beyond it."""

import random
from collections import deque

import cocotb
from cocotb.triggers import ClockCycles, RisingEdge
from streams import drive, reset, start

BLOCK_BITS = 6
WORDS = 1 + (8 << BLOCK_BITS)
LEAF, ERROR = 1 << 9, 1 << 8
ADDRESSES = {
    "word_0": lambda: 0,
    "in_memory": lambda: random.choice([1, 2, WORDS - 1, random.randrange(1, WORDS)]),
    "beyond": lambda: random.choice([WORDS, WORDS + 1, 2 * WORDS - 1, (1 << 32) - 1, random.randrange(WORDS, 1 << 32)]),
}
REFUSALS = {"refuses": ["never", "at_random", "for_long"]}


class Memory:
    """Lane 0's port. Words that were not asked for may be anything."""

    def __init__(self, dut, refuses):
        self.dut = dut
        self.words = [random.randrange(1 << 10) for _ in range(WORDS)]
        self.likely = {"never": 0, "at_random": 0.5, "for_long": 0.9}[refuses]
        self.addresses = deque([None] * (int(dut.MemoryClocks.value) - 1))
        self.refused = self.answered = 0

    async def clock(self):
        """Pass a clock: take the address, give the answer to one of before."""
        dut = self.dut
        await RisingEdge(dut.clk_i)
        asks = int(dut.read_o.value)
        self.addresses.append(1 + dut.read_address_o.value.to_unsigned() if asks else None)
        address = self.addresses.popleft()
        gives = random.randrange(2) if address is None else random.random() >= self.likely
        if address is not None:
            self.answered += gives
            self.refused += not gives
        word = self.words[address] if gives and address is not None else random.randrange(1 << 10)
        drive(dut, ack_i=gives, word_i=word)


async def ask(dut, memory, address):
    """Start a search: the inputs count at that clock alone. Give word 0 of that clock."""
    first = random.randrange(1 << 10)
    drive(dut, start_i=1, address_i=address, first_word_i=first)
    await memory.clock()
    drive(dut, start_i=0, address_i=random.randrange(1 << 32), first_word_i=random.randrange(1 << 10))
    return first


async def find(dut, memory, address):
    """Search, and compare; the root stays as it is until the next search."""
    memory.refused = memory.answered = 0
    wanted = await ask(dut, memory, address)
    if address >= WORDS:
        wanted = LEAF | ERROR
    elif address:
        wanted = memory.words[address]
    for _ in range(1000):
        await memory.clock()
        if int(dut.valid_o.value):
            break
    else:
        raise AssertionError("the root was never found")
    assert memory.answered == (0 < address < WORDS)
    assert memory.answered or not memory.refused
    for _ in range(random.randrange(1, 10)):
        assert dut.root_o.value.to_unsigned() == wanted
        await memory.clock()
        assert not int(dut.valid_o.value)
        assert not int(dut.read_o.value)


async def begin(dut, refuses):
    await start(dut, start_i=0, address_i=0, first_word_i=0, ack_i=0, word_i=0)
    return Memory(dut, refuses)


@cocotb.test()
@cocotb.parametrize(where=list(ADDRESSES), **REFUSALS)
async def roots(dut, where, refuses):
    memory = await begin(dut, refuses)
    for _ in range(60):
        await find(dut, memory, ADDRESSES[where]())


@cocotb.test()
async def every_address(dut):
    memory = await begin(dut, "at_random")
    for address in range(WORDS + 8):
        await find(dut, memory, address)


@cocotb.test()
async def reset_at_any_clock(dut):
    """Drop a search: it is never done, nor does its answer show in the next one."""
    memory = await begin(dut, "at_random")
    for _ in range(40):
        await ask(dut, memory, ADDRESSES["in_memory"]())
        for _ in range(random.randrange(12)):
            await memory.clock()
        await reset(dut, 1)
        drive(dut, ack_i=1)
        for _ in range(random.randrange(8)):
            await ClockCycles(dut.clk_i, 1)
            assert not int(dut.valid_o.value)
            assert not int(dut.read_o.value)
        memory.addresses = deque([None] * len(memory.addresses))
        await find(dut, memory, ADDRESSES[random.choice(list(ADDRESSES))]())
