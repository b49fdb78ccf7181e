"""Write the pages of the Python reference, docs/reference/, one per package.

``docs/conf.py`` runs it when the manual is built. A page lists what its package exports: the names in its ``__all__``.
A package or module without ``__all__`` exports the public classes and functions that its modules define. No name is
listed by hand, so that the reference cannot miss one.
"""

from __future__ import annotations

import ast
import inspect
import pkgutil
import re
from collections import Counter
from importlib import import_module
from itertools import chain, pairwise
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
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

TASKS = {
    "Build a memory": ("build", "BuildOptions", "BuildResult", "Bake", "BudgetFit", "InteriorFit", "BOARDS"),
    "Build an animation": ("build_animation", "frame_times", "animation_camera", "save_animation"),
    "Voxelize arrays and scenes": (
        "voxelize_mesh", "mesh_scene", "load", "Scene", "SceneWarning", "Material", "fit_grid", "Grid",
        "volume_fractions", "write_fractions",
    ),
    "Read, write and convert memories": (
        "read_rom", "read_any", "rom_info", "convert", "WRITABLE_SUFFIXES", "Rom", "Octree",
    ),
    "Edit a memory": ("World", "Box", "Sphere", "Capsule", "Patch", "pick", "run_edit_script"),
    "Make pictures": (
        "render", "RenderOptions", "Frame", "Picture", "save_picture", "aim_camera", "Camera", "Lighting",
    ),
    "Follow rays": ("follow_ray", "RayPath", "cast_rays", "RayHits"),
    "Compare": (
        "diff", "differing_regions", "Region", "compare", "comparison_sheet", "likeness_curve", "draw_likeness_curve",
        "LikenessAtDepth",
    ),
    "Simulate the hardware": ("check", "shader_features"),
}  # fmt: skip
"""What the names of the front page are for. Its packages and its exceptions are listed of themselves."""


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


_ROLES = {"Functions": "func", "Classes": "class", "Exceptions": "exc", "Constants and types": "data"}


def _value(name: str) -> object:
    module, _, attribute = name.rpartition(".")
    return getattr(import_module(module), attribute)


def _kind(name: str) -> str:
    value = _value(name)
    if inspect.isclass(value):
        return "Exceptions" if issubclass(value, BaseException) else "Classes"
    return "Functions" if inspect.isroutine(value) else "Constants and types"


def _constant_text(name: str) -> str:
    """Give the text that follows a constant where it is assigned; stubs of packages say where that is."""
    package, _, attribute = name.rpartition(".")
    module = import_module(package)
    stub = Path(f"{module.__file__}i")  # what a package exports stands there alone
    tree = ast.parse(stub.read_text(encoding="utf-8") if stub.exists() else inspect.getsource(module))
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


def task_map(homes: dict[str, str]) -> list[str]:
    """Give the lines that list the names of the front page by task; `homes`: what other pages describe.

    ValueError if the tasks do not name each of them once.
    """
    names = {name: _kind(f"{FRONT}.{name}") for name in import_module(FRONT).__all__}
    tasks = {**TASKS, "Errors": tuple(name for name, kind in names.items() if kind == "Exceptions")}
    packages = [name for name in names if inspect.ismodule(_value(f"{FRONT}.{name}"))]
    placed = Counter([*chain(*tasks.values()), *packages])
    if wrong := {name for name in {*names, *placed} if name not in names or placed[name] != 1}:
        raise ValueError(f"docs/make_reference.py: TASKS must name each export of voxrt once: {sorted(wrong)}")
    lines = ["By task", "-------", ""]
    for task, members in tasks.items():
        lines += [f".. rubric:: {task}", ""]
        for name in members:
            full = f"{FRONT}.{name}"
            home = homes.get(full, full)
            shown = f"``{full}``, " if home != full else ""
            lines.append(f"- {shown}:py:{_ROLES[names[name]]}:`{home}`: {_summary(full)}")
        lines.append("")
    return lines


def _summary(name: str) -> str:
    """Give the first sentence about a name, without links, whose names are short for the module that they are in."""
    text = _constant_text(name) if _kind(name) == "Constants and types" else inspect.getdoc(_value(name)) or ""
    first = re.split(r"(?<=[^.])\.(?=\s|$)", " ".join(text.split()))[0]
    return re.sub(r":\w+:`~?([^`<]+?)(?: <[^`]*>)?`", r"``\1``", first)


def page(package: str, listed: dict[int, str] | None = None) -> str:
    """Give the text of a package's page. What other pages describe, `listed` by its identity, it only refers to."""
    names = exports(package)
    rooms = [name for name in names if inspect.ismodule(_value(name))]
    elsewhere = {name: listed[id(_value(name))] for name in names if listed and id(_value(name)) in listed}
    here = [name for name in names if name not in elsewhere and name not in rooms]
    lines = [package, "=" * len(package), "", f".. automodule:: {package}", "   :no-members:", ""]
    summarized = [name.removeprefix(f"{package}.") for name in here if _kind(name) != "Constants and types"]
    if listed is not None:
        lines += task_map(elsewhere)
    elif summarized:
        lines += [".. autosummary::", "", *(f"   {name}" for name in summarized), ""]
    if rooms:
        lines += ["Packages:", "", *(f"- :doc:`{name}`" for name in rooms), ""]
    for kind in _ROLES:
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
