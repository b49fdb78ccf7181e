"""The registers against registers.rdl's own map: resets, masks, byte strobes, what cannot be written. The interrupt."""

import random
import re

import cocotb
from cocotb.triggers import ClockCycles, RisingEdge
from cocotbext.axi import AxiResp
from core_driver import CAMERA, scene, started
from run import GENERATED, SEED
from voxrt_registers import MATERIALS, REGISTERS

# control's bits do things when written; the benches of the whole core see to them.
ACTS = {"control"}


def described():
    """Give of each register its fields (low, high, access, reset or None), from the generated table."""
    registers = {}
    for line in (GENERATED / "registers.md").read_text().splitlines():
        if heading := re.match(r"## 0x(\w+) ([\w\[\]]+)$", line):
            fields = registers[heading[2]] = []
        elif row := re.match(r"\| (\d+)(?::(\d+))? \| \w+ \| (\w+) \| (\d*) \|", line):
            high, low, access, reset = row.groups()
            fields.append((int(low or high), int(high), access, int(reset) if reset else None))
    return registers


def mask(fields, *accesses):
    """Give the bits of fields that are accessed so."""
    return sum((1 << (high + 1)) - (1 << low) for low, high, access, _ in fields if access in accesses)


@cocotb.test()
async def the_table_is_the_map(_):
    """Two outputs of one description name the same registers and fields."""
    table = described()
    assert set(table) == set(REGISTERS)
    for name, (_, fields) in REGISTERS.items():
        assert sorted(fields.values()) == sorted((low, high - low + 1) for low, high, _, _ in table[name])


@cocotb.test()
async def resets(dut):
    """All that has a reset value, and all that is reserved, which reads as 0."""
    core = await started(dut)
    for name, fields in described().items():
        value = await core.axi.read_dword(REGISTERS[name][0])
        known = sum((1 << (high + 1)) - (1 << low) for low, high, _, reset in fields if reset is not None)
        assert value & known == sum(reset << low for low, _, _, reset in fields if reset is not None), name
        assert value & ~mask(fields, "r", "rw", "w1c") == 0, name
    assert await core.axi.read_dword(MATERIALS) == 0


@cocotb.test()
async def masks(dut):
    """Change what may be written, in this register alone."""
    core = await started(dut)
    table = {name: fields for name, fields in described().items() if name not in ACTS}
    values = {}
    for name, fields in table.items():
        address, writable = REGISTERS[name][0], mask(fields, "rw")
        before = await core.axi.read_dword(address)
        for pattern in (0xFFFFFFFF, 0, 0xAAAAAAAA, 0x55555555, random.getrandbits(32)):
            await core.axi.write_dword(address, pattern)
            after = await core.axi.read_dword(address)
            assert after & writable == pattern & writable, name
            assert after & ~writable == before & ~writable, name
        values[name] = after & writable
    for name, value in values.items():
        assert await core.axi.read_dword(REGISTERS[name][0]) & mask(table[name], "rw") == value, name


@cocotb.test()
async def strobes(dut):
    """Single bytes and pairs, at every place, change no other byte."""
    core = await started(dut)
    for name, fields in described().items():
        if name in ACTS or not mask(fields, "rw"):
            continue
        address, writable = REGISTERS[name][0], mask(fields, "rw").to_bytes(4, "little")
        await core.axi.write_dword(address, 0)
        expected = [0] * 4
        for place, length in ((0, 1), (3, 1), (1, 1), (2, 1), (0, 2), (2, 2), (1, 2), (0, 3), (1, 3)):
            data = random.randbytes(length)
            await core.axi.write(address + place, data)
            expected[place : place + length] = [
                a & b for a, b in zip(data, writable[place : place + length], strict=True)
            ]
            got = (await core.axi.read(address, 4)).data
            assert [a & b for a, b in zip(got, writable, strict=True)] == expected, name


@cocotb.test()
async def reads_and_writes_overlap(dut):
    """Data may come before their addresses, the next before the last are taken; answers wait for the host."""
    core = await started(dut)
    names = [name for name, fields in described().items() if mask(fields, "rw") == 0xFFFFFFFF and name not in ACTS]
    assert len(names) > 2
    writes, reads = core.axi.write_if, core.axi.read_if
    channels = [writes.aw_channel, writes.w_channel, writes.b_channel, reads.ar_channel, reads.r_channel]
    chance = random.Random(SEED)

    def waits(often):
        while True:
            yield chance.random() < often

    async def use(name):
        for _ in range(40):
            value = chance.getrandbits(32)
            await core.axi.write_dword(REGISTERS[name][0], value)
            assert await core.axi.read_dword(REGISTERS[name][0]) == value, name

    for often in (0.0, 0.5, 0.9):  # the share of clocks in which a channel waits
        for channel in channels:
            channel.set_pause_generator(waits(often))
        for user in [cocotb.start_soon(use(name)) for name in names]:
            await user
    for channel in channels:
        channel.clear_pause_generator()


@cocotb.test()
async def addresses_without_a_register_are_refused(dut):
    """SLVERR, to reads and writes alike; all that the map names answers OKAY, read-only registers to writes too."""
    core = await started(dut)
    mapped = {address for address, _ in REGISTERS.values()} | set(range(MATERIALS, MATERIALS + 1024, 4))
    for address in range(0, 2048, 4):
        expected = AxiResp.OKAY if address in mapped else AxiResp.SLVERR
        assert (await core.axi.read(address, 4)).resp == expected
        if address not in {REGISTERS[name][0] for name in ACTS}:
            assert (await core.axi.write(address, bytes(4))).resp == expected


@cocotb.test()
async def a_reset_brings_the_resets_back(dut):
    """Reset by the pin; a soft reset leaves registers alone."""
    core = await started(dut)
    await core.write("size", width=7, height=9)
    await core.write("control", soft_reset=1)
    assert await core.read("size", "width") == 7
    dut.rst_ni.value = 0
    await ClockCycles(dut.clk_i, 3)
    dut.rst_ni.value = 1
    await ClockCycles(dut.clk_i, 3)
    assert await core.read("size", "width") == 640
    assert await core.read("size", "height") == 480


@cocotb.test()
async def the_interrupt_is_the_status(dut):
    """It rises with the end of a frame, and falls when the bit is cleared; errors raise it as well."""
    voxels = scene(7)
    core = await started(dut, voxels)
    await core.set_frame(CAMERA, 6, 4, 3)
    await core.write("status", frame_done=1)
    assert not int(dut.interrupt_o.value)
    await core.write("control", start=1)
    while not int(dut.interrupt_o.value):
        await RisingEdge(dut.clk_i)
    assert await core.read("status", "frame_done")
    assert not await core.read("status", "busy")
    await core.write("status", frame_done=1)
    await ClockCycles(dut.clk_i, 2)
    assert not int(dut.interrupt_o.value)
    # A pointer out of the memory.
    await core.load([7])
    await core.write("control", start=1)
    await core.wait()
    await core.write("status", frame_done=1)
    await ClockCycles(dut.clk_i, 2)
    assert int(dut.interrupt_o.value)
    assert await core.read("status", "bad_pointer")
    low, _ = REGISTERS["status"][1]["bad_pointer"]
    await core.axi.write_dword(REGISTERS["status"][0], 1 << low)
    await ClockCycles(dut.clk_i, 2)
    assert not int(dut.interrupt_o.value)
