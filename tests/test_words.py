"""Plain English: "per" and not "a" in rates, comments with a subject, nouns as names of variables."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("voxrt", "voxelize", "octree", "export", "rtl", "sim", "view", "board", "serve", "web", "bench", "docs")
MORE_FOLDERS = ("examples", "tests", ".github")
TEXTS = {".py", ".pyi", ".md", ".rst", ".toml", ".yml", ".html", ".js", ".cpp", ".h", ".sv", ".rdl", ".json", ".txt"}
GENERATED = (
    *(f"docs/{folder}" for folder in ("gallery", "study", "measured", "reference", "walk/pictures")),
    "rtl/generated",
    "bench/results",
)

RATES = {
    r"(cycles?|clocks?) a (pixel|ray|frame)": "cycles per pixel",
    r"words a (ray|pixel)": "words per ray",
    r"(frames|rays|pixels|words|megabytes|steps) a second": "frames per second",
    r"(rays|words|pixels) a (cycle|clock)": "rays per cycle",
    r"words? a line": "words per line",
    r"voxels a side": "voxels per side",
}
"""Patterns of rates, and the words to write."""

NO_NOUNS = {"told", "said", "asked", "given"}
"""Words that no variable, parameter or function has for a name."""

ALLOWED: dict[str, str] = {"CHANGELOG.md": "it quotes former versions", "tests/test_words.py": "it has the patterns"}


def own_texts() -> list[Path]:
    places = [*ROOT.glob("*")]
    for folder in (*FOLDERS, *MORE_FOLDERS):
        places += (ROOT / folder).rglob("*")
    return sorted(
        path
        for path in places
        if path.suffix in TEXTS
        and path.is_file()
        and "__pycache__" not in path.parts
        and not any(parent.is_symlink() for parent in (path, *path.parents))
        and path.relative_to(ROOT).as_posix() not in ALLOWED
        and not path.relative_to(ROOT).as_posix().startswith(GENERATED)
    )


def violations(pattern, advice, paths):
    rule = re.compile(pattern)
    return [
        f"{path.relative_to(ROOT)}:{number}: {match.group()}: {advice}"
        for path in paths
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if (match := rule.search(line))
    ]


@pytest.mark.parametrize(("pattern", "advice"), RATES.items())
def test_rates_say_per(pattern, advice):
    assert violations(pattern, advice, own_texts()) == []


def own_code() -> list[Path]:
    return [path for path in own_texts() if path.suffix in {".py", ".pyi"}]


def test_comments_begin_with_their_subject():
    assert violations(r"(?:# |\"\"\")Of ", "begin the comment with its subject", own_code()) == []


def test_names_are_nouns():
    kept = {ast.Name: "id", ast.arg: "arg", ast.FunctionDef: "name"}
    assert [
        f"{path.relative_to(ROOT)}:{node.lineno}: name it by a noun"
        for path in own_code()
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if type(node) in kept
        and getattr(node, kept[type(node)]) in NO_NOUNS
        and not (isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load))
    ] == []
