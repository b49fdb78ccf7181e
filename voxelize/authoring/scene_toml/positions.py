"""The line of each key and array item of a TOML file.

The standard library parses TOML without line numbers. This module scans a text that the library has accepted, so it
checks no syntax: it follows keys, nesting and line ends, and skips values.
"""

from __future__ import annotations

import re
import tomllib
from typing import NamedTuple, TypeAlias

Path: TypeAlias = "tuple[str | int, ...]"

_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
_SPACE = re.compile(r"[ \t]*")
_KEY = re.compile(r"""[ \t]*("(?:[^"\\\n]|\\.)*"|'[^'\n]*'|[A-Za-z0-9_-]+)[ \t]*""")
_STRING = re.compile(
    r'"""(?:[^\\]|\\.)*?"{3,5}(?!")'
    r"|'''.*?'{3,5}(?!')"
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|'[^'\n]*'",
    re.DOTALL,
)
_SCALAR = re.compile(r"[^,\]}#\n]+")


_STRING_OR_REST = (
    r'"""(?:[^\\]|\\(?:.|\Z))*?(?:"{3,5}(?!")|\Z)'  # what is not closed goes on to the end
    r"|'''.*?(?:'{3,5}(?!')|\Z)"
    r'|"(?:[^"\\\n]|\\.)*(?:"|$|\Z)'
    r"|'[^'\n]*(?:'|$|\Z)"
)
_TOKEN = re.compile(
    rf"(?P<part>{_STRING_OR_REST}|[A-Za-z0-9_-]+)|(?P<dot>\.)|[ \t]+|(?P<other>#[^\n]*|.)", re.DOTALL | re.MULTILINE
)


class LongKey(NamedTuple):
    """A dotted key: how many parts it has, and on which line, from 1."""

    parts: int
    line: int


def longest_key(text: str) -> LongKey:
    """Return the key of the most parts in a text that nobody has parsed yet; values count as keys."""
    longest = start = at_longest = parts = 0
    after_dot = False
    for token in _TOKEN.finditer(text):
        if token["part"]:
            parts = parts + 1 if after_dot else 1
            start = start if after_dot else token.start()
            if parts > longest:
                longest, at_longest = parts, start
            after_dot = False
        elif token["dot"]:
            after_dot = True
        elif token["other"]:
            after_dot = False
    return LongKey(longest, text.count("\n", 0, at_longest) + 1)


def key_lines(text: str) -> dict[Path, int]:
    """Return the line, from 1, of every key and array item of TOML that :func:`tomllib.loads` has parsed.

    Paths are names of tables and indices of array items: ``("objects", 2, "box", "size")``.
    """
    return _Walk(text.replace("\r\n", "\n")).lines()


class _Walk:
    def __init__(self, text: str) -> None:
        self._text = text
        self._at = 0
        self._line = 1
        self._counted = 0
        self._lines: dict[Path, int] = {}
        self._arrays: dict[Path, int] = {}

    def lines(self) -> dict[Path, int]:
        table: Path = ()
        self._skip(_BLANK)
        while self._at < len(self._text):
            if self._text[self._at] == "[":
                table = self._header()
            else:
                self._pair(table)
            self._skip(_BLANK)
        return self._lines

    def _here(self) -> int:
        self._line += self._text.count("\n", self._counted, self._at)
        self._counted = self._at
        return self._line

    def _skip(self, pattern: re.Pattern[str]) -> None:
        found = pattern.match(self._text, self._at)
        self._at = found.end() if found else self._at

    def _keys(self) -> list[str]:
        keys: list[str] = []
        while found := _KEY.match(self._text, self._at):
            raw = found[1]
            keys.append(next(iter(tomllib.loads(f"{raw}=0"))) if raw[0] in "\"'" else raw)
            self._at = found.end()
            if self._text[self._at : self._at + 1] != ".":
                break
            self._at += 1
        return keys

    def _note(self, path: Path) -> None:
        self._lines.setdefault(path, self._here())

    def _header(self) -> Path:
        array = self._text.startswith("[[", self._at)
        self._at += 2 if array else 1
        keys = self._keys()
        self._at = self._text.index("]", self._at) + (2 if array else 1)
        path: Path = ()
        for depth, key in enumerate(keys):
            path = (*path, key)
            self._note(path)
            if array and depth == len(keys) - 1:
                self._arrays[path] = self._arrays.get(path, -1) + 1
            if path in self._arrays:  # a table below an array of tables is below its last item
                path = (*path, self._arrays[path])
                self._note(path)
        return path

    def _pair(self, table: Path) -> None:
        path = table
        line_start = self._at
        for key in self._keys():
            path = (*path, key)
            self._note(path)
        self._at = self._text.index("=", max(self._at, line_start)) + 1
        self._skip(_SPACE)
        self._value(path)

    def _value(self, path: Path) -> None:
        first = self._text[self._at : self._at + 1]
        if first == "[":
            self._array(path)
        elif first == "{":
            self._inline_table(path)
        elif found := _STRING.match(self._text, self._at):
            self._at = found.end()
        else:
            self._skip(_SCALAR)

    def _array(self, path: Path) -> None:
        self._at += 1
        index = 0
        while True:
            self._skip(_BLANK)
            if self._text[self._at] == "]":
                break
            self._note((*path, index))
            self._value((*path, index))
            index += 1
            self._skip(_BLANK)
            if self._text[self._at] == ",":
                self._at += 1
        self._at += 1

    def _inline_table(self, path: Path) -> None:
        self._at += 1
        while True:
            self._skip(_BLANK)
            if self._text[self._at] == "}":
                break
            self._pair(path)
            self._skip(_BLANK)
            if self._text[self._at] == ",":
                self._at += 1
        self._at += 1
