"""What the repository tracks: no results, no large files, nothing new at its top level."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]

FOLDERS = {
    ".ci",
    ".github",
    "bench",
    "blender",
    "board",
    "docs",
    "examples",
    "export",
    "octree",
    "rtl",
    "serve",
    "sim",
    "tests",
    "view",
    "voxelize",
    "voxrt",
    "web",
}

LARGEST = 1 << 20
"""Bytes. The largest file is a placed design of a board, 0.86 MB; a build's result is seldom as small."""


@pytest.fixture(scope="module")
def tracked() -> list[Path]:
    """The tracked files that exist, relative to the root."""
    git = shutil.which("git")
    if git is None or not (ROOT / ".git").exists():
        pytest.skip("needs git and a checkout: a source archive has no list of tracked files")
    listed = subprocess.run([git, "-C", ROOT, "ls-files", "-z"], capture_output=True, text=True, check=False)
    if listed.returncode:
        pytest.skip(f"git lists no files here: {listed.stderr.strip()}")
    paths = [Path(name) for name in listed.stdout.split("\0") if name]
    return [path for path in paths if (ROOT / path).is_file()]


def test_the_top_level_has_only_the_rooms(tracked: list[Path]) -> None:
    assert {path.parts[0] for path in tracked if len(path.parts) > 1} == FOLDERS


def test_no_large_file_is_tracked(tracked: list[Path]) -> None:
    assert [str(path) for path in tracked if (ROOT / path).stat().st_size > LARGEST] == []
