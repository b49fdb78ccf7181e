"""What the page needs to make bitstreams of boards: the placed design of each, packed, and where a scene goes in it.

For each board NAME.bit is the placed design as ecppack packs it, and NAME.json says what replaces its block RAMs:
numbers of words and bits alone, so that the page knows neither the boards' registers nor their lists.
"""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.board.designs import build
from voxrt.board.designs.base_design import places
from voxrt.board.designs.boot_table import CAMERA_WORDS, CAMERAS, CAMERAS_WORD, OCTREE_MEMORY, TABLE_WORDS, boot_table
from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.board.scene import Scene
from voxrt.boards.beam import SCREEN, configuration_of
from voxrt.boards.bitstream import board_names, pack, read_board
from voxrt.octree.camera import Camera, Lighting
from voxrt.octree.words import EMPTY

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.boards.bitstream import Memory, PlacedBoard

SCALES = 3
_CAMERA = Camera((0, 0, 0), (0, 0, 0), (0, 0, 0), (0, 0, 0))
_SCENE = Scene("", 1, np.array([EMPTY], np.uint32), np.zeros((256, 3), np.uint8), np.zeros(256, np.bool_))
# Sets the address of block RAM WID, in bits 11 and above; writes 256 frames of 9 bytes, and their checksum.
_BLOCK_RAM = re.compile(rb"\xf6\x00\x00\x00(....)\xb2\xd0\x01\x00(?=.{2306})", re.DOTALL)


def add_boards(folder: Path) -> dict[str, str]:
    """Write the files of each board, and return the verilated configurations by board.

    Boards with a frame buffer are left out: the page counts the cycles of those that race the beam. So are boards with
    a Gowin GW2A, whose bitstreams the page does not patch.
    """
    folder.mkdir()
    configurations = {}
    for name in board_names():
        description = build.read_board(name)
        if "boot_block_bits" in description or build.is_gowin(description):
            continue
        board = read_board(name)
        bits = pack(board, board.config)
        (folder / f"{name}.bit").write_bytes(bits)
        configurations[name] = configuration_of(board.design.core["Lanes"], board.design.core["RayClocks"], Lighting())
        (folder / f"{name}.json").write_text(json.dumps(described(board, bits) | {"hardware": configurations[name]}))
    return configurations


def described(board: PlacedBoard, bits: bytes) -> dict[str, Any]:
    """Describe a board and its packed design."""
    found = {int.from_bytes(match[1], "big") >> 11: match.start() for match in _BLOCK_RAM.finditer(bits)}
    return {
        "name": board.name,
        "title": board.title,
        "loader": board.loader,
        "capacity": board.design.capacity,
        "depth": board.design.core["MaxDepth"],
        "blockBits": board.design.core["BlockBits"],
        "clock": board.design.clock_hz,
        "bufferLines": board.design.buffer_lines,
        "screen": SCREEN,
        "octree": block_rams(board.design.memories["octree"], found),
        "table": block_rams(board.design.memories["table"], found),
        "boot": {
            "words": TABLE_WORDS,
            "lists": {
                shading: [start_list(Lighting().shaded(shading), scale) for scale in range(SCALES)]
                for shading in ("faces", "flat")
            },
            **start_places(),
        },
        "orbit": {"cameras": CAMERAS, "at": CAMERAS_WORD, "step": CAMERA_WORDS, **camera_places()},
    }


def block_rams(memory: Memory, found: Mapping[int, int]) -> list[dict[str, Any]]:
    """Give the block RAMs of a memory: where their command begins in the file, and where the bits of words go."""
    return [
        {"at": found[piece.wid], "row": piece.row, "rows": piece.rows, "bit": piece.bit, "bits": piece.bits}
        | {"places": places(piece.bits)}
        for piece in memory.slices
    ]


def start_list(lighting: Lighting, scale: int) -> list[int]:
    """Give the list that a board starts from, without its scene."""
    table = boot_table(_SCENE, [_CAMERA] * CAMERAS, lighting, scale=scale)[:CAMERAS_WORD]
    return [int(word) for word in np.trim_zeros(table, "b")]


def start_places() -> dict[str, int]:
    """Give the words of that list that are of the scene: its depth, word 0 and 256 materials."""
    written = places_of(boot_table(_SCENE, [_CAMERA] * CAMERAS, Lighting()), 0)
    addresses = {"depth": REGISTERS["depth"][0], "root": OCTREE_MEMORY, "materials": MATERIALS}
    return {name: written[address] for name, address in addresses.items()}


def camera_places() -> dict[str, Any]:
    """Give the list of a camera, where its 12 values go, and how many bits of each."""
    table = boot_table(_SCENE, [_CAMERA] * CAMERAS, Lighting())
    written = places_of(table[: CAMERAS_WORD + CAMERA_WORDS], CAMERAS_WORD)
    names = [f"{name}[{axis}]" for name in ("position", "look", "right", "up") for axis in range(3)]
    return {
        "list": [int(word) for word in table[CAMERAS_WORD : CAMERAS_WORD + CAMERA_WORDS]],
        "places": [written[REGISTERS[name][0]] - CAMERAS_WORD for name in names],
        "bits": [next(iter(REGISTERS[name][1].values()))[1] for name in names],
    }


def places_of(table: NDArray[np.uint32], start: int) -> dict[int, int]:
    """Return the word of a table that each address is written from, by the list that starts at a word."""
    found, word = {}, start
    while word < len(table) and (count := int(table[word]) >> 24):
        address = int(table[word]) & 0xFFFFFF
        found |= {address + 4 * i: word + 1 + i for i in range(count)}
        word += 1 + count
    return found
