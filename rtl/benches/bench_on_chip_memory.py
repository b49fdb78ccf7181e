"""voxrt_on_chip_memory: what the processor writes is what it and all lanes read, however many want the same bank."""

import random

import cocotb
from cocotb.triggers import ClockCycles, RisingEdge
from streams import drive, pace, reset, start

BLOCK_BITS, REFUSED = 6, 0x7FFFFFFF
WORDS = 1 + (8 << BLOCK_BITS)
LEAF, ERROR = 1 << 9, 1 << 8


def some_word():
    """Make a word: leaves, pointers, and pointers that are wrong."""
    block = random.randrange(1 << BLOCK_BITS)
    return random.choice(
        [
            0xFFFFFF00 | random.randrange(256),
            1 + 8 * block,
            1 + 8 * block,
            2 + 8 * block,
            1 + (8 << BLOCK_BITS),
            1 + 8 * block | 1 << random.randrange(3 + BLOCK_BITS, 31),
            REFUSED,
        ]
    )


def kept(word):
    """Give a word as it is read back: pointers out of the memory or into the middle of a block are refused."""
    return word if word >> 31 or (word % 8 == 1 and word < WORDS) else REFUSED


def encoded(word):
    """Give a word that was kept, as lanes read it."""
    if word == REFUSED:
        return LEAF | ERROR
    return LEAF | word & 0xFF if word >> 31 else word >> 3


class Memory:
    def __init__(self, dut):
        self.dut = dut
        self.lanes = len(dut.read_i)
        self.clocks = 5 if int(dut.Banked.value) else 2
        self.words = {}

    async def begin(self):
        await start(self.dut, access_i=0, access_write_i=0, access_address_i=0, read_i=0)
        await self.write(range(WORDS))

    async def write(self, addresses):
        for address in addresses:
            word = some_word()
            drive(self.dut, access_i=1, access_write_i=1, access_address_i=address, access_word_i=word)
            self.words[address] = kept(word)
            await RisingEdge(self.dut.clk_i)
        drive(self.dut, access_i=0, access_write_i=0)
        await ClockCycles(self.dut.clk_i, 6)

    async def read(self, clocks, lanes, port, *, writes=False):
        """Let lanes read, and the processor's port: each at any clock, or all the time.

        With `writes` the port writes now and then: who asks two clocks later reads it, who asks before does not. For
        the port has a register: it accesses the memory a clock later, at the clock of `before`.
        """
        dut, requests, answered, before = self.dut, [], 0, (None, False, 0)
        wants, accesses = pace(lanes), pace(port)
        hot = random.randrange(1 << BLOCK_BITS)
        for clock in range(clocks):
            reads = [next(wants) for _ in range(self.lanes)]
            blocks = [random.choice([hot, random.randrange(1 << BLOCK_BITS)]) for _ in reads]
            octants = [random.randrange(8) for _ in reads]
            address = random.choice([0, random.randrange(WORDS)]) if next(accesses) else None
            addresses = [8 * block + octant for block, octant in zip(blocks, octants, strict=True)]
            drive(dut, read_i=sum(bit << lane for lane, bit in enumerate(reads)), address_i=addresses)
            is_write = writes and bool(address) and random.random() < 0.5
            word = some_word()
            drive(dut, access_i=address is not None, access_write_i=is_write, access_address_i=address or 0)
            drive(dut, access_word_i=word)
            await RisingEdge(dut.clk_i)
            if clock >= self.clocks:
                answered += self.check(*requests.pop(0))
            wanted = [self.words[1 + a] if bit else None for a, bit in zip(addresses, reads, strict=True)]
            accessed, written, value = before
            read = None if accessed is None or written else self.words[accessed]
            requests.append((wanted, read, accessed is not None))
            if written:
                self.words[accessed] = kept(value)
            before = address, is_write, word
        drive(dut, read_i=0, access_i=0)
        accessed, written, value = before
        if written:
            self.words[accessed] = kept(value)
        return answered

    def check(self, wanted, read, accessed):
        """Compare the answers to what was asked `clocks` ago; give how many lanes got theirs."""
        dut = self.dut
        assert dut.first_word_o.value.to_unsigned() == encoded(self.words[0])
        assert int(dut.access_valid_o.value) == (read is not None)
        if read is not None:
            assert dut.access_word_o.value.to_unsigned() == read
        acknowledged = dut.ack_o.value.to_unsigned()
        for lane, word in enumerate(wanted):
            if acknowledged >> lane & 1:
                assert word is not None
                assert dut.word_o[lane].value.to_unsigned() == encoded(word)
        if not accessed and self.clocks == 2:
            assert acknowledged == sum((word is not None) << lane for lane, word in enumerate(wanted))
        assert any(word is not None for word in wanted) <= (acknowledged != 0 or accessed)
        return acknowledged.bit_count()


