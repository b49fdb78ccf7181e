"""The boards' own package, `pip install ./board`: its wheel, its modules without voxrt, and Python 3.10."""

from __future__ import annotations

import ast
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SETTINGS = tomllib.loads((ROOT / "board" / "pyproject.toml").read_text(encoding="utf-8"))
PACKAGES = {
    name: (ROOT / "board" / folder).resolve() for name, folder in SETTINGS["tool"]["setuptools"]["package-dir"].items()
}
SOURCES = [path for folder in PACKAGES.values() for path in sorted(folder.glob("*.py"))]

NEWER_THAN_3_10 = {
    "asyncio": {"TaskGroup", "Runner", "timeout", "timeout_at", "Barrier"},
    "contextlib": {"chdir"},
    "datetime": {"UTC"},
    "enum": {"StrEnum", "ReprEnum", "EnumType", "verify"},
    "hashlib": {"file_digest"},
    "itertools": {"batched"},
    "typing": {
        "Self", "Never", "LiteralString", "NotRequired", "Required", "Unpack", "TypeVarTuple", "assert_never",
        "assert_type", "reveal_type", "dataclass_transform", "override", "TypeAliasType", "get_overloads",
    },
    "collections.abc": {"Buffer"},
    "operator": {"call"},
    "math": {"cbrt", "exp2", "sumprod"},
}  # fmt: skip
NEWER_MODULES = {"tomllib", "wsgiref.types"}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    pytest.importorskip("setuptools", "77", reason="building the wheel needs setuptools: pip install 'setuptools>=77'")
    folder = tmp_path_factory.mktemp("board")
    for source in PACKAGES.values():  # a copy, because setuptools writes beside the sources
        ignored = shutil.ignore_patterns("__pycache__", "build", "*.egg-info")
        shutil.copytree(source, folder / source.relative_to(ROOT), ignore=ignored)
    command = [sys.executable, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "--no-index", "--quiet"]
    built = subprocess.run(
        [*command, "-w", folder / "wheels", folder / "board"], capture_output=True, text=True, check=False
    )
    assert built.returncode == 0, built.stderr
    (found,) = (folder / "wheels").iterdir()
    return found


def test_contents(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    modules = {name for name in names if name.endswith(".py")}
    assert modules == {
        f"{name.replace('.', '/')}/{path.name}" for name, folder in PACKAGES.items() for path in folder.glob("*.py")
    }
    page = {f"voxrt_board/serve/page/{path.name}" for path in (ROOT / "serve" / "page").iterdir()}
    assert {name for name in names if "/page/" in name} == page


def test_without_voxrt(wheel, tmp_path):
    """Every module is imported, and the command runs, in an interpreter that finds no voxrt."""
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
        modules = [name[:-3].replace("/", ".") for name in archive.namelist() if name.endswith(".py")]
        (entry,) = (name for name in archive.namelist() if name.endswith("entry_points.txt"))
        assert "voxrt-board = voxrt_board.serve.__main__:main" in archive.read(entry).decode()
    script = f"""
import importlib, sys
sys.path.insert(0, {str(tmp_path)!r})
class NoVoxrt:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] == "voxrt":
            raise ModuleNotFoundError(name)
sys.meta_path.insert(0, NoVoxrt())
for name in {modules!r}:
    assert importlib.import_module(name).__file__.startswith({str(tmp_path)!r}), name
assert "voxrt" not in sys.modules
from voxrt_board.serve.page_files import load_page_files
assert b"<canvas" in load_page_files()["/"].data
from voxrt_board.serve.__main__ import main
sys.argv = ["voxrt-board", "--help"]
main()
"""
    ran = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.startswith("usage: voxrt-board")
    script = script.replace('"--help"]', '"voxrt.bit"]').replace("\nmain()", "\nsys.exit(main())")
    ran = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert ran.returncode == 1
    assert ran.stderr.startswith("voxrt-board: error: this machine has no package pynq")


def test_version():
    main = (ROOT / "voxrt" / "__init__.py").read_text(encoding="utf-8")
    assert SETTINGS["project"]["version"] == re.search(r'^__version__ = "(.+)"$', main, re.MULTILINE)[1]


@pytest.mark.parametrize("path", SOURCES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_python_3_10(path):
    """The syntax is that of Python 3.10, and no name that a later version added is used."""
    tree = ast.parse(path.read_text(encoding="utf-8"), feature_version=(3, 10))
    modules = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                assert alias.name not in NEWER_MODULES, alias.name
                modules[alias.asname or alias.name] = alias.name
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            assert node.module not in NEWER_MODULES, node.module
            newer = NEWER_THAN_3_10.get(node.module, set())
            assert not newer & {alias.name for alias in node.names}, f"line {node.lineno}"
        elif isinstance(node, ast.ExceptHandler):
            # Until 3.11, asyncio and sockets raised errors of their own that are no TimeoutError.
            assert not (isinstance(node.type, ast.Name) and node.type.id == "TimeoutError"), f"line {node.lineno}"
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in modules:
            newer = NEWER_THAN_3_10.get(modules[node.value.id], set())
            assert node.attr not in newer, f"line {node.lineno}: {node.value.id}.{node.attr}"
    assert "ExceptionGroup" not in {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    assert not any(isinstance(node, getattr(ast, "TryStar", ())) for node in ast.walk(tree))


def test_the_check_of_names_finds_newer_ones(tmp_path):
    for text in (
        "from typing import Self",
        "import asyncio\nasyncio.timeout(1)",
        "import datetime as d\nd.UTC",
        "import tomllib",
        "try:\n    pass\nexcept* ValueError:\n    pass",
        "def first[T](values: list[T]) -> T: ...",
    ):
        path = tmp_path / "newer.py"
        path.write_text(text)
        with pytest.raises((AssertionError, SyntaxError)):
            test_python_3_10(path)
