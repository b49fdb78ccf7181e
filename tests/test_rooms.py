"""Which top-level folders ("rooms") may import which; no circle of imports anywhere."""

from __future__ import annotations

import ast
import re
import sys
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]

MAY_IMPORT = {
    "voxelize": set(),
    "octree": {"voxelize"},
    "export": {"voxelize", "octree"},
    "sim": {"voxelize", "octree", "export"},
    "view": {"voxelize", "octree", "export", "sim"},
    "board": {"voxelize", "octree", "export", "sim", "rtl"},
    "serve": {"voxelize", "octree", "export", "sim", "board"},
}
"""Room: the rooms that it may import, besides itself, and ``rtl`` for the registers; ``voxrt/`` may import all."""

INSIDE_VOXRT = ("options", "sources", "views", "plans", "building", "boards", "cli")
"""The folders of ``voxrt/``, each of which imports itself and those before it; modules beside them import none."""

INSIDE_CLI = ("terminal", "results", "schemas", "inputs", "line", "commands", "run", "start")
"""The folders and modules of ``voxrt/cli/``, in the same order."""

INSIDE_SOURCES = {
    "voxelize/src": (
        "work",
        "vectors",
        "grid",
        "rules",
        "scene",
        "coverage",
        "faces",
        "holes",
        "mesh",
        "tiles",
        "colour",
        "bindings",
    ),
    "octree/src": ("words", "pool", "build", "files", "query", "edit", "sight", "budget", "bindings"),
    "sim/src/model": ("rays", "frames", "views", "bindings"),
    "sim/src/bake": ("surface", "rays", "light", "bindings"),
}
"""The folders of C++ sources. A file includes its own folder, the folders before it, and the sources before these."""

INCLUDED_AS = {"voxelize": "voxelize/src", "octree": "octree/src", "sim": "sim/src/model", "bake": "sim/src/bake"}
"""What stands between ``<voxrt/`` and the folder in the name of a header."""

OUTSIDE = ("bench", "blender", "examples", "docs", "rtl", "tests")
"""Folders whose scripts import the rooms and each other. No room imports them, but for ``voxrt.rtl``."""


def module_of(path: Path) -> str:
    """The name by which a file of the repository is imported; scripts by their path."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    if parts[-1] == "__init__":
        parts = parts[:-1]
    return ".".join(parts if parts[0] in {"voxrt", *OUTSIDE} else ("voxrt", *parts))


def sources() -> dict[str, list[Path]]:
    """Every Python file of ours by its module's name, with its stub."""
    found: dict[str, list[Path]] = {}
    for folder in (*MAY_IMPORT, "voxrt", *OUTSIDE):
        for path in sorted((ROOT / folder).rglob("*.py*")):
            if path.suffix not in {".py", ".pyi"}:
                continue
            inside = path.relative_to(ROOT).parts
            if inside[0] == "voxrt" and len(inside) > 2 and inside[1] in MAY_IMPORT:
                continue  # the links to the rooms
            found.setdefault(module_of(path), []).append(path)
    return found


def imports_of(name: str, path: Path, known: dict[str, list[Path]]) -> set[str]:
    """The modules of ours that a file imports anywhere, also in functions and for types alone."""
    package = name if path.stem == "__init__" else name.rpartition(".")[0]
    found: set[str] = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = package.split(".")[: len(package.split(".")) - node.level + 1]
                base = ".".join([*above, base] if base else above)
            for alias in node.names:
                module = f"{base}.{alias.name}"
                found.add(module if module in known or module.removeprefix("voxrt.") in known else base)
    found = {module.removeprefix("voxrt.") if module.startswith("voxrt.rtl") else module for module in found}
    beside = path.parent.relative_to(ROOT).parts
    if beside and beside[0] in OUTSIDE:  # scripts import what stands beside them, or in the folder above
        paths = [".".join((*beside[:depth], module)) for depth in range(1, len(beside) + 1) for module in found]
        found |= set(paths)
    return {module for module in found if module in known and module != name}


