"""Build build/web/voxrt.wasm of web/src and the native sources: ``python web/build_voxrt.py [--jobs N]``.

voxrt_edit.wasm has what edits, and voxrt_view.wasm what the custom element needs.
"""

from __future__ import annotations

import argparse
import os
from typing import TYPE_CHECKING

from compiler import BUILD, COMPILED, ROOT, Unit, link, zig

if TYPE_CHECKING:
    from pathlib import Path

WASM = BUILD / "voxrt.wasm"
EDITS = "edit_interface.cpp"

ROOMS = {"voxelize": "voxelize/src", "octree": "octree/src", "sim": "sim/src/model", "bake": "sim/src/bake"}
LEFT_OUT = {"block_file.cpp", "disk_assembly.cpp", "module.cpp"}
LEFT_OUT_ENDS = ("_avx2.cpp", "_avx512.cpp", "_bindings.cpp")

# Folders and files of what runs once per mesh or memory, or by rules that few ask for, and the largest files: a small
# page matters more than their speed.
COMPILED_SMALL = {"faces", "holes", "mesh", "scene", "sight", "budget", "files", "surface", "src", "rules", "colour"}
COMPILED_SMALL |= {"query", "light", "views"}
COMPILED_SMALL |= {"exact_volume.cpp", "framing.cpp", "regions.cpp", "voxelizer.cpp"}
SMALL = ("-Os", "-Xclang", "-Oz")  # ziglang takes -Oz for -Os


def main() -> None:
    """Compile what changed, and link."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compile so many sources at once")
    build(parser.parse_args().jobs)


def build(jobs: int | None = None) -> Path:
    """Compile what changed, link, and return the module."""
    link_headers()
    return link(WASM, [unit for unit in our_units() if unit.source.name != EDITS], jobs)


def build_view(jobs: int | None = None) -> Path:
    """Link, and return, a module that shows memories and builds none: a third of the other one."""
    return build_part("voxrt_view.wasm", {"interface.cpp"}, jobs)


def build_edit(jobs: int | None = None) -> Path:
    """Link, and return, a module that edits and shows memories: pages load it when it is wanted."""
    return build_part("voxrt_edit.wasm", {"interface.cpp", EDITS}, jobs)


def build_part(name: str, calls: set[str], jobs: int | None) -> Path:
    """Link, and return, a module with some sources of the C interface."""
    link_headers()
    folder = ROOT / "web" / "src"
    units = [unit for unit in our_units() if unit.source.parent != folder or unit.source.name in calls]
    return link(BUILD / name, units, jobs)


def our_units() -> list[Unit]:
    """Return the native sources, and those of the C interface."""
    flags = (*zig("c++"), *COMPILED, "-I", str(BUILD / "include"))
    folders = [ROOT / folder for folder in ROOMS.values()]
    sources = [path for folder in folders for path in sorted(folder.rglob("*.cpp"))]
    sources += sorted((ROOT / "web" / "src").glob("*.cpp"))
    return [
        Unit(source, (*flags, *SMALL) if {source.parent.name, source.name} & COMPILED_SMALL else flags)
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
