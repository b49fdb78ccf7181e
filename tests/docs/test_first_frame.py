"""The page "Your first frame": its code draws on the simulated core what the exact model does, and writes boot.hex."""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from oracles.first_frame import MEMORY, SIZE, expected_frame, read_writes

from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.rtl.configurations import RTL

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "first_frame.md").read_text()
STATUS = REGISTERS["status"][0]

SHIM = """
#include <stdint.h>
void (*on_write_register)(uint32_t, uint32_t);
uint32_t (*on_read_register)(uint32_t);
void (*on_write_word)(uint32_t, uint32_t);
void write_register(uint32_t address, uint32_t value) { on_write_register(address, value); }
uint32_t read_register(uint32_t address) { return on_read_register(address); }
void write_word(uint32_t word, uint32_t value) { on_write_word(word, value); }
"""


def code(language: str) -> str:
    (block,) = re.findall(rf"^```{language}\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    return block


class Connected:
    """The three functions that the page asks for, on a simulated core; keeps the writes."""

    def __init__(self):
        rtl = pytest.importorskip(
            "voxrt.sim._rtl", reason="this build has no verilated ray tracer", exc_type=ImportError
        )
        self.core = rtl.Core("tiny")
        self.core.expect(*SIZE)
        self.writes = []

    def write_register(self, address, value):
        self.writes.append((address, value))
        self.core.write(address, value)

    def read_register(self, address):
        self.core.run(64)
        return self.core.read(address)

    def write_word(self, word, value):
        self.writes.append((MEMORY + 4 * word, value))
        self.core.write_memory(word, np.array([value], np.uint32))

    def stream(self):
        return np.ascontiguousarray(self.core.frame()).tobytes()


@pytest.fixture
def connected():
    return Connected()


@pytest.fixture(scope="module")
def expected():
    return expected_frame()


def test_the_python_code(connected, expected):
    page = {}
    exec(compile(code("python"), "first_frame.md", "exec"), page)
    assert page["first_frame"](connected.write_register, connected.read_register, connected.write_word) == 0
    np.testing.assert_array_equal(page["to_rgb"](connected.stream()), expected)
    assert connected.writes == [*read_writes(), (STATUS, 2)]


@pytest.mark.skipif(shutil.which("cc") is None, reason="there is no C compiler")
def test_the_c_code(connected, expected, tmp_path):
    (tmp_path / "page.c").write_text(code("c"))
    (tmp_path / "shim.c").write_text(SHIM)
    build = ["cc", "-std=c11", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", f"-I{RTL / 'generated'}"]
    built = subprocess.run(
        [*build, "-o", "page.so", "page.c", "shim.c"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert (built.returncode, built.stderr) == (0, "")
    page = ctypes.CDLL(str(tmp_path / "page.so"))
    word = ctypes.c_uint32
    substitutes = {
        "on_write_register": ctypes.CFUNCTYPE(None, word, word)(connected.write_register),
        "on_read_register": ctypes.CFUNCTYPE(word, word)(connected.read_register),
        "on_write_word": ctypes.CFUNCTYPE(None, word, word)(connected.write_word),
    }
    for name, function in substitutes.items():
        ctypes.c_void_p.in_dll(page, name).value = ctypes.cast(function, ctypes.c_void_p).value
    page.first_frame.restype = word
    assert page.first_frame() == 0
    picture = np.zeros((24, 32, 3), np.uint8)
    page.to_rgb(connected.stream(), picture.ctypes.data_as(ctypes.c_char_p))
    np.testing.assert_array_equal(picture, expected)
    assert connected.writes == [*read_writes(), (STATUS, 2)]


def test_the_table_of_writes_is_that_of_the_registers():
    rows = re.findall(r"^\|[^|\n]*\| `0x(\w{3})`[^|\n]*\| `(\w+)` \|", PAGE, re.MULTILINE)
    starts = {name.removesuffix("[0]"): address for name, (address, _) in REGISTERS.items()} | {"materials": MATERIALS}
    assert len(rows) == 15
    assert [(int(address, 16), name) for address, name in rows] == [(starts[name], name) for _, name in rows]
