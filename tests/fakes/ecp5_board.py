"""A board of docs/board-bus.md behind its serial line: the bus, the table and the board's registers in Python, the
ray tracer verilated. It can lose and damage bytes, and be unplugged."""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.board.board_report import frame_crc32
from voxrt.board.designs.boot_table import BOARD_REGISTERS
from voxrt.board.register_writes import encode_fields
from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.sim.verilated import import_verilated

if TYPE_CHECKING:
    from collections.abc import Iterable

COUNTERS = {REGISTERS[name][0] for name in ("cycles", "rays", "words_read", "hits", "stalls")}
KNOWN = {address for address, _ in REGISTERS.values()} | set(range(MATERIALS, MATERIALS + 1024, 4))
CLOCK = 75_000_000
BLOCK_BITS = 10
SDRAM_BLOCK_BITS = 19
PAGE = 1 << 21
CONFIGURATION, FIELDS = REGISTERS["configuration"]


class BlindCore:
    """The registers and the memory of a ray tracer that traces nothing, where none is verilated."""

    def __init__(self) -> None:
        self.registers = {
            REGISTERS["identity"][0]: 0x56585254,
            CONFIGURATION: encode_fields("configuration", lanes=1, max_depth=16, ray_clocks=1, position_bits=22),
            REGISTERS["features"][0]: encode_fields("features", flat=1, faces=1),
        }
        self.memory = np.zeros(1 + (8 << BLOCK_BITS), np.uint32)

    def read(self, address: int) -> int:
        return self.registers.get(address, 0)

    def write(self, address: int, value: int) -> None:
        self.registers[address] = value

    def read_memory(self, word: int, count: int) -> np.ndarray:
        return self.memory[word : word + count]

    def write_memory(self, word: int, words: np.ndarray) -> None:
        self.memory[word : word + len(words)] = words


