"""Validation of ``scene.toml``: the schema's values, or one line that says what is wrong and where."""

from __future__ import annotations

import difflib
import json
import re
import tomllib
from typing import TYPE_CHECKING, Any

import msgspec

from voxrt.voxelize.authoring.scene_toml.positions import key_lines, longest_key
from voxrt.voxelize.authoring.scene_toml.schema import SHAPES, File, MaterialEntry, Node
from voxrt.voxelize.errors import AssetError

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.voxelize.authoring.scene_toml.positions import Path as KeyPath

DEEPEST = 40
"""The most levels of shapes within shapes."""

MOST_PARTS = DEEPEST + 8
"""The most parts of a dotted key."""

_UNKNOWN = re.compile(r"Object contains unknown field `(?P<key>.*)`")
_AT = re.compile(r" - at `\$(?P<path>.*)`$")
_STEP = re.compile(r"\.([^.\[\]]+)|\[(\d+|\.\.\.)\]")
_TOML_PLACE = re.compile(r"^(?P<problem>.*?) \(at (?:line (?P<line>\d+), column \d+|end of document)\)$", re.DOTALL)


class CheckedFile:
    """The path and the values of a valid file, and the line of each value."""

    def __init__(self, path: Path, values: File, lines: dict[KeyPath, int]) -> None:
        self.path = path
        self.values = values
        self._lines = lines

    def error(self, where: KeyPath, problem: str, fix: str = "") -> AssetError:
        """Return an error at the key or item `where`, or at the table that holds it."""
        return _error(self.path, self._lines, where, problem, fix)


def check_file(path: Path, text: str) -> CheckedFile:
    """Parse and check a scene file; raise AssetError where it is not TOML, or does not match the schema."""
    longest = longest_key(text)
    if longest.parts > MOST_PARTS:  # the library's memory grows with their square
        raise AssetError(
            path, f"a key has {longest.parts} parts", place=f"line {longest.line}", fix=f"use {MOST_PARTS} at most"
        )
    try:
        raw = tomllib.loads(text)
        lines = key_lines(text)
    except tomllib.TOMLDecodeError as error:
        match = _TOML_PLACE.match(str(error))
        line = match["line"] if match else None
        problem = " ".join((match["problem"] if match else str(error)).split())
        place = f"line {line}" if line else "at its end"
        opened = _open_inline_table(text, int(line) if line else text.count("\n") + 1)
        if opened:
            raise AssetError(
                path,
                "an inline table { … } goes on over the end of its line",
                place=f"line {opened}",
                fix="write it on one line, or as a table of its own below a header in brackets",
            ) from None
        raise AssetError(path, _lower(problem), place=place, fix="correct the TOML") from None
    except RecursionError:
        raise AssetError(path, "its values are nested too deeply", fix="flatten them") from None
    except ValueError as error:  # an integer of thousands of digits
        raise AssetError(path, _lower(str(error)), fix="correct the number") from None
    if max(map(len, lines), default=0) > 2 * DEEPEST:
        raise AssetError(path, f"shapes are nested more than {DEEPEST} levels deep", fix="flatten them")
    if isinstance(raw.get("objects"), dict):
        problem = "[objects] is one table, and objects are a list"
        raise _error(path, lines, ("objects",), problem, "write [[objects]], once for each object")
    try:
        values = msgspec.convert(raw, File)
    except msgspec.ValidationError as error:
        raise _explained(path, lines, raw, str(error)) from None
    checked = CheckedFile(path, values, lines)
    for index, node in enumerate(values.objects):
        _check_shapes(checked, node, ("objects", index))
    return checked


def _open_inline_table(text: str, line: int) -> int | None:
    """Return the line of an inline table that is not closed on its line, at or above `line`; None where there is none.

    Before 1.1, TOML has no such tables, and its parsers' messages speak of what they expect instead.
    """
    for number, content in reversed(list(enumerate(text.split("\n")[:line], start=1))):
        bare = _QUOTED.sub("", content).partition("#")[0]
        if bare.count("{") > bare.count("}"):
            return number
        if bare.lstrip().startswith("[") and "=" not in bare:  # a header: what is above it is whole
            return None
    return None


_QUOTED = re.compile(r""""(?:[^"\\]|\\.)*"|'[^']*'""")


