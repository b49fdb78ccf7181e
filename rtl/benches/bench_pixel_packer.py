"""voxrt_pixel_packer into an AXI4-Stream sink of cocotbext-axi."""

import random

import cocotb
from cocotb.triggers import ClockCycles, with_timeout
from cocotbext.axi import AxiStreamBus, AxiStreamSink
from streams import PACES, cancel, drive, pace, reset, send, start


def sink_of(dut, taking):
    """Take lines; a frame of the sink is a line, as tlast ends it."""
    bus = AxiStreamBus.from_prefix(dut, "m_axis")
    sink = AxiStreamSink(bus, dut.clk_i, dut.rst_ni, reset_active_level=False)
    sink.log.setLevel("WARNING")
    sink.set_pause_generator(not there for there in pace(taking))
    return sink


def frame(width, height):
    """Make the packer's input and the bytes that shall come, line by line."""
    colours = [[random.randbytes(3) for _ in range(width)] for _ in range(height)]
    items = [
        {"colour_i": int.from_bytes(colour, "big"), "first_i": row == column == 0, "line_end_i": column == width - 1}
        for row, line in enumerate(colours)
        for column, colour in enumerate(line)
    ]
    return items, [b"".join(bytes([green, blue, red]) for red, green, blue in line) for line in colours]


async def lines_of(sink, count):
    """Give the bytes of lines, and whether each began a frame."""
    lines = []
    for _ in range(count):
        line = await with_timeout(sink.recv(compact=False), 1, "ms")
        data = bytes(byte for byte, kept in zip(line.tdata, line.tkeep, strict=True) if kept)
        assert list(line.tkeep) == [1] * len(data) + [0] * (-len(data) % 4)
        first, *others = line.tuser[::4] if isinstance(line.tuser, list) else [line.tuser]
        assert not any(others)
        lines.append((data, bool(first)))
    return lines


@cocotb.test()
@cocotb.parametrize(**PACES)
async def bytes_in_order(dut, sending, taking):
    await start(dut, valid_i=0)
    sink = sink_of(dut, taking)
    for width in range(1, 14):
        items, lines = frame(width, 3)
        sender = cocotb.start_soon(send(dut, items, sending))
        expected = [(line, row == 0) for row, line in enumerate(lines)]
        assert await lines_of(sink, 3) == expected
        await sender
    assert sink.empty()


@cocotb.test()
async def reset_at_any_clock(dut):
    """In the middle of a line; the next frame is whole."""
    await start(dut, valid_i=0)
    sink = sink_of(dut, "random")
    for width in range(1, 14):
        items, lines = frame(width, 4)
        sender = cocotb.start_soon(send(dut, items, "random"))
        await ClockCycles(dut.clk_i, random.randrange(1, 4 * width + 2))
        cancel(sender)
        drive(dut, valid_i=0)
        await reset(dut)
        await ClockCycles(dut.clk_i, 2)
        sink.clear()
        sender = cocotb.start_soon(send(dut, items, "random"))
        assert [data for data, _ in await lines_of(sink, 4)] == lines
        await sender
