"""Bytes of columns: what instructions of the processor make of them, and plain C++, against loops over voxels."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.skipif(not shutil.which("c++"), reason="no C++ compiler")
@pytest.mark.parametrize("without", [[], ["-U__SSE2__"]], ids=["instructions", "plain"])
def test_bytes_of_columns_are_the_voxels(tmp_path, without):
    (tmp_path / "voxrt").mkdir()
    (tmp_path / "voxrt" / "voxelize").symlink_to(ROOT / "voxelize" / "src")
    program = tmp_path / "bytes"
    source = Path(__file__).parent / "native" / "bytes.cpp"
    command = [
        "c++",
        "-std=c++20",
        "-O1",
        "-Wall",
        "-Wextra",
        "-Werror",
        *without,
        "-I",
        tmp_path,
        source,
        "-o",
        program,
    ]
    subprocess.run(command, check=True)
    subprocess.run([program], check=True)
