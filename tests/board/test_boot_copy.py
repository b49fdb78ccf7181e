"""The scene of the bitstream reaches the SDRAM whole, however long the PLL takes to lock."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from fakes.verilated import compile_bench
from oracles.verilator import needs_compiled_verilator

pytestmark = [pytest.mark.xdist_group("sdram"), *needs_compiled_verilator]

ROOT = Path(__file__).resolve().parents[2]
SOURCES = [
    ROOT / "rtl" / "voxrt_pkg.sv",
    ROOT / "rtl" / "memory" / "voxrt_word_decoder.sv",
    ROOT / "board" / "designs" / "board_boot_copy.sv",
    Path(__file__).with_name("boot_copy_bench.cpp"),
]
BLOCKS = 32
POINTERS = list(range(1, BLOCKS))
LEAVES = [1 + (7 * place) % 255 for place in range(8 * BLOCKS - len(POINTERS))]


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    folder = tmp_path_factory.mktemp("boot")
    # A pointer to block b is b; a leaf of material m is 512 + m (docs/board-files.md).
    (folder / "octree.hex").write_text("".join(f"{row:x}\n" for row in [*POINTERS, *(512 + m for m in LEAVES)]))
    return compile_bench("board_boot_copy", SOURCES, folder, "-GBlockBits=5", '-GFile="octree.hex"')


@pytest.mark.parametrize("clocks", [18, 19, 1000, 1001])
def test_every_word_is_copied_whatever_the_clocks_in_reset(clocks, program):
    finished = subprocess.run([program, str(clocks)], cwd=program.parent, capture_output=True, text=True, check=True)
    lines = [line.split() for line in finished.stdout.splitlines()]
    assert [int(line[8]) for line in lines] == list(range(1, 1 + BLOCKS))
    words = [int(word, 16) for line in lines for word in line[:8]]
    # Bits 8 to 30 of a leaf have no meaning.
    words = [word & 0x800000FF if word >> 31 else word for word in words]
    assert words == [*(1 + 8 * block for block in POINTERS), *(1 << 31 | material for material in LEAVES)]
