"""A scene from ``NAME.mem`` and its manifest ``NAME.json``."""

from __future__ import annotations

import json
import re
import zlib
from typing import Any

import numpy as np

from ..board.errors import Refused
from ..board.scene import Scene, frame_period

_COMMENT = re.compile(rb"//[^\n]*|/\*.*?\*/", re.DOTALL)
_WORD = re.compile(rb"[0-9A-Fa-f]{1,8}")
_DIALECT_TAGS = {"report": 0xFFFFFF00, "seed-rtl": 0xFFFFFFF0, "msb": 0x80000000, "lod": 0xFFFFFF00}


def read_mem_files(name: str, mem: bytes, manifest: bytes) -> Scene:
    """Read the two files that ``voxrt build`` writes.

    Parameters
    ----------
    name
        Name of the scene.
    mem, manifest
        Bytes of the two files.

    Raises
    ------
    Refused
        A file is malformed, or the manifest describes another memory.
    """
    described = _manifest(manifest)
    try:
        depth, dialect, crc32 = described["depth"], described["dialect"], described["crc32"]
        rows = [(tuple(row["colour"]), row["mirror"]) for row in described["materials"]]
        colours, mirrors = np.zeros((256, 3), dtype=np.uint8), np.zeros(256, dtype=np.bool_)
        colours[: len(rows)] = np.array([colour for colour, _ in rows], dtype=np.uint8)
        mirrors[: len(rows)] = [mirror for _, mirror in rows]
        frames = (described.get("animation") or {"frames": [{"root": 0, "time": None}]})["frames"]
        roots, period = tuple(int(frame["root"]) for frame in frames), frame_period([one["time"] for one in frames])
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise Refused(f"{name}.json is no manifest of a memory ({error!r}); build the scene again") from None
    if not isinstance(depth, int) or dialect not in _DIALECT_TAGS:
        raise Refused(f"{name}.json names depth {depth!r} and dialect {dialect!r}; build the scene again")
    if f"{zlib.crc32(mem):08X}" != crc32:
        raise Refused(f"{name}.json describes another {name}.mem; build both again")
    tokens = _COMMENT.sub(b" ", mem).split()
    if not all(_WORD.fullmatch(token) for token in tokens):
        raise Refused(f"{name}.mem has a word that is not 8 hex digits; build the scene again")
    words = np.array([int(token, 16) for token in tokens], dtype=np.uint32)
    tag = _DIALECT_TAGS[dialect]
    if dialect == "lod":  # the mean materials are left out: no board shows them
        pointers = np.minimum(8 * (words >> 8).astype(np.uint64) + 1, 0x7FFFFFFF).astype(np.uint32)
        words = np.where(words >> 8 == 0xFFFFFF, words, pointers)
    leaf = words >> 31 == 1
    words[leaf] = words[leaf] & np.uint32(~tag & 0xFF) | np.uint32(0xFFFFFF00)
    return Scene(name, depth, words, colours, mirrors, roots=roots, period=period)


def _manifest(data: bytes) -> dict[str, Any]:
    try:
        described = json.loads(data)
    except (ValueError, RecursionError):
        described = None
    if not isinstance(described, dict):
        raise Refused("the .json of the memory is no manifest; build the scene again")
    return described
