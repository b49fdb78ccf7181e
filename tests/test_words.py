"""Words that the project has given up, and sentences that say "a" where they mean "per", stay out of it."""

from __future__ import annotations

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

RETIRED = {
    r"(cycles?|clocks?) a (pixel|ray|frame)": "cycles per pixel",
    r"words a (ray|pixel)": "words per ray",
    r"(frames|rays|pixels|words|megabytes|steps) a second": "frames per second",
    r"(rays|words|pixels) a (cycle|clock)": "rays per cycle",
    r"words? a line": "words per line",
    r"voxels a side": "voxels per side",
    r"voxrt_pixel_generator": "voxrt_core",
    r"voxrt_lane_turn|lane turn": "slot scheduler",
    r"\blight_way\b": "light direction",
    r"\bhas_place\b": "grant",
    r"\bAscent\b": "OctreeBuilder",
    r"stand[_-]ins?\b": "representatives (budget), proxies (colliders), fakes (tests)",
    r"\b_?Wardrobe\b|\b(Coat|Dress)\b": "surface appearance, material map",
    r"\bput_on\b|\bhunger\b": "load, wait until ready",
    r"\bAudience\b": "Clients",
}
"""What is retired, as a pattern, and what is said instead."""

ALLOWED: dict[str, str] = {
    "CHANGELOG.md": "it tells what former versions were called",
    "tests/test_words.py": "the list",
}


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


@pytest.mark.parametrize(("pattern", "instead"), RETIRED.items())
def test_retired_words_are_gone(pattern, instead):
    retired = re.compile(pattern)
    found = [
        f"{path.relative_to(ROOT)}:{number}: {match.group()}: say {instead}"
        for path in own_texts()
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1)
        if (match := retired.search(line))
    ]
    assert found == []
