"""The core and its surroundings on a board, as benches drive it, and the scene that they show."""

import itertools

import cocotb
import numpy as np
from cocotb.triggers import ClockCycles, RisingEdge
from cocotbext.axi import AxiLiteBus, AxiLiteMaster
from oracles.memory import words_of
from streams import start_clock
from voxrt_registers import MATERIALS, REGISTERS

COLOURS = np.random.default_rng(4).integers(0, 256, (256, 3), dtype=np.uint8)
LOADED = (1, 2, 4, 8, 16, 32, 64, 128, 255)  # Materials whose colours the core knows.
MIRRORS = frozenset({2, 255})
CAMERA = np.array([[-60, 150, -70], [90, -70, 100], [9, 0, -9], [1, 9, 2]], np.int32)


def scene(seed):
    return np.random.default_rng(seed).choice([0, 0, 0, 0, 1, 2, 255], (8, 8, 8)).astype(np.uint8)


class Core:
    """The core and its surroundings on a board."""

    def __init__(self, dut):
        self.dut = dut
        self.axi = AxiLiteMaster(AxiLiteBus.from_prefix(dut, "s_axil"), dut.clk_i, dut.rst_ni, reset_active_level=False)
        for channels in (self.axi.write_if, self.axi.read_if):
            channels.log.setLevel("WARNING")
        self.ready = itertools.repeat(1)

    async def start(self):
        """Start the clock, reset, and collect the stream from then on."""
        dut = self.dut
        if hasattr(dut, "bram_en_i"):
            dut.bram_en_i.value = 0
        dut.m_axis_tready.value = 0
        dut.rst_ni.value = 0
        start_clock(dut)
        await ClockCycles(dut.clk_i, 20)
        dut.rst_ni.value = 1
        await ClockCycles(dut.clk_i, 2)
        self.words = []
        cocotb.start_soon(self.collect())
        for material in (0, *LOADED):
            red, green, blue = COLOURS[material].tolist()
            await self.axi.write_dword(MATERIALS + 4 * material, red << 16 | green << 8 | blue)

    async def collect(self):
        """Take words off the stream as `ready` says; what is offered must stay until it is taken."""
        dut = self.dut
        offered = None
        while True:
            dut.m_axis_tready.value = ready = next(self.ready)
            await RisingEdge(dut.clk_i)
            valid = int(dut.m_axis_tvalid.value)
            word = None
            if valid:
                signals = (dut.m_axis_tdata, dut.m_axis_tkeep, dut.m_axis_tuser, dut.m_axis_tlast)
                word = tuple(int(signal.value) for signal in signals)
            if offered is not None and int(dut.rst_ni.value) and not self.dropping:
                assert word == offered, "an offered word changed before it was taken"
            offered = word if valid and not ready else None
            if valid and ready:
                self.words.append(word)

    dropping = False

    async def write(self, name, **fields):
        address, places = REGISTERS[name]
        value = 0
        for field, number in fields.items():
            low, width = places[field]
            value |= (number & ((1 << width) - 1)) << low
        await self.axi.write_dword(address, value)

    async def read(self, name, field):
        address, places = REGISTERS[name]
        low, width = places[field]
        return await self.axi.read_dword(address) >> low & ((1 << width) - 1)

    async def load(self, words):
        """Write a scene through the memory port, a word a clock."""
        dut = self.dut
        dut.bram_en_i.value = 1
        dut.bram_we_i.value = 15
        for address, word in enumerate(words):
            dut.bram_addr_i.value = 4 * address
            dut.bram_wrdata_i.value = int(word)
            await RisingEdge(dut.clk_i)
        dut.bram_en_i.value = 0
        dut.bram_we_i.value = 0

    async def set_frame(self, camera, width, height, depth):
        """Write camera, size and depth; brightness by the angle, no light, no mirrors."""
        await self.write("shading")
        await self.write("size", width=width, height=height)
        await self.write("depth", depth=depth)
        for name, row in zip(("position", "look", "right", "up"), camera.tolist(), strict=True):
            for axis in range(3):
                await self.write(f"{name}[{axis}]", value=row[axis])

    async def set_light(self, position):
        for axis in range(3):
            await self.write(f"light[{axis}]", value=position[axis])

    async def set_faces(self, brightness):
        """Write the brightness of the faces along -x, +x, -y, +y, -z, +z."""
        for name, values in (("lower_faces", brightness[::2]), ("upper_faces", brightness[1::2])):
            await self.write(name, **dict(zip("xyz", values, strict=True)))

    async def write_mirrors(self):
        """Write the materials of scenes, those of MIRRORS as mirrors."""
        for material in (0, 1, 2, 255):
            red, green, blue = (int(channel) for channel in COLOURS[material])
            entry = (material in MIRRORS) << 24 | red << 16 | green << 8 | blue
            await self.axi.write_dword(MATERIALS + 4 * material, entry)

    async def trace(self, width, height):
        """Trace a frame; give its picture."""
        await self.write("control", start=1)
        await self.wait()
        return self.picture(width, height)

    async def soft_reset(self):
        """Reset, and drop what came of the frame."""
        self.dropping = True
        await self.write("control", soft_reset=1)
        await ClockCycles(self.dut.clk_i, 4)
        self.dropping = False
        self.words.clear()
        await self.write("status", frame_done=1)

    async def hold(self, clocks):
        """Let no further frame start, and wait until the present one has ended."""
        await self.write("control", hold=1)
        while await self.read("status", "busy"):
            pass
        await ClockCycles(self.dut.clk_i, clocks)

    async def wait(self):
        for _ in range(2000):  # A silent bus is waited for longest: 65,536 clocks.
            if await self.read("status", "frame_done"):
                await self.write("status", frame_done=1)
                await ClockCycles(self.dut.clk_i, 1000 if not self.dut.m_axis_tready.value else 40)
                return
            await ClockCycles(self.dut.clk_i, 50)
        raise AssertionError("the frame never ended")

    def picture(self, width, height):
        """Unpack one frame of the words collected; checks tkeep, tuser and tlast on the way."""
        per_line = (3 * width + 3) // 4
        words, self.words = self.words[: per_line * height], self.words[per_line * height :]
        assert len(words) == per_line * height
        lines = []
        for row in range(height):
            line = words[row * per_line : (row + 1) * per_line]
            data = b""
            for column, (value, keep, user, last) in enumerate(line):
                assert user == (row == column == 0)
                assert last == (column == per_line - 1)
                kept = keep.bit_count()
                assert keep == (1 << kept) - 1
                assert kept == 4 or last
                data += value.to_bytes(4, "little")[:kept]
            assert len(data) == 3 * width
            lines.append(np.frombuffer(data, np.uint8).reshape(width, 3)[:, [2, 0, 1]])  # from G, B, R
        return np.stack(lines)


async def started(dut, voxels=None, *size):
    """A core that has started, with a scene and frames of a size."""
    core = Core(dut)
    await core.start()
    if voxels is not None:
        await core.load(words_of(voxels))
    if size:
        await core.set_frame(CAMERA, *size, 3)
    return core
