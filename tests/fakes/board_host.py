"""The host of a simulated board, by the protocol of docs/board-serial.md, and what the board's screen should show."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from fakes.box_scenes import picture_of

from voxrt.board.board_report import frame_crc32
from voxrt.board.designs.boot_table import BOARD_REGISTERS, CAMERAS, RUN
from voxrt.board.registers import REGISTERS
from voxrt.board.view import Lighting, View
from voxrt.octree.camera import look_at


def picture(scene, camera, scale):
    """What the screen shows: each pixel of the exact model as a square."""
    view = View(camera, (640 >> scale, 480 >> scale), scene.background, Lighting())
    frame = picture_of(scene, view)
    return frame.repeat(1 << scale, 0).repeat(1 << scale, 1)


def cameras_around(scene, size, *, radius, height, steps=16):
    """Look at the middle of the world from all around, in world sides from there; `steps` cameras make a turn."""
    side = 2.0**scene.depth
    angles = 2 * np.pi * np.arange(CAMERAS) / steps
    eyes = np.stack([0.5 + radius * np.cos(angles), 0 * angles + 0.5 + height, 0.5 + radius * np.sin(angles)], axis=1)
    return [look_at(side * eye, np.full(3, side / 2), size=size) for eye in eyes]


def expected_crc(seen, scale):
    """The CRC of a frame that the screen shows, as the board must have it."""
    return frame_crc32(seen[:: 1 << scale, :: 1 << scale])


class Host:
    """The host's side of the protocol."""

    def __init__(self, board):
        self.board = board
        self.sequence = 0

    def request(self, operation, address, count, words=(), sequence=0):
        head = bytes([0x56, operation, sequence, count]) + address.to_bytes(3, "little")
        data = head + struct.pack(f"<{len(words)}I", *words)
        return data + struct.pack("<I", zlib.crc32(data))

    def ask(self, request, words):
        """Send a request; return the status, the sequence number and the words of its answer."""
        answer = self.board.transfer(request, 8 + 4 * words)
        assert len(answer) == 8 + 4 * words, answer.hex()
        assert answer[0] == 0x76
        assert struct.unpack("<I", answer[-4:])[0] == zlib.crc32(answer[:-4])
        assert answer[3] == words
        return answer[1], answer[2], list(struct.unpack(f"<{words}I", answer[4:-4]))

    def done(self, operation, address, count, words=()):
        """Send a request that is done; return the words of its answer."""
        self.sequence = (self.sequence + 1) % 256
        request = self.request(operation, address, count, words, self.sequence)
        status, sequence, answer = self.ask(request, count if operation == 1 else 0)
        assert (status, sequence) == (0, self.sequence)
        return answer

    def read(self, address, count=1):
        starts = range(0, count, 255)
        return [word for start in starts for word in self.done(1, address + 4 * start, min(255, count - start))]

    def write(self, address, words):
        for start in range(0, len(words), 255):
            part = [int(word) for word in words[start : start + 255]]
            self.done(2, address + 4 * start, len(part), part)

    def register(self, name):
        return self.read(BOARD_REGISTERS[name])[0]

    def frame_crc(self):
        """Let no frame start, read the CRC of the last one, and let frames start again."""
        control = self.register("control")
        self.write(BOARD_REGISTERS["control"], [control & ~RUN])
        while self.read(REGISTERS["status"][0])[0] & 1:  # busy
            self.board.run(10_000)
        self.board.frames(1)  # until the screen has taken all of it
        crc = self.register("frame_crc")
        self.write(BOARD_REGISTERS["control"], [control])
        return crc