class Board:
    """A serial port (`write`, `read`, `close`) with a board at it. Each request lets one vertical blanking pass."""

    def __init__(
        self, faults: Iterable[str] = (), *, sdram: bool = False, has_crc: bool = True, core: Any = None
    ) -> None:
        self.sdram, self.has_crc = sdram, has_crc
        self.core = core or import_verilated("the tests need it").Core("tiny")
        self.words = 1 + (8 << (SDRAM_BLOCK_BITS if sdram else BLOCK_BITS))
        self.table = np.zeros(4096, dtype=np.uint32)
        self.registers = dict.fromkeys(range(0x1000, 0x1030, 4), 0)
        self.registers |= {0x1000: 0x56584244, 0x1004: 0x0100 | has_crc, 0x102C: CLOCK}
        if sdram:
            self.registers |= {0x1030: 0, 0x1034: 1 << SDRAM_BLOCK_BITS}
        self.faults = iter(faults)
        self.pending = None
        self.unplugged = False
        self.answers = bytearray()
        self.played: list[int] = []

    # The port

    def write(self, data: bytes) -> None:
        fault = next(self.faults, "")
        if fault == "unplug":
            self.unplugged = True
        if self.unplugged:
            raise OSError(5, "Input/output error")
        if fault == "lose request":
            return
        if fault == "damage request":
            data = bytes((*data[:-1], data[-1] ^ 4))
        answer = self.answer(data)
        if fault == "lose answer":
            return
        if fault == "cut answer":
            answer = answer[:-3]
        if fault == "damage answer":
            answer = bytes((*answer[:-1], answer[-1] ^ 1))
        if fault == "noise":
            answer = b"\x00\x76\xff" + answer
        self.answers += answer

    def read(self, count: int) -> bytes:
        if self.unplugged:
            raise OSError(5, "Input/output error")
        data = bytes(self.answers[:count])
        del self.answers[:count]
        return data

    def close(self) -> None:
        self.closed = True

    # The board

    def answer(self, data: bytes) -> bytes:
        if data[0] != 0x56:
            return b""
        if zlib.crc32(data[:-4]) != int.from_bytes(data[-4:], "little"):
            self.registers[0x101C + 8] += 1
            return self.framed(1, data[2], b"")
        operation, sequence, count = data[1], data[2], data[3]
        address = int.from_bytes(data[4:7], "little")
        if operation not in (1, 2) or count == 0 or address % 4:
            return self.framed(2, sequence, b"")
        self.registers[0x1020] += 1
        places = range(address, address + 4 * count, 4)
        status, found = 0, []
        for number, place in enumerate(places):
            if operation == 1:
                value = self.get(place)
                status = status or 3 * (value is None)
                found.append(value or 0)
            elif not self.put(place, int.from_bytes(data[7 + 4 * number : 11 + 4 * number], "little")):
                status = 3
        self.blank()
        return self.framed(status, sequence, np.array(found, dtype="<u4").tobytes())

    def framed(self, status: int, sequence: int, words: bytes) -> bytes:
        data = bytes((0x76, status, sequence, len(words) // 4)) + words
        return data + zlib.crc32(data).to_bytes(4, "little")

    def get(self, address: int) -> int | None:
        if address in self.registers:
            return self.registers[address]
        if address == BOARD_REGISTERS["frame_crc"] and self.has_crc:
            return frame_crc32(self.screen()) if self.registers[0x1008] & 8 else 0
        if 0x4000 <= address < 0x8000:
            return int(self.table[(address - 0x4000) // 4])
        if address >= 0x800000:
            word = (address - 0x800000) // 4 + PAGE * self.registers.get(0x1030, 0)
            return int(self.core.read_memory(word, 1)[0]) if word < self.words else 0
        if address in COUNTERS and self.registers[0x1008] & 8:  # those of the host's frame, which has ended
            self.screen()
        value = int(self.core.read(address)) if address in KNOWN else None
        if address == CONFIGURATION:  # a board has less memory than the simulation
            value = value & ~(0x1F << FIELDS["block_bits"][0]) | BLOCK_BITS << FIELDS["block_bits"][0]
            value |= self.sdram << FIELDS["cached"][0]
        return value

    def put(self, address: int, value: int) -> bool:
        if address == 0x1010:
            self.registers[address] = 1 << 31
            self.pending = value & 0xFFF
        elif address in self.registers:
            if address in (0x1008, 0x100C, 0x1030):
                self.registers[address] = value
        elif 0x4000 <= address < 0x8000:
            self.table[(address - 0x4000) // 4] = value
        elif address >= 0x800000:
            word = (address - 0x800000) // 4 + PAGE * self.registers.get(0x1030, 0)
            if word < self.words:
                self.core.write_memory(word, np.array([value], dtype=np.uint32))
        elif address in KNOWN:
            self.core.write(address, value)
        else:
            return False
        return True

    def play(self, word: int, most: int) -> None:
        end = min(word + most, 4096)
        while word < end:
            count, address = int(self.table[word]) >> 24, int(self.table[word]) & 0xFFFFFF
            if count == 0:
                return
            for number in range(count):
                assert self.put(address + 4 * number, int(self.table[word + 1 + number]))
            word += 1 + count

    def blank(self) -> None:
        """The vertical blanking: the asked-for list, the camera of the orbit, the next frame."""
        if self.pending is not None:
            word, self.pending = self.pending, None
            self.play(word, 4096)
            self.registers[0x1010] = 0
            self.played.append(word)
        control = self.registers[0x1008]
        if not control & 8:
            camera = self.registers[0x100C]
            self.play(2048 + 16 * camera, 16)
            if control & 2:
                self.registers[0x100C] = (camera + (127 if control & 4 else 1)) % 128
        if control & 1:
            self.registers[0x1014] += 1

    def screen(self) -> np.ndarray:
        """What the next frame shows: the ray tracer's picture, uint8, shape (H, W, 3), red, green, blue."""
        size = int(self.core.read(REGISTERS["size"][0]))
        width, height = size & 0xFFF, size >> 16
        self.core.expect(width, height)
        self.core.write(REGISTERS["control"][0], 1 << REGISTERS["control"][1]["start"][0])
        while self.core.read(REGISTERS["status"][0]) & 1:
            self.core.run(1 << 15)
        self.core.run(1 << 15)
        return np.ascontiguousarray(self.core.frame()[..., (2, 0, 1)])