def _check_shapes(checked: CheckedFile, node: Node, where: KeyPath) -> None:
    shapes = [key for key in SHAPES if getattr(node, key) is not None]
    if not shapes:
        raise checked.error(where, "has no shape", f"add one of {', '.join(SHAPES)}")
    if len(shapes) > 1:
        raise checked.error(
            (*where, shapes[1]), f"is both {shapes[0]} and {shapes[1]}", "make two objects, or a group of both"
        )
    inner = getattr(node, shapes[0])
    if isinstance(inner, list):
        for index, one in enumerate(inner):
            _check_shapes(checked, one, (*where, shapes[0], index))


def _explained(path: Path, lines: dict[KeyPath, int], raw: dict[str, Any], message: str) -> AssetError:
    at = _AT.search(message)
    problem = message[: at.start()] if at else message
    where = _resolved(at["path"] if at else "", raw, problem)
    unknown = _UNKNOWN.match(problem)
    if unknown:
        key = unknown["key"]
        known = _known_keys(where)
        near = difflib.get_close_matches(key, known, n=1)
        fix = f"did you mean {near[0]!r}?" if near else f"use {', '.join(known)}"
        return _error(path, lines, (*where, key), f"unknown key {key!r}", fix)
    if problem.startswith("Expected `object") and where and isinstance(where[-1], str):
        value = _value_at(raw, where)
        if where[-1] == "asset" and isinstance(value, str):
            return _error(path, lines, where, "asset is a table", f"write asset = {{ file = {json.dumps(value)} }}")
        return _error(path, lines, where, f"{where[-1]} is a table", f"write {where[-1]} = {{ … }}, with its keys")
    return _error(path, lines, where, f"{_dotted(where)}{_lower(problem)}", "correct the value")


def _resolved(dotted: str, raw: dict[str, Any], problem: str) -> KeyPath:
    """Return the keys of msgspec's path; msgspec writes ``[...]`` for any key of a dictionary."""
    where: list[str | int] = []
    for name, index in _STEP.findall(dotted):
        if index == "...":
            where.append(_culprit(_value_at(raw, tuple(where)), tuple(where), problem))
        else:
            where.append(int(index) if index else name)
    return tuple(where)


def _value_at(raw: Any, where: KeyPath) -> Any:  # noqa: ANN401 -- TOML holds anything
    for step in where:
        raw = raw[step]
    return raw


def _culprit(table: dict[str, Any], where: KeyPath, problem: str) -> str:
    """Return the entry of a dictionary that gives the same error by itself."""
    kind = _dictionary_values(where)
    for key, value in table.items():
        try:
            msgspec.convert(value, kind)
        except msgspec.ValidationError as error:
            if str(error).startswith(problem):
                return key
    return next(iter(table))


def _dictionary_values(where: KeyPath) -> Any:  # noqa: ANN401 -- a type expression
    return MaterialEntry if where == ("materials",) else str


def _known_keys(where: KeyPath) -> list[str]:
    """Return the keys of the table at `where`."""
    kind: Any = msgspec.inspect.type_info(File)
    for step in where:
        kind = _inner(kind, step)
    return [field.encode_name for field in _struct(kind).fields]


def _struct(kind: Any) -> Any:  # noqa: ANN401 -- msgspec's type information
    options = getattr(kind, "types", (kind,))
    return next(one for one in options if isinstance(one, msgspec.inspect.StructType))


def _inner(kind: Any, step: str | int) -> Any:  # noqa: ANN401
    for one in getattr(kind, "types", (kind,)):
        if isinstance(one, msgspec.inspect.StructType):
            return next(field.type for field in one.fields if field.encode_name == step)
        if isinstance(one, msgspec.inspect.ListType) and isinstance(step, int):
            return one.item_type
        if isinstance(one, msgspec.inspect.DictType):
            return one.value_type
    raise LookupError(step)


def _error(path: Path, lines: dict[KeyPath, int], where: KeyPath, problem: str, fix: str) -> AssetError:
    while where and where not in lines:
        where = where[:-1]
    place = f"line {lines[where]}" if where else ""
    return AssetError(path, problem, place=place, fix=fix)


def _dotted(where: KeyPath) -> str:
    return f"{where[-1]}: " if where and isinstance(where[-1], str) else ""


def _lower(text: str) -> str:
    return text[:1].lower() + text[1:]
