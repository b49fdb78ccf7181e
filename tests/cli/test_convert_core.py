"""``voxrt convert --form core``: rows, writes and header of a scene, for each form of memory."""

from __future__ import annotations

import shutil
import subprocess

import numpy as np
import pytest

import voxrt as library
from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.rtl.configurations import read_configurations

MEMORY = 0x800000


def words_of(folder):
    return library.read_rom(folder / "house.mem")[0].octree.words


def decode(row: int, block_bits: int) -> int:
    """A word of the octree, as rtl/memory/voxrt_word_decoder.sv gives it."""
    payload = max(block_bits, 9)
    return 0xFFFFFF00 | row & 0xFF if row >> payload else 1 + 8 * row


def read_rows(path):
    return [int(line, 16) for line in path.read_text().split()]


def test_private_copies(voxrt, built):
    voxrt.succeeds("convert", "house.mem", "out", "--form", "core", "--config", "octo", "--size", "32x24")
    assert sorted(path.name for path in (built / "out").iterdir()) == ["boot.hex", "octree.hex", "scene.h"]
    rows, words = read_rows(built / "out/octree.hex"), words_of(built)
    assert len(rows) == 8 << read_configurations()["octo"].parameters["BlockBits"]
    assert [decode(row, 12) for row in rows[: len(words) - 1]] == words[1:].tolist()
    assert set(rows[len(words) - 1 :]) == {1 << 12}


def test_banks(voxrt, built):
    assert voxrt("convert", "house.mem", "out", "--form", "core").code == 0
    assert voxrt("convert", "house.mem", "out", "--form", "core", "--config", "banked").code == 0
    names = [f"bank_{number:02d}.hex" for number in range(16)]
    assert sorted(path.name for path in (built / "out").iterdir()) == [*names, "boot.hex", "scene.h", "top.hex"]
    banks, words = [read_rows(built / "out" / name) for name in names], words_of(built)
    assert {len(bank) for bank in banks} == {(8 << 14) // 16}
    # voxrt_banked_memory.sv: bank = lowest four bits of the address ^ those of the row.
    for address, word in enumerate(words[1:].tolist()):
        row = address // 16
        bank = (address ^ row) % 16
        assert decode(banks[bank][row], 14) == word
    top = read_rows(built / "out/top.hex")
    assert len(top) == 8 * 256
    for address in range(min(len(top), len(words) - 1)):
        row = address // 16
        assert decode(top[16 * row + (address ^ row) % 16], 14) == words[1 + address]


def test_external_memory(voxrt, built):
    assert voxrt("convert", "house.mem", "out", "--form", "core", "--config", "cached4").code == 0
    image, words = read_rows(built / "out/octree.hex"), words_of(built)
    assert len(image) % 8 == 0
    assert image[7 : 7 + len(words)] == words.tolist()
    writes = (built / "out/boot.hex").read_text().split()
    assert not any(write.startswith("008") for write in writes)
    assert writes[-1] == f"{REGISTERS['control'][0]:08x}_00000011"  # start, and flush


def test_the_writes_are_those_of_the_scene(voxrt, built):
    assert voxrt("convert", "house.mem", "out", "--form", "core", "--size", "32x24").code == 0
    lines = (built / "out/boot.hex").read_text().split()
    writes = [tuple(int(part, 16) for part in line.split("_")) for line in lines]
    values = dict(writes)
    assert values[REGISTERS["size"][0]] == 24 << 16 | 32
    assert values[REGISTERS["depth"][0]] == 5
    assert values[MEMORY] == words_of(built)[0]
    assert writes[-1] == (REGISTERS["control"][0], 1)
    rom, _ = library.read_rom(built / "house.mem")
    for number, material in enumerate(rom.materials):
        assert values[MATERIALS + 4 * number].to_bytes(4, "big")[1:] == bytes(material.colour)
    known = {address for address, _ in REGISTERS.values()} | {MATERIALS + 4 * number for number in range(256)}
    assert {address for address, _ in writes} - known == {MEMORY}


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
def test_the_header_for_c(voxrt, built):
    assert voxrt("convert", "house.mem", "out", "--form", "core", "--size", "32x24").code == 0
    (built / "main.c").write_text("""
#include <stdio.h>
#include "out/scene.h"
int main(void) {
    printf("%d %d %d\\n", VOXRT_SCENE_DEPTH, VOXRT_SCENE_WIDTH, VOXRT_SCENE_HEIGHT);
    for (int i = 0; i < VOXRT_SCENE_WORDS; i++) printf("%08x\\n", (unsigned)voxrt_scene_words[i]);
    for (int i = 0; i < VOXRT_SCENE_WRITES; i++)
        printf("%08x_%08x\\n", (unsigned)voxrt_scene_writes[i][0], (unsigned)voxrt_scene_writes[i][1]);
    return 0;
}
""")
    build = ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-o", "main", "main.c"]
    subprocess.run(build, cwd=built, check=True)
    printed = subprocess.run(["./main"], cwd=built, capture_output=True, text=True, check=True).stdout.split()
    assert printed[:3] == ["5", "32", "24"]
    words = words_of(built)
    np.testing.assert_array_equal([int(word, 16) for word in printed[3 : 3 + len(words)]], words)
    boot = (built / "out/boot.hex").read_text().split()
    assert printed[3 + len(words) :] == [write for write in boot if not write.startswith("008")]


def test_errors_are_one_line_and_write_nothing(voxrt, built):
    for arguments, message in (
        (("house.mem", "out.mem", "--form", "core"), "--form core writes several; name a folder"),
        (("house.mem", "out", "--form", "core", "--config", "pico"), "no such configuration; name one of tiny"),
        (("house.mem", "out.coe", "--config", "tiny"), "--config and --size are of --form core"),
        (("house.mem", "house.obj/out", "--form", "core"), "is a file, not a folder"),
        (("house.mem", "out", "--form", "core", "--size", "4096x8"), "are more than the configuration tiny renders"),
    ):
        voxrt.fails(2, message, "convert", *arguments)
    assert not (built / "out").exists()


def test_a_memory_that_does_not_fit(voxrt, folder):
    (folder / "deep.mem").write_text("FFFFFF01\n")
    command = ("convert", "deep.mem", "out", "--form", "core", "--config", "octo", "--depth", "11")
    problem = "deep: 1 words and 11 levels, and the configuration octo holds 32,769 words"
    assert "--depth 10, or with --budget 32769" in voxrt.fails(4, problem, *command).error
    assert not (folder / "out").exists()
