"""Build build/web/voxrt.wasm of web/src and the native sources: ``python web/build_voxrt.py [--jobs N]``."""

from __future__ import annotations

import argparse
import os
from typing import TYPE_CHECKING

from compiler import BUILD, COMPILED, ROOT, Unit, link, zig

if TYPE_CHECKING:
    from pathlib import Path

WASM = BUILD / "voxrt.wasm"

ROOMS = {"voxelize": "voxelize/src", "octree": "octree/src", "sim": "sim/src/model", "bake": "sim/src/bake"}
LEFT_OUT = {"block_file.cpp", "disk_assembly.cpp", "module.cpp"}
LEFT_OUT_ENDS = ("_avx2.cpp", "_avx512.cpp", "_bindings.cpp")

# Folders of what runs once per mesh or memory: a small page matters more than its speed.
RUN_ONCE = ("faces", "holes", "mesh", "scene", "sight", "budget", "files", "surface", "src")


def main() -> None:
    """Compile what changed, and link."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compile so many sources at once")
    build(parser.parse_args().jobs)


def build(jobs: int | None = None) -> Path:
    """Compile what changed, link, and return the module."""
    link_headers()
    return link(WASM, our_units(), jobs)


def build_view(jobs: int | None = None) -> Path:
    """Link, and return, a module that shows memories and builds none: a third of the other one."""
    link_headers()
    calls = ROOT / "web" / "src"
    units = [unit for unit in our_units() if unit.source.parent != calls or unit.source.name == "interface.cpp"]
    return link(BUILD / "voxrt_view.wasm", units, jobs)


def our_units() -> list[Unit]:
    """Return the native sources, and those of the C interface."""
    flags = (*zig("c++"), *COMPILED, "-I", str(BUILD / "include"))
    folders = [ROOT / folder for folder in ROOMS.values()]
    sources = [path for folder in folders for path in sorted(folder.rglob("*.cpp"))]
    sources += sorted((ROOT / "web" / "src").glob("*.cpp"))
    return [
        Unit(source, (*flags, "-Os") if source.parent.name in RUN_ONCE else flags)
        for source in sources
        if source.name not in LEFT_OUT and not source.name.endswith(LEFT_OUT_ENDS)
    ]


def link_headers() -> None:
    """Make headers known as <voxrt/FOLDER/...>, as CMake does."""
    include = BUILD / "include" / "voxrt"
    include.mkdir(parents=True, exist_ok=True)
    for room, folder in ROOMS.items():
        if not (include / room).is_symlink():
            (include / room).symlink_to(ROOT / folder)


if __name__ == "__main__":
    main()
