"""The agent's file: its Python is that of old boards, it needs nothing but `pynq`, and `pip` installs it."""

from __future__ import annotations

import ast
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

AGENT = Path(__file__).resolve().parents[2] / "board" / "agent"
SOURCE = AGENT / "voxrt_board.py"
NEWER_THAN_3_8 = {"removeprefix", "removesuffix", "cache", "pairwise", "bit_count", "timeout_at", "TaskGroup"}


def test_python_3_8():
    tree = ast.parse(SOURCE.read_text(encoding="utf-8"), feature_version=(3, 8))
    nodes = list(ast.walk(tree))
    assert not NEWER_THAN_3_8 & {node.attr for node in nodes if isinstance(node, ast.Attribute)}
    # `strict` of zip came with 3.10; annotations are the one place for `X | Y` and `list[int]`, since they do not run.
    assert not any(isinstance(node, ast.keyword) and node.arg == "strict" for node in nodes)
    assert any(isinstance(node, ast.ImportFrom) and node.module == "__future__" for node in nodes)


def test_it_imports_the_standard_library_alone():
    modules = set()
    for node in ast.walk(ast.parse(SOURCE.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            modules.add(node.module)
    assert modules <= sys.stdlib_module_names


def test_it_stays_small():
    assert len(SOURCE.read_text(encoding="utf-8").splitlines()) < 250


def test_the_package(tmp_path):
    pytest.importorskip("setuptools", reason="building the wheel needs setuptools")
    shutil.copytree(AGENT, tmp_path / "agent", ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
    pip = [sys.executable, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "--no-index", "--quiet"]
    subprocess.run([*pip, "-w", tmp_path, tmp_path / "agent"], check=True, capture_output=True, text=True)
    (wheel,) = tmp_path.glob("*.whl")
    with zipfile.ZipFile(wheel) as archive:
        assert {name for name in archive.namelist() if "dist-info" not in name} == {"voxrt_board.py"}
        (entry,) = (name for name in archive.namelist() if name.endswith("entry_points.txt"))
        assert "voxrt-board = voxrt_board:main" in archive.read(entry).decode()


def test_the_file_by_itself(tmp_path):
    """A copy of it runs where there is no voxrt, and says in one line that this is no board."""
    shutil.copy(SOURCE, tmp_path)
    run = [sys.executable, "-I", tmp_path / SOURCE.name, "voxrt.bit", "--port", "0"]
    finished = subprocess.run(run, capture_output=True, text=True, check=False)
    assert finished.returncode == 1
    assert finished.stderr.startswith("voxrt-board: error: voxrt.bit: no ray tracer")
    assert finished.stderr.count("\n") == 1
