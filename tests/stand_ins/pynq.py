"""A stand-in for a PYNQ board: register file, memory and VDMA as their documents have them, the exact model inside.

The register file follows rtl/registers.rdl: start is a pulse, dropped while hold is set or a frame is under way; status
bits are cleared by writing 1. A frame takes two reads of the status.
"""

from __future__ import annotations

import types

import numpy as np

from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.sim import _model

ADDRESSES = {address: name for name, (address, _) in REGISTERS.items()}
BASE = {"pixel_generator_0": 0x43C00000, "axi_bram_ctrl_0": 0x40000000}


def signed(value, bits):
    return value - (1 << bits) if value >> (bits - 1) else value


class Core:
    def __init__(self, blocks=6, identity=0x56585254, hangs=False):
        self.words = np.zeros(1 + (8 << blocks), dtype=np.uint32)
        self.values = dict.fromkeys(REGISTERS, 0)
        self.values |= {"identity": identity, "version": 1, "configuration": 1 | 10 << 8 | 17 << 16 | blocks << 24}
        self.materials = np.zeros((256, 3), dtype=np.uint8)
        self.reads_left = 0
        self.hangs = hangs
        self.stream = None
        self.errors = 0

    def read(self, offset):
        name = ADDRESSES[offset]
        if name == "status" and self.reads_left:
            self.reads_left -= not self.hangs
            if self.reads_left == 0:
                self.values["status"] = self.values["status"] & ~1 | 2 | self.errors
        return self.values[name]

    def write(self, offset, value):
        assert 0 <= value < 1 << 32
        if offset >= MATERIALS:
            self.materials[(offset - MATERIALS) // 4] = value >> 16 & 255, value >> 8 & 255, value & 255
            return
        name = ADDRESSES[offset]
        if name == "status":
            self.values[name] &= ~value
        elif name == "control":
            self.values[name] = value & 6
            if value & 8:
                self.reads_left, self.values["status"] = 0, 0
            if value & 1 and not value & 4 and not self.reads_left:
                self.start()
        else:
            self.values[name] = value

    def start(self):
        get = self.values.__getitem__
        camera = [[signed(get(f"position[{axis}]"), 32) for axis in range(3)]]
        camera += [[signed(get(f"{name}[{axis}]"), 16) for axis in range(3)] for name in ("look", "right", "up")]
        width, height = get("size") & 0xFFF, get("size") >> 16
        memory = _model.Memory(self.words, get("depth"))
        pixels = memory.render(self.materials, np.array(camera, dtype=np.int32), width, height)
        self.stream = pixels["colour"][..., (1, 2, 0)]  # green, blue, red
        self.values |= {"rays": width * height, "words_read": pixels["words_read"], "cycles": 3 * width * height}
        self.values["status"] |= 1
        self.reads_left = 2


class Channel:
    def __init__(self, core):
        self.core = core
        self.mode = None
        self.running = False
        self.kept = 0

    def start(self):
        assert not self.running
        self.running = True

    def stop(self):
        self.running = False

    def readframe(self):
        assert self.running
        assert self.core.stream.shape == (self.mode.height, self.mode.width, 3)
        self.kept += 1

        class PynqBuffer(np.ndarray):
            def freebuffer(buffer):  # noqa: N805
                self.kept -= 1

        return self.core.stream.copy().view(PynqBuffer)


def install(monkeypatch, core):
    """Put a `pynq` with this core in its overlay where imports find it; its VDMA channel."""
    channel = Channel(core)

    class MMIO:
        def __init__(self, base_addr, length):
            assert length % 4 == 0
            self.is_core = base_addr == BASE["pixel_generator_0"]
            self.read, self.write = core.read, core.write

        @property
        def array(self):
            assert not self.is_core
            return core.words

    class Overlay:
        def __init__(self, bitfile_name):
            if not bitfile_name.endswith(".bit"):
                raise OSError(f"{bitfile_name} does not exist.")
            entry = {name: {"phys_addr": base, "addr_range": 0x10000} for name, base in BASE.items()}
            self.ip_dict = {"pixel_generator_0": entry["pixel_generator_0"]}
            self.mem_dict = {"axi_bram_ctrl_0": entry["axi_bram_ctrl_0"]}
            self.axi_vdma_0 = types.SimpleNamespace(readchannel=channel)

    class VideoMode:
        def __init__(self, width, height, bits_per_pixel):
            assert bits_per_pixel == 24
            self.width, self.height = width, height

    modules = {
        "pynq": types.SimpleNamespace(Overlay=Overlay, MMIO=MMIO),
        "pynq.lib": types.SimpleNamespace(),
        "pynq.lib.video": types.SimpleNamespace(VideoMode=VideoMode),
    }
    for name, module in modules.items():
        monkeypatch.setitem(__import__("sys").modules, name, module)
    return channel