@cocotb.test()
@cocotb.parametrize(lanes=["always", "random"], port=["always", "random"])
async def all_read_what_was_written(dut, lanes, port):
    """Every lane gets a word sooner or later; each word it gets is right."""
    memory = Memory(dut)
    await memory.begin()
    for _ in range(5):
        await memory.write([0, *random.sample(range(1, WORDS), 100)])
        assert await memory.read(300, lanes, port) > 200


@cocotb.test()
async def lanes_read_while_words_are_written(dut):
    """Give a lane the word of the time when it asked, or none."""
    memory = Memory(dut)
    await memory.begin()
    assert await memory.read(3000, "random", "random", writes=True) > 2000


@cocotb.test()
async def words_beyond_the_memory_are_dropped(dut):
    """Write past the end, and read all again."""
    memory = Memory(dut)
    await memory.begin()
    for address in (WORDS, WORDS + 7, 1 << 20, (1 << 32) - 1):
        drive(dut, access_i=1, access_write_i=1, access_address_i=address, access_word_i=0xFFFFFF33)
        await RisingEdge(dut.clk_i)
    drive(dut, access_i=0, access_write_i=0)
    await ClockCycles(dut.clk_i, 6)
    await memory.read(500, "random", "random")


@cocotb.test()
async def reset_at_any_clock(dut):
    """No answer to a question of before the reset; what was written stays."""
    memory = Memory(dut)
    await memory.begin()
    for _ in range(10):
        await memory.read(random.randrange(1, 30), "random", "random")
        await reset(dut, 1)
        for _ in range(memory.clocks + 1):
            await RisingEdge(dut.clk_i)
            assert not int(dut.access_valid_o.value)
            assert not int(dut.ack_o.value)
        await memory.read(100, "random", "random")
        await ClockCycles(dut.clk_i, memory.clocks + 1)  # The next questions are not to meet these answers.


@cocotb.test()
@cocotb.parametrize(writes=[False, True])
async def no_lane_starves(dut, writes):
    """All lanes ask at every clock, and the processor too: each slot of a ring of rays is served often enough."""
    memory = Memory(dut)
    await memory.begin()
    ring, laps = 10 + memory.clocks, 40
    served = [[0] * ring for _ in range(memory.lanes)]
    drive(dut, read_i=(1 << memory.lanes) - 1, access_i=1, access_write_i=writes)
    for clock in range(ring * laps):
        address = random.randrange(1, WORDS)
        word = memory.words[address]
        drive(dut, access_address_i=address, access_word_i=word)
        drive(dut, address_i=[random.randrange(8 << BLOCK_BITS) for _ in range(memory.lanes)])
        await RisingEdge(dut.clk_i)
        acknowledged = dut.ack_o.value.to_unsigned()
        for lane in range(memory.lanes):
            served[lane][clock % ring] += acknowledged >> lane & 1
    drive(dut, read_i=0, access_i=0, access_write_i=0)
    # Banks have conflicts of their own.
    least = laps // 2 - 2 if memory.clocks == 2 else laps // 8
    assert min(map(min, served)) >= least, served


@cocotb.test()
async def a_reset_loses_no_word(dut):
    """Write through a reset of one clock, and read all again."""
    memory = Memory(dut)
    await memory.begin()
    for number, address in enumerate(random.sample(range(WORDS), 60)):
        dut.rst_ni.value = number % 7 != 3
        word = some_word()
        drive(dut, access_i=1, access_write_i=1, access_address_i=address, access_word_i=word)
        memory.words[address] = kept(word)
        await RisingEdge(dut.clk_i)
    dut.rst_ni.value = 1
    drive(dut, access_i=0, access_write_i=0)
    await ClockCycles(dut.clk_i, 6)
    await memory.read(2000, "random", "random")
