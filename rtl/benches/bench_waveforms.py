"""The waveforms of rtl/README.md, as the core makes them: into build/benches/<build>/waveforms.txt."""

import itertools
from pathlib import Path

import cocotb
import numpy as np
from cocotb.triggers import ClockCycles, RisingEdge
from core_driver import CAMERA, Core, scene
from oracles.memory import words_of

WRITTEN = Path("waveforms.txt")
WRITTEN.unlink(missing_ok=True)
CELL = 9


def show(title, rows):
    """Append a diagram: a line for each signal, a column for each clock."""
    width = max(len(name) for name in rows)
    lines = [title]
    for name, values in rows.items():
        lines.append(f"{name:<{width}} |" + "|".join(f"{value:^{CELL}}" for value in values) + "|")
    write(lines)


def write(lines):
    with WRITTEN.open("a") as file:
        file.write("\n".join(lines) + "\n\n")


def number(signal, digits=8):
    return f"{int(signal.value):0{digits}X}"


@cocotb.test()
async def memory_port(dut):
    """Write two words and read them: what is read comes three clocks after its address."""
    core = Core(dut)
    await core.start()
    rows = {name: [] for name in ("bram_en_i", "bram_we_i", "bram_addr_i", "bram_wrdata_i", "bram_rddata_o")}
    steps = [(15, 4, 0xFFFFFF07), (15, 8, 9), (0, 4, 0), (0, 8, 0), None, None, None, None]
    answers = []
    for clock, step in enumerate(steps):
        dut.bram_en_i.value = step is not None
        if step:
            dut.bram_we_i.value, dut.bram_addr_i.value, dut.bram_wrdata_i.value = step
        await RisingEdge(dut.clk_i)
        rows["bram_en_i"].append(int(step is not None))
        rows["bram_we_i"].append("" if step is None else number(dut.bram_we_i, 1))
        rows["bram_addr_i"].append("" if step is None else number(dut.bram_addr_i, 2))
        rows["bram_wrdata_i"].append("" if step is None or not step[0] else number(dut.bram_wrdata_i))
        rows["bram_rddata_o"].append(number(dut.bram_rddata_o) if clock in {5, 6} else "")
        answers.append(number(dut.bram_rddata_o))
    assert answers[5:7] == ["FFFFFF07", "00000009"]
    show("memory port, private copies", rows)


@cocotb.test()
async def stream(dut):
    """Take a frame of 6 x 1 pixels to a sink that is not always ready: what is offered stays."""
    core = Core(dut)
    await core.start()
    await core.load(words_of(np.zeros((2, 2, 2), np.uint8)))
    await core.set_frame(CAMERA, 6, 1, 1)
    core.ready = itertools.chain([0] * 400, itertools.cycle([1, 0, 1, 1, 0, 0]))
    await core.write("control", start=1)
    while not int(dut.m_axis_tvalid.value):
        await RisingEdge(dut.clk_i)
    while not int(dut.m_axis_tready.value):
        await RisingEdge(dut.clk_i)
    names = ("m_axis_tvalid", "m_axis_tready", "m_axis_tdata", "m_axis_tkeep", "m_axis_tuser", "m_axis_tlast")
    rows = {name: [] for name in names}
    for _ in range(10):
        valid = int(dut.m_axis_tvalid.value)
        for name, values in rows.items():
            digits = 8 if name == "m_axis_tdata" else 1
            always = name in {"m_axis_tvalid", "m_axis_tready"}
            values.append(number(getattr(dut, name), digits) if valid or always else "")
        await RisingEdge(dut.clk_i)
    show("stream, a line of 6 pixels: 18 bytes in 5 words", rows)


@cocotb.test()
async def frame_start(dut):
    """Time from the write of control.start to the first word of the stream."""
    core = Core(dut)
    core.ready = itertools.repeat(1)
    await core.start()
    await core.load(words_of(scene(1)))
    inside = CAMERA.copy()
    inside[0] = [64, 64, 64]
    await core.set_frame(inside, 16, 16, 3)
    rtu = dut.u_rtu
    events = {
        "the frame is latched": dut.start,
        "its root is there": rtu.root_valid,
        "direction of the corner": rtu.corner,
        "first direction": rtu.u_rays.direction_valid,
        "first ray for a lane": rtu.ray_valid,
        "first word asked for": rtu.lane_read,
        "first pixel from a lane": rtu.lane_pixel_valid,
        "first pixel shaded": dut.pixel_valid,
        "first word of the stream": dut.m_axis_tvalid,
    }
    seen = {}
    writer = cocotb.start_soon(core.write("control", start=1))
    for clock in range(600):
        await RisingEdge(dut.clk_i)
        for name, signal in events.items():
            if name not in seen and int(signal.value) and (seen or signal is dut.start):
                seen[name] = clock
    await writer
    assert list(seen) == list(events)
    begin = seen["the frame is latched"]
    write(
        ["frame of 16 x 16 pixels, one lane, clocks", *(f"{clock - begin:>5} {name}" for name, clock in seen.items())]
    )
    await ClockCycles(dut.clk_i, 2000)
