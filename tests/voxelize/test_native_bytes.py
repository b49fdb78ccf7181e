"""Bytes of columns: what instructions of the processor make of them, and plain C++, against loops over voxels."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from voxrt.voxelize import _native

ROOT = Path(__file__).resolve().parents[2]


AVX2 = pytest.param(["-mavx2"], marks=pytest.mark.skipif("avx2" not in _native.INSTRUCTION_SETS, reason="no AVX2"))


@pytest.mark.skipif(not shutil.which("c++"), reason="no C++ compiler")
@pytest.mark.parametrize("options", [[], AVX2, ["-U__SSE2__"]], ids=["instructions", "avx2", "plain"])
def test_bytes_of_columns_are_the_voxels(tmp_path, options):
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
        *options,
        "-I",
        tmp_path,
        source,
        "-o",
        program,
    ]
    subprocess.run(command, check=True)
    subprocess.run([program], check=True)
