"""The compiler of the WebAssembly modules: clang from PyPI (``ziglang``, group ``web`` of pyproject.toml).

Its C++ library for WASI is built without exceptions; four objects add what is missing. Only what changed is compiled
again.
"""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / "build" / "web"

EXCEPTIONS = ("-fwasm-exceptions", "-mexception-handling", "-fexceptions")
TARGET = ("-target", "wasm32-wasi")
OPTIMIZED = ("-O3", "-DNDEBUG", "-msimd128")
# Rounding is that of every other platform: no product is fused with a sum.
COMPILED = (*TARGET, "-std=c++20", *OPTIMIZED, "-ffp-contract=off", *EXCEPTIONS)
LINKED = (*TARGET, "-mexec-model=reactor", "-O3", *EXCEPTIONS, "-Wl,-z,stack-size=1048576", "-s")

# The tag by which WebAssembly tells C++ exceptions from others.
TAG = r'__asm__(".globl __cpp_exception\n.tagtype __cpp_exception i32\n__cpp_exception:\n");'


@dataclass(frozen=True)
class Unit:
    """A source and the command that compiles it; paths in the command are absolute."""

    source: Path
    command: tuple[str, ...]

    @property
    def object(self) -> Path:
        """The file that it becomes; its name depends on the command."""
        digest = hashlib.sha256("\0".join((str(self.source), *self.command)).encode()).hexdigest()[:12]
        return BUILD / "objects" / f"{self.source.stem}-{digest}.o"

    def is_current(self) -> bool:
        """Whether nothing that the object was made of is newer."""
        listing = self.object.with_suffix(".d")
        if not (self.object.exists() and listing.exists()):
            return False
        made = self.object.stat().st_mtime_ns
        names = listing.read_text().split(":", 1)[1].replace("\\\n", " ").split()
        return all(Path(name).exists() and Path(name).stat().st_mtime_ns < made for name in names)

    def compile(self) -> None:
        """Compile it, and list what it includes."""
        listing = self.object.with_suffix(".d")
        run(*self.command, "-MD", "-MF", str(listing), "-c", str(self.source), "-o", str(self.object))


def link(module: Path, units: list[Unit], jobs: int | None = None) -> Path:
    """Compile those of the units that changed, link all with what exceptions need, and return the module."""
    (BUILD / "objects").mkdir(parents=True, exist_ok=True)
    units = [*library_units(), *units]
    stale = [unit for unit in units if not unit.is_current()]
    linked = module.with_suffix(".objects")
    if stale:
        linked.unlink(missing_ok=True)
    with ThreadPoolExecutor(jobs) as pool:
        for number, unit in enumerate(pool.map(compiled, stale), 1):
            print(f"[{number}/{len(stale)}] {unit.source.name}", flush=True)
    objects = [str(unit.object) for unit in units]
    # An object's name has the digest of its flags: other flags are other objects, however old they are.
    current = "\n".join(objects)
    if not (module.exists() and linked.exists() and linked.read_text() == current):
        run(*zig("c++"), *LINKED, *objects, "-o", str(module))
        linked.write_text(current)
        print(f"{module.relative_to(ROOT)}: {module.stat().st_size:,} bytes", flush=True)
    return module


def compiled(unit: Unit) -> Unit:
    """Compile a unit and return it."""
    unit.compile()
    return unit


def library_units() -> list[Unit]:
    """Return what the C++ library of the compiler lacks for exceptions."""
    lib = zig_library()
    abi, unwind = lib / "libcxxabi", lib / "libunwind"
    tag = BUILD / "tag.c"
    if not tag.exists() or tag.read_text() != TAG:
        tag.write_text(TAG)
    for_abi = (
        *zig("c++"), *TARGET, "-std=c++23", "-O2", *EXCEPTIONS,
        "-DLIBCXXABI_NON_DEMANGLING_TERMINATE", "-D_LIBCPP_BUILDING_LIBRARY", "-DLIBCXX_BUILDING_LIBCXXABI",
        "-D_LIBCXXABI_HAS_NO_THREADS", "-I", str(abi / "include"), "-I", str(lib / "libcxx" / "src"),
        "-I", str(unwind / "include"),
    )  # fmt: skip
    for_unwind = (
        *zig("cc"), *TARGET, "-std=c23", "-O2", *EXCEPTIONS, "-fdeclspec", "-D_LIBUNWIND_HAS_NO_THREADS",
        "-D_LIBUNWIND_HIDE_SYMBOLS", "-I", str(unwind / "include"), "-I", str(unwind / "src"),
    )  # fmt: skip
    return [
        Unit(abi / "src" / "cxa_exception.cpp", for_abi),
        Unit(abi / "src" / "cxa_personality.cpp", for_abi),
        Unit(unwind / "src" / "Unwind-wasm.c", for_unwind),
        Unit(tag, (*zig("cc"), *TARGET, "-mexception-handling")),
    ]


def zig(command: str) -> tuple[str, ...]:
    """Return the start of a command line of the compiler."""
    return (sys.executable, "-m", "ziglang", command)


def zig_library() -> Path:
    """Return the folder of the compiler's own sources."""
    try:
        import ziglang  # noqa: PLC0415 - the message says how to install it
    except ModuleNotFoundError:
        sys.exit("the WebAssembly modules need the compiler from PyPI: pip install --group web")
    return Path(ziglang.__file__).parent / "lib"


def run(*command: str, **environment: str) -> None:
    """Run a command; one that fails ends the script with what it says."""
    everything = {**os.environ, **environment}
    done = subprocess.run(command, env=everything, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
