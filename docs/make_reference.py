"""Write the pages of the Python reference, docs/reference/, one per package.

``docs/conf.py`` runs it when the manual is built. A page lists what its package exports: the names in its ``__all__``.
A package or module without ``__all__`` exports the public classes and functions that its modules define. No name is
listed by hand, so that the reference cannot miss one.
"""

from __future__ import annotations

import ast
import inspect
import pkgutil
from importlib import import_module
from itertools import pairwise
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path
    from types import ModuleType

FRONT = "voxrt"
PACKAGES = (
    "voxrt.voxelize",
    "voxrt.voxelize.authoring",
    "voxrt.octree",
    "voxrt.export",
    "voxrt.sim",
    "voxrt.view",
    "voxrt.board",
    "voxrt.serve",
)


def exports(package: str) -> list[str]:
    """Give the full names that a package or a module exports, each as it is imported."""
    module = import_module(package)
    if hasattr(module, "__all__"):
        return [f"{package}.{name}" for name in module.__all__]
    return [f"{each.__name__}.{name}" for each in _modules(module) for name in _own_names(each)]


def _modules(module: ModuleType) -> list[ModuleType]:
    if not hasattr(module, "__path__"):
        return [module]
    names = [info.name for info in pkgutil.walk_packages(module.__path__, f"{module.__name__}.")]
    return [import_module(name) for name in names if not any(part.startswith("_") for part in name.split("."))]


def _own_names(module: ModuleType) -> list[str]:
    return [
        name
        for name, value in vars(module).items()
        if not name.startswith("_")
        and (inspect.isclass(value) or inspect.isfunction(value))
        and value.__module__ == module.__name__
    ]


def _value(name: str) -> object:
    module, _, attribute = name.rpartition(".")
    return getattr(import_module(module), attribute)


def _kind(name: str) -> str:
    value = _value(name)
    if inspect.isclass(value):
        return "Exceptions" if issubclass(value, BaseException) else "Classes"
    return "Functions" if inspect.isroutine(value) else "Constants and types"


def _constant_text(name: str) -> str:
    """Give the text that follows a constant where it is assigned; packages import it from there."""
    package, _, attribute = name.rpartition(".")
    module = import_module(package)
    tree = ast.parse(inspect.getsource(module))
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and any(alias.name == attribute for alias in node.names):
            return _constant_text(f"{node.module}.{attribute}")
    lines = []
    for node, after in pairwise(tree.body):
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        if any(isinstance(target, ast.Name) and target.id == attribute for target in targets) and (
            isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
        ):
            lines = inspect.cleandoc(str(after.value.value)).splitlines()
    value = repr(_value(name))
    shown = [f"   Value: ``{value}``", ""] if len(value) < 100 and " at 0x" not in value else []
    return "\n".join([*(f"   {line}" for line in lines), "", *shown])


def _entry(name: str) -> str:
    kind = _kind(name)
    if kind == "Functions":
        return f".. autofunction:: {name}\n"
    if kind == "Constants and types":
        return f".. py:data:: {name}\n\n{_constant_text(name)}"
    return f".. autoclass:: {name}\n   :members:\n"


def page(package: str, listed: dict[int, str] | None = None) -> str:
    """Give the text of a package's page. What other pages describe, `listed` by its identity, it only refers to."""
    names = exports(package)
    rooms = [name for name in names if inspect.ismodule(_value(name))]
    elsewhere = {name: listed[id(_value(name))] for name in names if listed and id(_value(name)) in listed}
    here = [name for name in names if name not in elsewhere and name not in rooms]
    lines = [package, "=" * len(package), "", f".. automodule:: {package}", "   :no-members:", ""]
    summarized = [name.removeprefix(f"{package}.") for name in here if _kind(name) != "Constants and types"]
    if summarized:
        lines += [".. autosummary::", "", *(f"   {name}" for name in summarized), ""]
    if rooms:
        lines += ["Packages:", "", *(f"- :doc:`{name}`" for name in rooms), ""]
    if elsewhere:
        lines += ["Also here, and described with their packages:", ""]
        roles = {"Functions": "func", "Classes": "class", "Exceptions": "exc", "Constants and types": "data"}
        lines += [f"- ``{name}``: :py:{roles[_kind(name)]}:`{home}`" for name, home in elsewhere.items()] + [""]
    for kind in ("Functions", "Classes", "Exceptions", "Constants and types"):
        chosen = [name for name in here if _kind(name) == kind]
        if chosen:
            lines += [kind, "-" * len(kind), "", *(_entry(name) for name in chosen)]
    return "\n".join(lines) + "\n"


def pages() -> dict[str, str]:
    """Give the text of every page by its package's name."""
    listed = {id(_value(name)): name for package in reversed(PACKAGES) for name in exports(package)}
    return {FRONT: page(FRONT, listed)} | {package: page(package) for package in PACKAGES}


def write(folder: Path) -> None:
    """Write every page that is not there yet as it should be."""
    folder.mkdir(exist_ok=True)
    wanted = {folder / f"{package}.rst": text for package, text in pages().items()}
    for old in set(folder.glob("voxrt*.rst")) - set(wanted):
        old.unlink()
    for path, text in wanted.items():
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
