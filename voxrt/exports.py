"""The names of a package, each imported when it is first used. The package's ``__init__.pyi`` is the one list of them.

A line ``from voxrt.octree.rom import Rom as Rom`` exports a name, to type checkers and here. Other lines are for type
checkers alone. The list is read when a name is first needed, line by line: lazy_loader's ``attach_stub`` parses it at
once, by ``ast``, which takes half the time of ``voxrt --version``, and knows no names from other packages.
"""

from __future__ import annotations

import os
import sys
from importlib import import_module

TYPE_CHECKING = False  # typing is slow to import: until then Ctrl-C prints a traceback
if TYPE_CHECKING:
    from collections.abc import Callable


def exports_of(package: str) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """Return ``__getattr__`` and ``__dir__`` of a package. A checkout's and an installed wheel's files make it one."""
    module = sys.modules[package]
    parent, _, tail = package.rpartition(".")
    folders = [f"{folder}{os.sep}{tail}" for folder in (sys.modules[parent].__path__ if parent else sys.path) if folder]
    module.__path__ += [name for name in folders if name not in module.__path__ and os.path.isdir(name)]  # noqa: PTH112 - pathlib is slow to import
    homes: dict[str, str] = {}

    def read_homes() -> dict[str, str]:
        if not homes:
            with open(f"{module.__file__}i", encoding="utf-8") as stub:  # noqa: PTH123 - as above
                rows = [line.split() for line in stub if line.startswith("from ")]
            homes.update({row[-1]: row[1] for row in rows})  # at once: another thread finds all names or none
        return homes

    def get_name(name: str) -> object:
        if name == "__all__":
            return sorted(read_homes())
        if name not in read_homes():
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        home = homes[name]
        return import_module(f"{home}.{name}") if home == package else getattr(import_module(home), name)

    version = ["__version__"] if "__version__" in vars(module) else []
    return get_name, lambda: sorted([*read_homes(), *version])
