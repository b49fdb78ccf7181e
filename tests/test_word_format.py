"""One file of each language knows the bits of an octree's words; no other product file has literals of them."""

from __future__ import annotations

import io
import re
import tokenize
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PRODUCT = (
    "voxrt",
    "voxelize",
    "octree",
    "export",
    "rtl",
    "sim",
    "view",
    "board",
    "serve",
    "web",
    "bench",
    "docs",
    "examples",
)
NOT_READ = ("rtl/benches/", "rtl/formal/", "rtl/generated/")
"""Benches and proofs have literals of their own, to check the homes. Masks of registers are generated."""

HOMES = {
    "Python": ((".py", ".pyi"), "octree/words.py"),
    "C++": ((".cpp", ".h"), "words.h"),
    "JavaScript": ((".js", ".mjs", ".html"), "words.js"),
    "SystemVerilog": ((".sv", ".svh", ".v"), "voxrt_pkg.sv"),
}
"""Language: endings of its files, and the end of its home's path."""

LITERALS = re.compile(
    r"(?:0x|32'h)(?:FF_?FF_?FF_?(?!FF)[0-9A-F]{2}|8000_?0000)(?![0-9A-F])"  # tags of the dialects
    r"|>>>? *31(?!\d)"  # is a word a leaf?
    r"|\bwords?\b[^;=&|>]{0,30}& *(?:0xFF|255)(?![0-9A-F])"  # its material
    r"|>> *8\)? *[!=]=+ *0xFFFFFF(?![0-9A-F])",  # is it a tag?
    re.IGNORECASE,
)

OTHER_BITS = {
    "board/designs/simulation/simulation.cpp": r"bits = word & 0xFF",  # a TMDS symbol
    "voxelize/src/faces/closed_surface.h": r"v \^ v >> 31",  # a hash
    "board/designs/serial_device.py": r"_board\(\) *>> 31",  # a register that tells whether the board plays
    "serve/legacy_server.py": r"words\[6\]& 0xFF",  # the background of the original's request
}
"""Files with other bits that look alike: their lines."""


def code_lines(path):
    """The lines of a file without comments, strings of Python, and so without the examples of docstrings."""
    text = path.read_text(encoding="utf-8")
    if path.suffix in {".py", ".pyi"}:
        lines = [""] * (text.count("\n") + 2)
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            if token.type not in {tokenize.COMMENT, tokenize.STRING}:
                lines[token.start[0]] += f" {token.string}"
        return [re.sub(r" ([])(.,[]) ?", r"\1", line) for line in lines[1:]]
    text = re.sub(r"/\*.*?\*/", lambda comment: "\n" * comment[0].count("\n"), text, flags=re.DOTALL)
    return [line.partition("//")[0] for line in text.splitlines()]


@pytest.mark.parametrize("language", HOMES)
def test_the_bits_of_words_stand_in_their_home_alone(language):
    suffixes, home = HOMES[language]
    found = []
    for folder in PRODUCT:
        for path in sorted((ROOT / folder).rglob("*")):
            name = path.relative_to(ROOT).as_posix()
            if (
                path.suffix not in suffixes
                or name.endswith(home)
                or name.startswith(NOT_READ)
                or any(parent.is_symlink() for parent in (path, *path.parents))
                or "node_modules" in path.parts
            ):
                continue
            lines = code_lines(path)
            explained = re.compile(OTHER_BITS.get(name, "(?!)"))
            found += [
                f"{name}:{number}: {line.strip()}"
                for number, line in enumerate(lines, 1)
                if LITERALS.search(line) and not explained.search(line)
            ]
    assert not found, f"ask {home}:\n" + "\n".join(found)


@pytest.mark.parametrize(
    "line",
    [
        "EMPTY = 0xFFFFFF00",
        "tag = 0xffffff07u;",
        "32'hFFFF_FF00",
        "mask = 0x8000_0000",
        "if (word >>> 31)",
        "leaf = words>>31 == 1",
        "material = words[address] & 0xFF",
        "word >> 8 != 0xFFFFFF",
    ],
)
def test_literals_of_words_are_seen(line):
    assert LITERALS.search(line)


@pytest.mark.parametrize("line", ["value & 0xFFFFFFFF", "table & 0xFFFFFF", "row >> 16 & 0xFF", "x >> 310"])
def test_other_bits_are_not_taken_for_words(line):
    assert not LITERALS.search(line)
