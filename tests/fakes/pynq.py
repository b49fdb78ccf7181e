"""A fake PYNQ board: the classes of `pynq` as documented, around the verilated core.

Names and addresses are those of rtl/vivado/build.tcl. Registers, scene memory and video are the pins of the core. The
VDMA is a model of the write channel of PG020. It checks the programming sequence of that document, and that lines and
addresses are whole words of a 64-bit bus. It reports a frame by its status bit. Every access advances the clock of the
core.

A buffer of `allocate` is what the processor's caches hold of it, beside what is in the memory: `flush` and `invalidate`
copy one to the other. VDMA and core see the memory alone. As in PYNQ 3, no buffer is freed before the process ends.
"""

from __future__ import annotations

import sys
import types
from functools import partial

import numpy as np

BASE = {"core": 0x43C00000, "memory": 0x42000000, "vdma": 0x43000000}
CLOCKS_PER_ACCESS = 2000
PAGE = 4096
FRAME_DONE, LINE_TOO_EARLY = 1 << 12, 1 << 8


class Vdma:
    """The registers of the write channel, and the memory that it can write."""

    def __init__(self, core):
        self.core = core
        self.memory = {}  # physical address: buffer
        self.halt()

    def halt(self):
        self.control, self.status = 0x00010002, 1  # one frame per interrupt, circular; halted
        self.buffers, self.stride, self.row_bytes, self.rows = [0, 0, 0], 0, 0, 0
        self.waits = False

    def read(self, offset):
        self.tick()
        return {0x30: self.control, 0x34: self.status}[offset]

    def write(self, offset, value):
        self.tick()
        if offset == 0x30:
            self.control = value
            if value & 4:
                self.halt()
            elif value & 1:
                self.status &= ~1
        elif offset == 0x34:
            self.status &= ~value
        elif offset == 0xA8:
            self.stride = value
        elif offset == 0xA4:
            self.row_bytes = value
        elif offset == 0xA0:
            assert self.control & 1, "VSIZE is the last register to be written"
            assert all(buffer in self.memory for buffer in self.buffers)
            assert self.stride >= self.row_bytes > 0
            assert all(value % 8 == 0 for value in (*self.buffers, self.stride, self.row_bytes)), "unaligned transfer"
            assert self.stride * value <= self.memory[self.buffers[0]].nbytes
            self.rows = value
            self.arm()
        else:
            self.buffers[(offset - 0xAC) // 4] = value

    def arm(self):
        self.core.expect(self.row_bytes // 3, self.rows, stall_seed=1)
        self.waits = True

    def tick(self):
        """Advance the core; write a complete frame to memory, and wait for the next."""
        if self.core.hangs or not self.core.run(CLOCKS_PER_ACCESS) or not self.waits:
            return
        buffer = self.memory[self.buffers[0]].dram
        for row, line in enumerate(self.core.frame()):
            buffer[row * self.stride : row * self.stride + self.row_bytes] = line.reshape(-1)
        self.status |= FRAME_DONE | self.core.vdma_errors
        self.arm()


class Core:
    """The verilated core, with faults that tests can set."""

    def __init__(self, config="tiny"):
        from voxrt.sim._rtl import Core

        self._core = Core(config)
        self.hangs = False  # its clock stops
        self.vdma_errors = 0
        self.identity = None  # that of other hardware
        for name in ("expect", "run", "frame", "read_memory", "write_memory", "memory_words", "cached", "map_external"):
            setattr(self, name, getattr(self._core, name))

    def read(self, offset):
        return self.identity if self.identity is not None and offset == 0 else self._core.read(offset)

    def write(self, offset, value):
        self._core.write(offset, value)


class PortArray(np.ndarray):
    """The array of MMIO: reads and writes go to the memory of the core."""

    def __getitem__(self, key):
        start, stop, step = key.indices(len(self))
        assert step == 1
        return self.core.read_memory(start, stop - start)

    def __setitem__(self, key, words):
        start, stop, step = key.indices(len(self))
        assert step == 1
        assert stop - start == len(words)
        self.core.write_memory(start, np.ascontiguousarray(words, dtype=np.uint32))


class Mmio:
    """pynq.MMIO of one part of the block design."""

    def __init__(self, board, base_addr, length):
        assert length % 4 == 0
        self.board, self.length = board, length
        self.part = next(name for name, base in BASE.items() if base == base_addr)

    def read(self, offset=0):
        assert offset % 4 == 0
        if self.part == "vdma":
            return self.board.vdma.read(offset)
        self.board.vdma.tick()
        return self.board.core.read(offset)

    def write(self, offset, data):
        assert offset % 4 == 0
        assert type(data) is int
        assert 0 <= data < 1 << 32
        part = self.board.vdma if self.part == "vdma" else self.board.core
        part.write(offset, data)

    @property
    def array(self):
        assert self.part == "memory"
        array = np.broadcast_to(np.uint32(0), self.length // 4).view(PortArray)
        array.core = self.board.core
        return array


class Board:
    """The parts that an overlay finds, and the contiguous memory that the VDMA can write and a cached core can read."""

    def __init__(self, core, memory_bytes, contiguous, first_address):
        self.core, self.vdma = core, Vdma(core)
        self.memory_bytes = memory_bytes
        self.free = contiguous  # bytes
        self.next_address = first_address

    def overlay(self, bitfile_name):
        if not bitfile_name.endswith(".bit"):
            raise OSError(f"{bitfile_name} does not exist.")
        entry = {name: {"phys_addr": base, "addr_range": 0x10000} for name, base in BASE.items()}
        entry["memory"]["addr_range"] = self.memory_bytes
        memories = {"memory": entry.pop("memory")}
        if self.core.cached:
            memories.clear()
        return types.SimpleNamespace(ip_dict=entry, mem_dict=memories)

    def allocate(self, shape, dtype="u4"):
        size = int(np.prod(shape)) * np.dtype(dtype).itemsize
        if size > self.free:
            raise RuntimeError("Failed to allocate Memory!")
        self.free -= size
        buffer = np.full(shape, 0xA5, dtype=dtype).view(PynqBuffer)
        buffer.dram = np.full(size, 0x5A, dtype=np.uint8)
        buffer.physical_address = self.next_address
        self.next_address += -(-size // PAGE) * PAGE
        self.vdma.memory[buffer.physical_address] = buffer
        if self.core.cached and buffer.dtype == np.uint32 and self.next_address < 1 << 32:
            self.core.map_external(buffer.physical_address, buffer.dram.view(np.uint32))
        return buffer


class PynqBuffer(np.ndarray):
    def __array_finalize__(self, whole):
        """A part of a buffer has its part of the memory."""
        if isinstance(whole, PynqBuffer) and hasattr(whole, "dram"):
            start = self.__array_interface__["data"][0] - whole.__array_interface__["data"][0]
            self.dram = whole.dram[start : start + self.nbytes]

    def flush(self):
        self.dram[:] = self.reshape(-1).view(np.uint8)

    def invalidate(self):
        self.reshape(-1).view(np.uint8)[:] = self.dram


def install(monkeypatch, core, memory_bytes=0x10000, contiguous=1 << 24, first_address=0x10000000):
    """Make `import pynq` find a fake with this core in its overlay; return its VDMA.

    `memory_bytes` are those of a memory on the chip; `allocate` can give `contiguous` bytes from `first_address` on.
    """
    board = Board(core, memory_bytes, contiguous, first_address)
    module = types.SimpleNamespace(Overlay=board.overlay, MMIO=partial(Mmio, board), allocate=board.allocate)
    monkeypatch.setitem(sys.modules, "pynq", module)
    return board.vdma