@pytest.fixture(scope="module")
def graph():
    known = sources()
    return {name: set().union(*(imports_of(name, path, known) for path in paths)) for name, paths in known.items()}


def room_of(module: str) -> str:
    first, *rest = module.split(".")
    if first != "voxrt":
        return first
    return rest[0] if rest and rest[0] in MAY_IMPORT else "voxrt"


def test_the_reader_of_imports_sees_all_kinds(tmp_path, monkeypatch):
    monkeypatch.setattr(sys.modules[__name__], "ROOT", tmp_path)
    (tmp_path / "octree").mkdir()
    lines = (
        "from . import two",
        "from .three import x",
        "def f():",
        "    import voxrt.export.four",
        "if T:",
        "    from voxrt import sim",
    )
    (tmp_path / "octree" / "one.py").write_text("\n".join(lines))
    names = ["voxrt.octree.two", "voxrt.octree.three", "voxrt.export.four", "voxrt.sim", "voxrt"]
    known = dict.fromkeys(names, tmp_path)
    assert imports_of("voxrt.octree.one", tmp_path / "octree" / "one.py", known) == set(names) - {"voxrt"}


def test_rooms_import_in_one_direction(graph):
    wrong = [
        f"{name} imports {target}"
        for name, targets in graph.items()
        if room_of(name) in MAY_IMPORT
        for target in targets
        if room_of(target) not in MAY_IMPORT[room_of(name)] | {room_of(name)}
        and target not in {"voxrt", "voxrt.exports"}  # the package itself, and how a package names what it exports
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize(("above", "order"), [("voxrt", INSIDE_VOXRT), ("voxrt.cli", INSIDE_CLI)])
def test_the_folders_of_voxrt_import_in_one_direction(graph, above, order):
    def place(module: str) -> int:
        folder = module.removeprefix(f"{above}.").split(".")[0]
        return order.index(folder) if module.startswith(f"{above}.") and folder in order else -1

    wrong = [
        f"{name} imports {target}"
        for name, targets in graph.items()
        if name.startswith("voxrt.") and name not in {"voxrt.__main__", above}
        for target in targets
        if place(target) > place(name)
    ]
    assert not wrong, "\n".join(wrong)


def native_sources() -> list[Path]:
    return [
        path for root in INSIDE_SOURCES for path in sorted((ROOT / root).rglob("*")) if path.suffix in {".cpp", ".h"}
    ]


def includes_of(path: Path) -> set[Path]:
    """The files of ours that a C++ file includes."""
    found = set()
    for beside, room, rest in re.findall(
        r'^ *# *include (?:"(.+)"|<voxrt/(\w+)/(.+)>)$', path.read_text(encoding="utf-8"), re.MULTILINE
    ):
        found.add((path.parent / beside).resolve() if beside else ROOT / INCLUDED_AS[room] / rest)
    return found


def native_place(path: Path) -> tuple[int, int]:
    """The number of the sources that a C++ file is of, and that of its folder in them."""
    name = path.relative_to(ROOT).as_posix()
    number, root = next((i, root) for i, root in enumerate(INSIDE_SOURCES) if name.startswith(f"{root}/"))
    return number, INSIDE_SOURCES[root].index(path.parent.name)


def test_the_folders_of_cpp_sources_include_in_one_direction():
    files = native_sources()
    assert len(files) > 200
    graph = {path: includes_of(path) for path in files}
    wrong = [
        f"{path.relative_to(ROOT)} includes {target.relative_to(ROOT)}"
        for path, targets in graph.items()
        for target in targets
        if target not in graph or native_place(target) > native_place(path)
    ]
    assert not wrong, "\n".join(wrong)
    TopologicalSorter(graph).prepare()


def test_no_circle_of_imports(graph):
    # A package's own __init__ gathers names from its modules, and importing a module runs it: that is no circle
    # between files as long as no module takes a name from its own package.
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_every_room_is_a_link_of_the_package():
    for room in MAY_IMPORT:
        link = ROOT / "voxrt" / room
        assert link.is_symlink(), f"voxrt/{room} must be a relative link to ../{room}"
        assert link.readlink() == Path("..", room)
